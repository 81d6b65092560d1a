#include "two_pass.h"

#include "fail.h"
#include "landing.h"
#include "light.h"
#include "sheets.h"

#include <stdlib.h>
#include <string.h>

/* All that a texel carries through both passes; colours are linear light. X and Y say where it belongs, in
 * destination texels whose centres are whole numbers; X is NAN where there is nothing. The last value is to
 * spare: twelve are interpolated four at a time, which takes a tenth less time than eleven. */
enum { X, Y, COLOUR, NORMAL = COLOUR + 3, LOOKUP = NORMAL + 3, VALUES = LOOKUP + 4 };
typedef struct {
    float value[VALUES];
} Point;

static const Point nothing = {{NAN}};

/* ---- One line, in either pass ---- */

/* Paints what lies between two points onto a line of `size` texels, of which it covers those whose centres it
 * reaches. along is X or Y. */
static void paint_between(const Point *from, const Point *to, int along, Point *out, int size) {
    float start = from->value[along], end = to->value[along];
    float low = fmaxf(fminf(start, end), 0.0f), high = fminf(fmaxf(start, end), (float)size - 1.0f);
    if (!(low <= high)) return;
    for (int i = (int)ceilf(low); (float)i <= high; i++) {
        float t = end == start ? 0.0f : ((float)i - start) / (end - start);
        for (int k = 0; k < VALUES; k++)
            out[i].value[k] = from->value[k] + t * (to->value[k] - from->value[k]);
    }
}

/* Paints a line's pieces, of which number i lies between its points i and i + 1, in both runs. */
static void paint_line(const Point *points, const Run runs[2], int along, Point *out, int size) {
    for (int run = 0; run < 2; run++)
        for (int i = runs[run].first; i != runs[run].end; i += runs[run].step)
            if (!isnan(points[i].value[X]) && !isnan(points[i + 1].value[X]))
                paint_between(&points[i], &points[i + 1], along, out, size);
}

/* ---- The points of the source ---- */

static Point mean_of(const Point *a, const Point *b) {
    Point mean;
    for (int k = 0; k < VALUES; k++) mean.value[k] = 0.5f * (a->value[k] + b->value[k]);
    return mean;
}

/* A texel as it is stored; where it belongs is still to be computed. */
static Point stored(const Source *source, const Light *light, int x, int y) {
    const size_t at = (size_t)y * source->width + x;
    const Texel *texel = &source->texels[at];
    Point point = {0};
    for (int c = 0; c < 3; c++) {
        point.value[COLOUR + c] = light->decoded[texel->colour[c]];
        point.value[NORMAL + c] = texel->normal[c];
    }
    point.value[LOOKUP + 2] = (float)source->levels[at] / 65535.0f;
    return point;
}

/* A row and its two ends: points 0 and width + 1 lie at u = 0 and 1, halfway between the last texel and the
 * first, for the image repeats. Likewise rows -1 and height lie at v = 0 and 1. */
static void fetch_row(const Source *source, const Light *light, int y, Point *points) {
    const int width = source->width, height = source->height;
    for (int x = 0; x < width; x++) {
        points[x + 1] = stored(source, light, x, y < 0 || y == height ? 0 : y);
        if (y < 0 || y == height) {
            Point last = stored(source, light, x, height - 1);
            points[x + 1] = mean_of(&points[x + 1], &last);
        }
    }
    points[0] = points[width + 1] = mean_of(&points[1], &points[width]);
}

/* u_i = (u_s + k1 d) / (1 + k3 d), v_i = (v_s + k2 d) / (1 + k3 d) */
static void place(Point *point, double u, double v, const Source *source, const PrewarpFactors *k,
                  const Destination *destination) {
    double d = source->scale * (point->value[LOOKUP + 2] - source->base), w = 1.0 + k->k3 * d;
    point->value[LOOKUP] = (float)u;
    point->value[LOOKUP + 1] = (float)v;
    if (!(w >= LANDING_W_MIN)) {
        point->value[X] = NAN;
        return;
    }
    Vec2 low = destination->low, high = destination->high;
    point->value[X] = (float)(((u + k->k1 * d) / w - low.x) / (high.x - low.x) * destination->width - 0.5);
    point->value[Y] = (float)(((v + k->k2 * d) / w - low.y) / (high.y - low.y) * destination->height - 0.5);
}

