#include "cone.h"

#include "parallel.h"
#include "pyramid.h"

#include <math.h>
#include <stdlib.h>

/* Cells at most NEAR apart, across and up, are near; on sides of SIDE_LEAST none is near another in two ways.
 */
enum { NEAR = 2, SIDE_LEAST = 2 * NEAR + 2 };

/* By how much of itself a slope may be granted too large, so that fewer blocks need a closer look. */
static const double GENEROSITY = 0.05;

typedef struct {
    Image corners;
    Pyramid pyramid;
    Image *cones;
} Job;

static int wrap(int i, int size) {
    int rest = i % size;
    return rest < 0 ? rest + size : rest;
}

static const float *corners_at(const Job *job, int x, int y) {
    return image_at(&job->corners, wrap(x, job->corners.width), wrap(y, job->corners.height));
}

static double lowest_corner(const float *h) { return fmin(fmin(h[0], h[1]), fmin(h[2], h[3])); }

/* A cell whose cone is being found: the steepest slope found so far, and what it has been granted. */
typedef struct {
    int x, y;
    const float *heights; /* of its corners */
    double lowest, found, granted;
} Apex;

/* ---- Between neighbours: the surface's slope on the way ---- */

/* The steepest rise with one coordinate, of two slopes, on a way that goes forward (1), backward (-1), or
 * either way (0). */
static double rise(double a, double b, int way) {
    if (way > 0) return fmax(0.0, fmax(a, b));
    if (way < 0) return fmax(0.0, fmax(-a, -b));
    return fmax(fabs(a), fabs(b));
}

/* The steepest rise within a patch along any direction d whose signs are those of (i, j). dh/dx of a patch
 * depends on y alone and dh/dy on x alone, so that the steepest of both come together somewhere. */
static double patch_rise(const float *h, int i, int j) {
    return hypot(rise(h[1] - h[0], h[3] - h[2], i), rise(h[2] - h[0], h[3] - h[1], j));
}

/* A straight way from any point of the cell (x, y) to any point of (x + i, y + j) stays in the cells between,
 * and goes one way: it rises by no more than the steepest of them. */
static double way_slope(const Job *job, int x, int y, int i, int j) {
    double steepest = 0.0;
    for (int b = 0; b <= abs(j); b++)
        for (int a = 0; a <= abs(i); a++)
            steepest =
                fmax(steepest, patch_rise(corners_at(job, x + (i < 0 ? -a : a), y + (j < 0 ? -b : b)), i, j));
    return steepest;
}

/* ---- Beyond: the slopes between corners ---- */

static int distance_around(int a, int b, int size) {
    int d = abs(a - b);
    return d < size - d ? d : size - d;
}

/* What the slopes between corners must be stretched by to hold between all points of two cells that are d
 * apart. The points q and p are means of their cells' corners, weighted as the heights are, so h(q) - h(p) =
 * mean of h(q_i) - h(p_j) <= m mean of |q_i - p_j|, and |y| <= (|y|^2 + r^2) / (2 r) with r = |q - p| bounds
 * that mean by r + variance / (2 r). The variance of four coordinates on unit intervals is at most 4 / 4. */
static double stretch(double d) { return 1.0 + 0.5 / (d * d); }

/* The steepest way from a corner of the apex's cell to one of the cell (x, y). */
static double corner_slope(const Job *job, const Apex *apex, int x, int y) {
    const float *heights = corners_at(job, x, y);
    double steepest_squared = 0.0;
    for (int p = 0; p < 4; p++)
        for (int q = 0; q < 4; q++) {
            double rise = (double)heights[q] - apex->heights[p];
            double dx = distance_around(x + q % 2, apex->x + p % 2, job->corners.width);
            double dy = distance_around(y + q / 2, apex->y + p / 2, job->corners.height);
            double squared = dx * dx + dy * dy; /* no division where there is nothing to divide */
            if (rise > 0.0 && rise * rise > steepest_squared * squared)
                steepest_squared = rise * rise / squared;
        }
    return sqrt(steepest_squared);
}

/* ---- Near cells ---- */

