#include "fill.h"

#include "fail.h"

#include <stdlib.h>
#include <string.h>

/* What is painted with: the two landed rows that a row of cells lies between, and where to. Cell i of the row
 * lies between entries i - 1 and i, and its corners are numbered 00 10 11 01, the column first. */
typedef struct {
    Destination *destination;
    float *nearest; /* for the depth buffer: the least depth so far of each destination texel; or NULL */
    float depth_l;  /* depth = depth_l l: of points on one ray, the nearest to the eye has the least */
    LandedRow below, above;
    int *place;   /* of each cell: the one destination texel that it covers, or NOTHING, or MANY */
    float *s, *t; /* where in the cell that one lies */
} Painter;

enum { NOTHING = -1, MANY = -2 };

/* ---- Interpolation ---- */

static inline uint64_t load(const Texel *texel) {
    uint64_t bytes;
    memcpy(&bytes, texel, sizeof bytes);
    return bytes;
}

/* a + (b - a) weight / 256 for four bytes at once, each with a byte of room above it: the sum over the lanes
 * of 256 a + (b - a) weight is exact, whatever it borrows between them. */
static inline uint64_t mix_lanes(uint64_t a, uint64_t b, uint64_t weight) {
    const uint64_t lanes = 0x00ff00ff00ff00ff, half = 0x0080008000800080;
    return (((a << 8) + (b - a) * weight + half) >> 8) & lanes;
}

/* The texel at s, t in 0..1 between four. */
static inline Texel bilinear(const Texel *below, const Texel *above, float s, float t) {
    const uint64_t lanes = 0x00ff00ff00ff00ff;
    uint64_t ws = (uint64_t)(int)(s * 256.0f + 0.5f), wt = (uint64_t)(int)(t * 256.0f + 0.5f);
    uint64_t p00 = load(below), p10 = load(below + 1), p01 = load(above), p11 = load(above + 1);
    uint64_t even =
        mix_lanes(mix_lanes(p00 & lanes, p10 & lanes, ws), mix_lanes(p01 & lanes, p11 & lanes, ws), wt);
    uint64_t odd = mix_lanes(mix_lanes(p00 >> 8 & lanes, p10 >> 8 & lanes, ws),
                             mix_lanes(p01 >> 8 & lanes, p11 >> 8 & lanes, ws), wt);
    uint64_t bytes = even | odd << 8;
    Texel texel;
    memcpy(&texel, &bytes, sizeof texel);
    return texel;
}

static inline float mix(float a, float b, float t) { return a + (b - a) * t; }

/* Paints the point s, t of cell i over the destination texel `at`. */
static inline void put(const Painter *painter, size_t at, int i, float s, float t) {
    const LandedRow *below = &painter->below, *above = &painter->above;
    float level = mix(mix(below->levels[i - 1], below->levels[i], s),
                      mix(above->levels[i - 1], above->levels[i], s), t);
    if (painter->nearest) {
        float depth = painter->depth_l * level;
        if (!(depth < painter->nearest[at])) return;
        painter->nearest[at] = depth;
    }
    painter->destination->texels[at] = bilinear(below->texels + i - 1, above->texels + i - 1, s, t);
    if (!painter->destination->lookup) return;
    float *lookup = painter->destination->lookup + 3 * at;
    lookup[0] = mix(below->u[i - 1], below->u[i], s);
    lookup[1] = mix(below->v, above->v, t);
    lookup[2] = level / 65535;
}

/* ---- Cells that cover many texels: line by line ---- */

typedef struct {
    float x, y;
} Point;

static inline float cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
static inline Point minus(Point a, Point b) { return (Point){a.x - b.x, a.y - b.y}; }

/* A triangle's three corners with s and t there; lines run along x. */
typedef struct {
    Point p[3];
    float s[3], t[3];
} Triangle;

static inline int ceil_int(float x) {
    int i = (int)x;
    return i + ((float)i < x);
}