static void place_row(Point *points, int y, const Source *source, const PrewarpFactors *factors,
                      const Destination *destination) {
    double v = clamp((y + 0.5) / source->height, 0.0, 1.0);
    for (int x = -1; x <= source->width; x++)
        place(&points[x + 1], clamp((x + 0.5) / source->width, 0.0, 1.0), v, source, factors, destination);
}

/* ---- The two passes ---- */

/* The pieces of a line from 0 to 1 with `size` texels, painted toward the epipole. Pieces are as long as
 * texels but for the halves at both ends, so the epipole is measured from half a texel before the line's
 * start. */
static Vec2 epipole_in_pieces(const Source *source, const PrewarpFactors *factors) {
    Vec2 epipole = sheets_epipole(factors);
    return v2(epipole.x * source->width + 0.5, epipole.y * source->height + 0.5);
}

static void put(const Point *point, const Light *light, Destination *destination, size_t at) {
    if (isnan(point->value[X])) return;
    Texel *texel = &destination->texels[at];
    for (int c = 0; c < 3; c++) {
        texel->colour[c] = light_encode(light, point->value[COLOUR + c]);
        texel->normal[c] = (uint8_t)(point->value[NORMAL + c] + 0.5f);
    }
    texel->colour[3] = 255;
    if (destination->lookup) memcpy(&destination->lookup[3 * at], &point->value[LOOKUP], 3 * sizeof(float));
}

/* Each row to its columns: `between` has destination->width columns and as many rows as the source, and the
 * two beyond its edges. */
static void pass_rows(const Source *source, const PrewarpFactors *factors, const Light *light,
                      const Run runs[2], const Destination *destination, Point *between) {
    const int columns = destination->width;
    Point *row = allocate((size_t)source->width + 2, sizeof *row);
    for (int y = -1; y <= source->height; y++) {
        Point *out = &between[(size_t)(y + 1) * columns];
        for (int x = 0; x < columns; x++) out[x] = nothing;
        fetch_row(source, light, y, row);
        place_row(row, y, source, factors, destination);
        paint_line(row, runs, X, out, columns);
    }
    free(row);
}

/* Each of their columns to the destination's rows. */
static void pass_columns(const Point *between, int rows, const Light *light, const Run runs[2],
                         Destination *destination) {
    const int columns = destination->width;
    Point *column = allocate(rows, sizeof *column), *done = allocate(destination->height, sizeof *done);
    for (int x = 0; x < columns; x++) {
        for (int y = 0; y < destination->height; y++) done[y] = nothing;
        for (int y = 0; y < rows; y++) column[y] = between[(size_t)y * columns + x];
        paint_line(column, runs, Y, done, destination->height);
        for (int y = 0; y < destination->height; y++)
            put(&done[y], light, destination, (size_t)y * columns + x);
    }
    free(column);
    free(done);
}

void warp_two_pass(const Source *source, const PrewarpFactors *factors, Destination *destination,
                   float *kept) {
    const int columns = destination->width, rows = source->height + 2;
    const size_t texels = (size_t)columns * destination->height, left = (size_t)columns * source->height;
    memset(destination->texels, 0, texels * sizeof(Texel));
    if (destination->lookup) memset(destination->lookup, 0, texels * 3 * sizeof(float));
    for (size_t i = 0; kept && i < left; i++) kept[i] = NAN;
    if (!factors->possible) return;

    const Light *light = light_tables();
    Point *between = allocate((size_t)columns * rows, sizeof *between);
    Sheets sheets = sheets_toward(epipole_in_pieces(source, factors), source->width + 1, rows - 1);
    pass_rows(source, factors, light, sheets.columns, destination, between);
    pass_columns(between, rows, light, sheets.rows, destination);
    for (size_t i = 0; kept && i < left; i++) {
        const Point *point = &between[columns + i]; /* the first row lies beyond the source's edge */
        if (!isnan(point->value[X])) kept[i] = point->value[LOOKUP];
    }
    free(between);
}