/* Next to the apex's cell the slope on the way decides; one cell farther, whichever bound is the lower. */
static double near_cone(const Job *job, const Apex *apex) {
    double m = 0.0;
    for (int j = -NEAR; j <= NEAR; j++)
        for (int i = -NEAR; i <= NEAR; i++) {
            double slope = way_slope(job, apex->x, apex->y, i, j);
            double d = hypot(abs(i) > 1, abs(j) > 1);
            if (d > 0.0) slope = fmin(slope, stretch(d) * corner_slope(job, apex, apex->x + i, apex->y + j));
            m = fmax(m, slope);
        }
    return m;
}

/* ---- Far cells ---- */

/* How far the cell i is from the cells from..to-1, around a world of that many cells. */
static int gap(int i, int from, int to, int size) {
    if (i >= from && i < to) return 0;
    int forward = from - (i + 1), backward = i - to;
    if (forward < 0) forward += size;
    if (backward < 0) backward += size;
    return forward < backward ? forward : backward;
}

/* Widens the cone for the cells of one block of the pyramid. The most that any of them can need is granted
 * unseen where that is hardly more than what was found elsewhere; otherwise the block is looked at more
 * closely. */
static void grant_block(const Job *job, Apex *apex, int level, int i, int j) {
    const Image *map = &job->corners, *tops = &job->pyramid.levels[level];
    int x0 = i << level, y0 = j << level, x1 = (i + 1) << level, y1 = (j + 1) << level;
    if (x0 >= map->width || y0 >= map->height) return;
    double dx = gap(apex->x, x0, x1 < map->width ? x1 : map->width, map->width);
    double dy = gap(apex->y, y0, y1 < map->height ? y1 : map->height, map->height);
    double d = sqrt(dx * dx + dy * dy), most = (*image_at(tops, i, j) - apex->lowest) / d * stretch(d);
    bool far = dx >= NEAR || dy >= NEAR;
    if (far && most <= (1.0 + GENEROSITY) * apex->found) {
        apex->granted = fmax(apex->granted, most);
        return;
    }
    if (level > 0) {
        /* The nearest first, for what it needs spares a closer look at those behind it. */
        int nearest = (apex->x >= (2 * i + 1) << (level - 1)) + 2 * (apex->y >= (2 * j + 1) << (level - 1));
        for (int k = 0; k < 4; k++) {
            int child_x = 2 * i + (k ^ nearest) % 2, child_y = 2 * j + (k ^ nearest) / 2;
            if (child_x < tops[-1].width && child_y < tops[-1].height)
                grant_block(job, apex, level - 1, child_x, child_y);
        }
    } else if (far) {
        apex->found = fmax(apex->found, stretch(d) * corner_slope(job, apex, x0, y0));
    }
}

static void find_cones_of_row(void *context, int y) {
    const Job *job = context;
    int coarsest = job->pyramid.count - 1;
    for (int x = 0; x < job->cones->width; x++) {
        const float *heights = corners_at(job, x, y);
        Apex apex = {x, y, heights, lowest_corner(heights), 0.0, 0.0};
        apex.found = near_cone(job, &apex);
        grant_block(job, &apex, coarsest, 0, 0);
        *image_at(job->cones, x, y) = nextafterf((float)fmax(apex.found, apex.granted), INFINITY);
    }
}

/* The map repeated until no cell is near another in two ways. */
static Image repeat(const Image *height) {
    int across = (SIDE_LEAST + height->width - 1) / height->width;
    int up = (SIDE_LEAST + height->height - 1) / height->height;
    Image repeated = image_create(across * height->width, up * height->height, 1);
    for (int y = 0; y < repeated.height; y++)
        for (int x = 0; x < repeated.width; x++)
            *image_at(&repeated, x, y) = *image_at(height, x % height->width, y % height->height);
    return repeated;
}

Image cone_build(const Image *height) {
    Image repeated = repeat(height), cones = image_create(height->width, height->height, 1);
    Job job = {corners_build(&repeated), pyramid_build(&repeated), &cones};
    parallel_for(height->height, find_cones_of_row, &job);
    image_destroy(&job.corners);
    pyramid_destroy(&job.pyramid);
    image_destroy(&repeated);
    return cones;
}