static void paint_triangle(const Painter *painter, int i, const Triangle *triangle, bool swapped) {
    const Point *p = triangle->p;
    float area = cross(minus(p[1], p[0]), minus(p[2], p[0]));
    if (!(area > 0.0f)) return;
    int width = painter->destination->width, height = painter->destination->height;
    int columns = swapped ? height : width, rows = swapped ? width : height;
    size_t column_step = swapped ? (size_t)width : 1, row_step = swapped ? 1 : (size_t)width;
    const float slack = 1e-3f;
    float lowest = fminf(fminf(p[0].y, p[1].y), p[2].y), highest = fmaxf(fmaxf(p[0].y, p[1].y), p[2].y);
    int first = ceil_int(fmaxf(lowest - slack, 0)), last = ceil_int(fminf(highest + slack, (float)rows)) - 1;
    for (int y = first; y <= last; y++) {
        float from = -0.5f, to = (float)columns - 0.5f;
        for (int e = 0; e < 3; e++) {
            Point a = p[e], b = p[(e + 1) % 3];
            float rise = b.y - a.y;
            float x = a.x + ((float)y - a.y) * (b.x - a.x) / rise;
            if (rise < 0.0f) from = fmaxf(from, x - slack);
            if (rise > 0.0f) to = fminf(to, x + slack);
        }
        for (int x = ceil_int(from); (float)x <= to; x++) {
            Point centre = {(float)x, (float)y};
            Point q[3] = {minus(p[0], centre), minus(p[1], centre), minus(p[2], centre)};
            float w1 = cross(q[2], q[0]) / area, w2 = cross(q[0], q[1]) / area, w0 = 1 - w1 - w2;
            float s = w0 * triangle->s[0] + w1 * triangle->s[1] + w2 * triangle->s[2];
            float t = w0 * triangle->t[0] + w1 * triangle->t[1] + w2 * triangle->t[2];
            put(painter, (size_t)y * row_step + (size_t)x * column_step, i, fminf(fmaxf(s, 0), 1),
                fminf(fmaxf(t, 0), 1));
        }
    }
}

static void paint_many(const Painter *painter, int i) {
    const LandedRow *below = &painter->below, *above = &painter->above;
    Point p00 = {below->x[i - 1], below->y[i - 1]}, p10 = {below->x[i], below->y[i]};
    Point p01 = {above->x[i - 1], above->y[i - 1]}, p11 = {above->x[i], above->y[i]};
    Triangle one = {{p00, p10, p11}, {0, 1, 1}, {0, 0, 1}}, other = {{p00, p11, p01}, {0, 1, 0}, {0, 1, 1}};
    paint_triangle(painter, i, &one, false);
    paint_triangle(painter, i, &other, false);
}

/* ---- A row of cells ---- */

static inline float least(float a, float b) { return a < b ? a : b; }
static inline float greatest(float a, float b) { return a > b ? a : b; }

/* What each cell of a row covers. */
static void classify(const Painter *painter) {
    const float *restrict x0 = painter->below.x, *restrict y0 = painter->below.y;
    const float *restrict x1 = painter->above.x, *restrict y1 = painter->above.y;
    int *restrict place = painter->place;
    float *restrict cell_s = painter->s, *restrict cell_t = painter->t;
    int width = painter->destination->width, height = painter->destination->height;
    for (int i = 0; i <= painter->below.count; i++) {
        Point p00 = {x0[i - 1], y0[i - 1]}, p10 = {x0[i], y0[i]}, p01 = {x1[i - 1], y1[i - 1]},
              p11 = {x1[i], y1[i]};
        float left = least(least(p00.x, p10.x), least(p01.x, p11.x));
        float right = greatest(greatest(p00.x, p10.x), greatest(p01.x, p11.x));
        float bottom = least(least(p00.y, p10.y), least(p01.y, p11.y));
        float top = greatest(greatest(p00.y, p10.y), greatest(p01.y, p11.y));
        int column = ceil_int(left), end_column = ceil_int(right), row = ceil_int(bottom),
            end_row = ceil_int(top);
        column = column > 0 ? column : 0;
        row = row > 0 ? row : 0;
        end_column = end_column < width ? end_column : width;
        end_row = end_row < height ? end_row : height;
        Point centre = {(float)column, (float)row};
        p00 = minus(p00, centre), p10 = minus(p10, centre), p01 = minus(p01, centre),
        p11 = minus(p11, centre);
        float diagonal = cross(p11, p00);
        bool lower = diagonal >= 0.0f;
        float e0 = lower ? cross(p00, p10) : cross(p11, p01), e1 = lower ? cross(p10, p11) : cross(p01, p00);
        float r = 1.0f / (e0 + e1 + fabsf(diagonal));
        float e0_r = e0 * r, e1_r = e1 * r;
        cell_s[i] = lower ? 1 - e1_r : e1_r;
        cell_t[i] = lower ? e0_r : 1 - e0_r;
        bool none = (end_column <= column) | (end_row <= row) | (left < -1e8f);
        bool one = (end_column == column + 1) & (end_row == row + 1);
        bool covered = (e0 >= 0.0f) & (e1 >= 0.0f) & (e0 + e1 > 0.0f);
        place[i] = none ? NOTHING : !one ? MANY : covered ? row * width + column : NOTHING;
    }
}

static void paint_cells(const Painter *painter, Run columns) {
    for (int i = columns.first; i != columns.end; i += columns.step) {
        int place = painter->place[i];
        if (place >= 0)
            put(painter, (size_t)place, i, painter->s[i], painter->t[i]);
        else if (place == MANY)
            paint_many(painter, i);
    }
}

/* ---- All rows ---- */

/* Cell i of an axis reaches from texel centre i - 1 to texel centre i. */
static Sheets cell_sheets(const Source *source, const PrewarpFactors *factors, Visibility visibility) {
    if (visibility == VISIBILITY_DEPTH_BUFFER) return sheets_plain(source->width + 1, source->height + 1);
    Vec2 epipole = sheets_epipole(factors);
    return sheets_toward(v2(epipole.x * source->width + 0.5, epipole.y * source->height + 0.5),
                         source->width + 1, source->height + 1);
}

static float *nothing_near(const Destination *destination) {
    size_t count = (size_t)destination->width * destination->height;
    float *nearest = allocate(count, sizeof *nearest);
    for (size_t i = 0; i < count; i++) nearest[i] = INFINITY;
    return nearest;
}

static void swap(LandedRow *a, LandedRow *b) {
    LandedRow other = *a;
    *a = *b;
    *b = other;
}

void fill_cells(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                Destination *destination, WarpCounts *counts) {
    Sheets sheets = cell_sheets(source, factors, visibility);
    Landing landing = landing_create(source, factors, destination);
    size_t cells = (size_t)source->width + 1;
    Painter painter = {.destination = destination,
                       .depth_l = factors->behind ? 1 : -1,
                       .below = landed_row_create(source->width),
                       .above = landed_row_create(source->width),
                       .place = allocate(cells, sizeof(int)),
                       .s = allocate(cells, sizeof(float)),
                       .t = allocate(cells, sizeof(float))};
    if (visibility == VISIBILITY_DEPTH_BUFFER) painter.nearest = nothing_near(destination);
    for (int run = 0; run < 2; run++) {
        Run rows = sheets.rows[run];
        bool up = rows.step > 0;
        if (rows.first == rows.end) continue;
        LandedRow *next = up ? &painter.above : &painter.below, *last = up ? &painter.below : &painter.above;
        landing_row(&landing, source, up ? rows.first - 1 : rows.first, next);
        for (int j = rows.first; j != rows.end; j += rows.step) {
            swap(next, last);
            landing_row(&landing, source, up ? j : j - 1, next);
            if (j < source->height) forward_count(&painter.above, destination, counts);
            classify(&painter);
            paint_cells(&painter, sheets.columns[0]);
            paint_cells(&painter, sheets.columns[1]);
        }
    }
    landed_row_destroy(&painter.below);
    landed_row_destroy(&painter.above);
    free(painter.place);
    free(painter.s);
    free(painter.t);
    free(painter.nearest);
}
