#include "fill.h"

#include "fail.h"
#include "lanes.h"

#include <stdlib.h>

/* Where a destination texel comes from, in 1/256 of a texel from the centre of the source's first one. It
 * takes the place of the texel itself until all cells are painted. */
typedef struct {
    int32_t u, v;
} Origin;

enum { NOWHERE = (int32_t)0x80808080, NOWHERE_BYTE = 0x80 };

/* What a cell covers: the number of the one destination texel, or one of these. */
enum {
    NOTHING = -1,
    MANY = -2,  /* perhaps more than one */
    FOLDED = -3 /* perhaps some, by a cell that is not convex */
};

/* One line of as many cells as there are lanes: it covers columns first to end - 1, and `from` is the first
 * one's origin. */
typedef struct {
    int first[LANES], end[LANES];
    Origin from[LANES];
} Line;

/* As many cells of one row that may cover many texels. In each, lines run along the rows or, where they are
 * fewer, along the columns of its box; then x and y change places (turned). */
typedef struct {
    float x00[LANES], x10[LANES], x11[LANES], x01[LANES], y00[LANES], y10[LANES], y11[LANES], y01[LANES];
    float u_left[LANES], u_right[LANES];
    int lines[LANES], length[LANES], turned[LANES];
    int start[LANES]; /* the destination texel in the first corner of the box */
    /* For each side, where the line y may begin and where it must end: x = at + step y. */
    float low_at[4][LANES], low_step[4][LANES], high_at[4][LANES], high_step[4][LANES];
    float u_0[LANES], u_x[LANES], u_y[LANES], v_0[LANES], v_x[LANES],
        v_y[LANES]; /* u = u_0 + u_x x + u_y y */
} Block;

/* What is painted with. Cell i of a row of cells lies between entries i - 1 and i of two landed rows; its
 * corners are numbered 00 10 11 01, the column first. */
typedef struct {
    const Source *source;
    Destination *destination;
    uint32_t *nearest; /* for the depth buffer: how far what each destination texel holds is; or NULL */
    bool behind;       /* the eye is: the least level is nearest */
    LandedRow below, above;
    float *columns;      /* of the entries: their u as Origin has it */
    float row, next_row; /* of the rows below and above: their v */
    int *covers;         /* of each cell */
    Origin *from;        /* where the one texel that it covers comes from */
    int *some, *many;    /* in the order of painting: cells that cover anything, and those that cover many */
    Block *block;
    Line *lines;
} Painter;

/* Texels beyond a side that count as inside, so that rounding tears nothing. */
static const float SLACK = 1e-4f, TINY = 1e-20f, FAR = 1e9f;

/* ---- What cells cover ---- */

/* For each cell of a row: what it covers, and of one texel, where in the source that lies.
 *
 * With a cell's corners seen from the texel's centre, the cross product of two that follow one another is
 * twice the area between that side and the centre, positive where the centre lies to the left of the side.
 * The two cells of a side find the same number but for its sign, so nothing falls between them. In a
 * parallelogram s and t are shares of these areas; in other convex cells they are still 0 and 1 on the sides.
 */
WIDE static void cells_sort(const Painter *painter) {
    const float *below_x = painter->below.x, *below_y = painter->below.y;
    const float *above_x = painter->above.x, *above_y = painter->above.y;
    const int width = painter->destination->width, height = painter->destination->height;
    const Floats right_edge = ALL((float)width), top_edge = ALL((float)height),
                 nowhere = ALL(LANDING_NOWHERE);
    const Floats zero = {0}, one = ALL(1.0f), tiny = ALL(TINY);
    const float row = painter->row, rise = painter->next_row - painter->row, *columns_u = painter->columns;
    int *const covers_of = painter->covers, count = painter->below.count;
    Origin *const from = painter->from;
    for (int i = 0; i <= count; i += LANES) {
        Floats x00, x10, x11, x01, y00, y10, y11, y01, u, u_right;
        LOAD(x00, below_x + i - 1), LOAD(x10, below_x + i), LOAD(x01, above_x + i - 1),
            LOAD(x11, above_x + i);
        LOAD(y00, below_y + i - 1), LOAD(y10, below_y + i), LOAD(y01, above_y + i - 1),
            LOAD(y11, above_y + i);
        LOAD(u, columns_u + i - 1), LOAD(u_right, columns_u + i);
        /* The box of centres from the corners' least coordinates up to but without their greatest. */
        Floats min0 = LEAST(x00, x10), min1 = LEAST(x01, x11), max0 = GREATEST(x00, x10),
               max1 = GREATEST(x01, x11);
        Floats left = LEAST(min0, min1), right = GREATEST(max0, max1);
        min0 = LEAST(y00, y10), min1 = LEAST(y01, y11), max0 = GREATEST(y00, y10), max1 = GREATEST(y01, y11);
        Floats bottom = LEAST(min0, min1), top = GREATEST(max0, max1);
        Ints somewhere = left > nowhere;
        left = GREATEST(left, zero), right = LEAST(right, right_edge);
        left = LEAST(left, right_edge);
        bottom = GREATEST(bottom, zero), top = LEAST(top, top_edge);
        bottom = LEAST(bottom, top_edge);
        Ints column = CEIL(left), columns = CEIL(right) - column, first_row = CEIL(bottom),
             rows = CEIL(top) - first_row;
        Floats x = FLOATS_OF(column), y = FLOATS_OF(first_row);
        x00 -= x, x10 -= x, x11 -= x, x01 -= x, y00 -= y, y10 -= y, y11 -= y, y01 -= y;
        Floats b = x00 * y10 - y00 * x10, r = x10 * y11 - y10 * x11, t = x11 * y01 - y11 * x01,
               l = x01 * y00 - y01 * x00;
        Floats d = x11 * y00 - y11 * x00, e = x10 * y01 - y10 * x01;
        /* The four triangles of three corners: all turn left in a convex cell, none in one turned over. */
        Floats t0 = b + r + d, t1 = t + l - d, t2 = b + l + e, t3 = r + t - e;
        Ints front = (t0 > zero) | (t1 > zero) | (t2 > zero) | (t3 > zero),
             convex = (t0 > zero) & (t1 > zero) & (t2 > zero) & (t3 > zero);
        Floats least0 = LEAST(b, r), least1 = LEAST(t, l);
        Ints inside = (least0 >= -SLACK) & (least1 >= -SLACK);
        Ints some = (columns > 0) & (rows > 0) & front & somewhere, single = (columns == 1) & (rows == 1);
        Ints covers = (first_row * width + column) | ~inside; /* NOTHING is -1 */
        covers = (covers & single) | (MANY & ~single);
        covers = (covers & convex) | (FOLDED & ~convex);
        covers |= ~some;
        STORE(covers, covers_of + i);
        Floats width_u = l + r, width_v = b + t;
        Floats s = l / GREATEST(width_u, tiny), v = b / GREATEST(width_v, tiny);
        s = GREATEST(s, zero), v = GREATEST(v, zero);
        s = LEAST(s, one), v = LEAST(v, one);
        Ints from_u = INTS_OF(u + (u_right - u) * s), from_v = INTS_OF(row + rise * v);
        STORE_PAIRS(from_u, from_v, from + i);
    }
}

/* ---- Painting ---- */

/* The source's level at an origin, bilinear. */
static float level_at(const Source *source, Origin origin) {
    int width = source->width, height = source->height;
    int i = (origin.u >> 8) + width, j = (origin.v >> 8) + height; /* from -1 up: the image repeats */
    const uint16_t *row = source->levels + (size_t)(j % height) * width;
    const uint16_t *next = source->levels + (size_t)((j + 1) % height) * width;
    float s = (float)(origin.u & 255) / 256, t = (float)(origin.v & 255) / 256;
    float below = row[i % width] + s * (float)(row[(i + 1) % width] - row[i % width]);
    float above = next[i % width] + s * (float)(next[(i + 1) % width] - next[i % width]);
    return below + t * (above - below);
}

/* Whether the depth buffer lets an origin through. */
static bool is_nearest(const Painter *painter, size_t at, Origin origin) {
    float level = level_at(painter->source, origin);
    uint32_t depth = (uint32_t)(16 * (painter->behind ? level : 65535 - level));
    if (depth >= painter->nearest[at]) return false;
    painter->nearest[at] = depth;
    return true;
}

/* Where to, and whether past a depth buffer: known where it is compiled, so that the order pays nothing for
 * it. */
typedef struct {
    Texel *texels;
    bool deep;
} Target;

static inline void put(const Painter *painter, Target target, size_t at, Origin origin) {
    if (target.deep && !is_nearest(painter, at, origin)) return;
    memcpy(target.texels + at, &origin, sizeof origin);
}

static inline float least(float a, float b) { return a < b ? a : b; }
static inline float greatest(float a, float b) { return a > b ? a : b; }
static inline float between(float a, float low, float high) { return least(greatest(a, low), high); }
static int ceil_int(float x) { return (int)x + ((float)(int)x < x); }

typedef struct {
    float x, y;
} Point;

static inline float cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

static inline Point corner(const LandedRow *row, int i, int x, int y) {
    return (Point){row->x[i] - (float)x, row->y[i] - (float)y};
}

static void put_at(const Painter *painter, size_t at, int i, float s, float t) {
    const float *u = painter->columns;
    Target target = {painter->destination->texels, painter->nearest != NULL};
    put(painter, target, at,
        (Origin){(int)(u[i - 1] + (u[i] - u[i - 1]) * between(s, 0, 1)),
                 (int)(painter->row + (painter->next_row - painter->row) * between(t, 0, 1))});
}

/* Whether nothing lies farther away there; in the order, for the depth buffer cannot know yet. */
static bool is_empty(const Painter *painter, size_t at) {
    if (painter->nearest) return false;
    Origin origin;
    memcpy(&origin, painter->destination->texels + at, sizeof origin);
    return origin.u == NOWHERE;
}

/* A cell that is not convex, or turned over in part, centre by centre: few cells are. It is taken for the
 * triangles 00 10 11 and 00 11 01. But the bilinear patch lies anywhere within the tetrahedron of its
 * corners, so the other two faces count where there is nothing else. */
static void paint_folded(const Painter *painter, int i) {
    const float *x0 = painter->below.x + i, *x1 = painter->above.x + i, *y0 = painter->below.y + i,
                *y1 = painter->above.y + i;
    int width = painter->destination->width, height = painter->destination->height;
    float left = least(least(x0[-1], x0[0]), least(x1[-1], x1[0])),
          right = greatest(greatest(x0[-1], x0[0]), greatest(x1[-1], x1[0]));
    float bottom = least(least(y0[-1], y0[0]), least(y1[-1], y1[0])),
          top = greatest(greatest(y0[-1], y0[0]), greatest(y1[-1], y1[0]));
    int end_column = ceil_int(least(right, (float)width)), end_row = ceil_int(least(top, (float)height));
    for (int y = ceil_int(greatest(bottom, 0)); y < end_row; y++) {
        for (int x = ceil_int(greatest(left, 0)); x < end_column; x++) {
            Point p00 = corner(&painter->below, i - 1, x, y), p10 = corner(&painter->below, i, x, y);
            Point p01 = corner(&painter->above, i - 1, x, y), p11 = corner(&painter->above, i, x, y);
            float b = cross(p00, p10), r = cross(p10, p11), t = cross(p11, p01), l = cross(p01, p00);
            float d = cross(p11, p00), e = cross(p10, p01), near = -SLACK;
            float t0 = b + r + d, t1 = t + l - d, t2 = b + l + e, t3 = r + t - e;
            size_t at = (size_t)y * width + x;
            if (t0 > 0 && b >= near && r >= near && d >= near)
                put_at(painter, at, i, 1 - r / t0, b / t0);
            else if (t1 > 0 && t >= near && l >= near && -d >= near)
                put_at(painter, at, i, l / t1, 1 - t / t1);
            else if (!is_empty(painter, at))
                continue;
            else if (t2 > 0 && b >= near && l >= near && e >= near)
                put_at(painter, at, i, l / t2, b / t2);
            else if (t3 > 0 && r >= near && t >= near && -e >= near)
                put_at(painter, at, i, 1 - r / t3, 1 - t / t3);
        }
    }
}

/* ---- Convex cells that cover many texels ---- */

/* The side from (ax, ay) to (bx, by): the cell lies right of it where it falls, left of it where it rises
 * (the other way round if turned), and a level one bounds no line. */
#define MEASURE_SIDE(k, ax, ay, bx, by)                                                                      \
    {                                                                                                        \
        Floats rise = by - ay, step = (bx - ax) / rise;                                                      \
        Ints falls = ((rise < zero) ^ turned) & (rise != zero), rises = ~falls & (rise != zero);             \
        Floats slope = GREATEST(step, -step), at = ax - ay * step, slack = SLACK * (slope + 1.0f);           \
        Floats low_at = PICK(falls, at - slack, -far), low_step = PICK(falls, step, zero);                   \
        Floats high_at = PICK(rises, at + slack, far), high_step = PICK(rises, step, zero);                  \
        STORE(low_at, block->low_at[k]), STORE(low_step, block->low_step[k]);                                \
        STORE(high_at, block->high_at[k]), STORE(high_step, block->high_step[k]);                            \
    }

WIDE static void block_measure(Block *block, int width, int height, float row, float next_row) {
    const Floats right_edge = ALL((float)width), top_edge = ALL((float)height), zero = {0}, far = ALL(FAR);
    Floats x00, x10, x11, x01, y00, y10, y11, y01, u_left, u_right;
    LOAD(x00, block->x00), LOAD(x10, block->x10), LOAD(x11, block->x11), LOAD(x01, block->x01);
    LOAD(y00, block->y00), LOAD(y10, block->y10), LOAD(y11, block->y11), LOAD(y01, block->y01);
    LOAD(u_left, block->u_left), LOAD(u_right, block->u_right);
    Floats min0 = LEAST(x00, x10), min1 = LEAST(x01, x11), max0 = GREATEST(x00, x10),
           max1 = GREATEST(x01, x11);
    Floats left = LEAST(min0, min1), right = GREATEST(max0, max1);
    min0 = LEAST(y00, y10), min1 = LEAST(y01, y11), max0 = GREATEST(y00, y10), max1 = GREATEST(y01, y11);
    Floats bottom = LEAST(min0, min1), top = GREATEST(max0, max1);
    left = GREATEST(left, zero), right = LEAST(right, right_edge);
    bottom = GREATEST(bottom, zero), top = LEAST(top, top_edge);
    Ints column = CEIL(left), columns = CEIL(right) - column, first_row = CEIL(bottom),
         rows = CEIL(top) - first_row;
    Ints start = first_row * width + column, turned = columns < rows;
    Ints lines = (columns & turned) | (rows & ~turned), length = (rows & turned) | (columns & ~turned);
    STORE(start, block->start), STORE(turned, block->turned), STORE(lines, block->lines),
        STORE(length, block->length);
    Floats x = FLOATS_OF(column), y = FLOATS_OF(first_row);
    x00 -= x, x10 -= x, x11 -= x, x01 -= x, y00 -= y, y10 -= y, y11 -= y, y01 -= y;
    Floats a00 = PICK(turned, y00, x00), a10 = PICK(turned, y10, x10), a11 = PICK(turned, y11, x11),
           a01 = PICK(turned, y01, x01);
    Floats b00 = PICK(turned, x00, y00), b10 = PICK(turned, x10, y10), b11 = PICK(turned, x11, y11),
           b01 = PICK(turned, x01, y01);
    /* The parallelogram nearest to the cell: u and v are linear in it. */
    Floats s_a = 0.5f * (a10 - a00 + a11 - a01), s_b = 0.5f * (b10 - b00 + b11 - b01);
    Floats t_a = 0.5f * (a01 - a00 + a11 - a10), t_b = 0.5f * (b01 - b00 + b11 - b10);
    Floats a = 0.25f * (a00 + a10 + a01 + a11), b = 0.25f * (b00 + b10 + b01 + b11);
    Floats area = s_a * t_b - s_b * t_a, u_r = (u_right - u_left) / area, v_r = (next_row - row) / area;
    Floats u_x = t_b * u_r, u_y = -t_a * u_r, v_x = -s_b * v_r, v_y = s_a * v_r;
    Floats u_0 = 0.5f * (u_left + u_right) - a * u_x - b * u_y,
           v_0 = 0.5f * (row + next_row) - a * v_x - b * v_y;
    STORE(u_0, block->u_0), STORE(u_x, block->u_x), STORE(u_y, block->u_y);
    STORE(v_0, block->v_0), STORE(v_x, block->v_x), STORE(v_y, block->v_y);
    MEASURE_SIDE(0, a00, b00, a10, b10)
    MEASURE_SIDE(1, a10, b10, a11, b11)
    MEASURE_SIDE(2, a11, b11, a01, b01)
    MEASURE_SIDE(3, a01, b01, a00, b00)
}

WIDE static void block_cut(const Block *block, Line *lines, int line_count, float row, float next_row) {
    const Floats zero = {0}, low_v = ALL(row), high_v = ALL(next_row);
    Floats u, u_x, u_y, v, v_x, v_y, u_left, u_right;
    Ints length;
    LOAD(u, block->u_0), LOAD(u_x, block->u_x), LOAD(u_y, block->u_y), LOAD(u_left, block->u_left);
    LOAD(v, block->v_0), LOAD(v_x, block->v_x), LOAD(v_y, block->v_y), LOAD(u_right, block->u_right);
    LOAD(length, block->length);
    const Floats all = FLOATS_OF(length);
    for (int n = 0; n < line_count; n++) {
        float y = (float)n;
        Floats from = zero, to = all - 1.0f;
        for (int k = 0; k < 4; k++) {
            Floats at, step;
            LOAD(at, block->low_at[k]), LOAD(step, block->low_step[k]);
            at += step * y;
            from = GREATEST(from, at);
            LOAD(at, block->high_at[k]), LOAD(step, block->high_step[k]);
            at += step * y;
            to = LEAST(to, at);
        }
        from = LEAST(from, all), to = GREATEST(to, zero - 1.0f); /* so that they are integers of a kind */
        Ints first = CEIL(from), end = INTS_OF(to + 1.0f);
        Floats x = FLOATS_OF(first), at_u = u + u_x * x + u_y * y, at_v = v + v_x * x + v_y * y;
        at_u = GREATEST(at_u, u_left), at_v = GREATEST(at_v, low_v);
        at_u = LEAST(at_u, u_right), at_v = LEAST(at_v, high_v);
        Ints from_u = INTS_OF(at_u), from_v = INTS_OF(at_v);
        STORE(first, lines[n].first), STORE(end, lines[n].end);
        STORE_PAIRS(from_u, from_v, lines[n].from);
    }
}

/* Makes ready the first of count cells, one a lane; where they are fewer than lanes, the first one again. */
static void block_fill(const Painter *painter, const int *cells, int count) {
    const LandedRow *below = &painter->below, *above = &painter->above;
    Block *block = painter->block;
    for (int k = 0; k < LANES; k++) {
        int i = cells[k < count ? k : 0];
        block->x00[k] = below->x[i - 1], block->x10[k] = below->x[i], block->x11[k] = above->x[i],
        block->x01[k] = above->x[i - 1];
        block->y00[k] = below->y[i - 1], block->y10[k] = below->y[i], block->y11[k] = above->y[i],
        block->y01[k] = above->y[i - 1];
        block->u_left[k] = painter->columns[i - 1], block->u_right[k] = painter->columns[i];
    }
    block_measure(block, painter->destination->width, painter->destination->height, painter->row,
                  painter->next_row);
    int most = 0;
    for (int k = 0; k < LANES; k++) most = block->lines[k] > most ? block->lines[k] : most;
    block_cut(block, painter->lines, most, painter->row, painter->next_row);
}

/* Cell k of the block. */
static inline void paint_many(const Painter *painter, Target target, int k) {
    const Block *block = painter->block;
    size_t width = (size_t)painter->destination->width;
    size_t column_step = block->turned[k] ? width : 1, row_step = block->turned[k] ? 1 : width;
    size_t start = (size_t)block->start[k];
    const Line *line = painter->lines, *end_line = line + block->lines[k];
    for (; line < end_line; line++, start += row_step) {
        int x = line->first[k], end = line->end[k];
        if (x >= end) continue;
        size_t at = start + (size_t)x * column_step;
        put(painter, target, at, line->from[k]);
        if (++x >= end) continue;
        float y = (float)(line - painter->lines), u = block->u_0[k] + block->u_y[k] * y,
              v = block->v_0[k] + block->v_y[k] * y;
        for (; x < end; x++) {
            at += column_step;
            float at_u = between(u + block->u_x[k] * (float)x, block->u_left[k], block->u_right[k]);
            float at_v = between(v + block->v_x[k] * (float)x, painter->row, painter->next_row);
            put(painter, target, at, (Origin){(int)at_u, (int)at_v});
        }
    }
}

static inline void paint_cells(const Painter *painter, Run columns, Target target) {
    const int *covers = painter->covers;
    const Origin *from = painter->from;
    int *some = painter->some, *many = painter->many, some_count = 0, many_count = 0;
    for (int i = columns.first; i != columns.end; i += columns.step) {
        some[some_count] = many[many_count] = i;
        some_count += covers[i] != NOTHING;
        many_count += covers[i] == MANY;
    }
    int used = 0;
    for (int n = 0; n < some_count; n++) {
        int i = some[n], cover = covers[i];
        if (cover >= 0)
            put(painter, target, (size_t)cover, from[i]);
        else if (cover == MANY) {
            if (used % LANES == 0) block_fill(painter, many + used, many_count - used);
            paint_many(painter, target, used++ % LANES);
        } else
            paint_folded(painter, i);
    }
}

static void paint_in_order(const Painter *painter, Run columns) {
    paint_cells(painter, columns, (Target){painter->destination->texels, false});
}

static void paint_by_depth(const Painter *painter, Run columns) {
    paint_cells(painter, columns, (Target){painter->destination->texels, true});
}

/* ---- From origins to texels ---- */

typedef uint8_t Bytes __attribute__((vector_size(8)));
typedef uint16_t Words __attribute__((vector_size(16)));

#define WORDS_OF(bytes) __builtin_convertvector(bytes, Words)

/* a + (b - a) weight / 256, rounded; exact in 16 bits, which is what is left of the sum when it overflows. */
#define MIX(a, b, weight) ((((a) << 8) + ((b) - (a)) * (weight) + 128) >> 8)

/* The same at the edges, where the image repeats. */
static Texel texel_at_edge(const Source *source, Origin origin) {
    int width = source->width, height = source->height;
    int i = (origin.u >> 8) + width, j = (origin.v >> 8) + height, s = origin.u & 255, t = origin.v & 255;
    const Texel *row = source->texels + (size_t)(j % height) * width;
    const Texel *next = source->texels + (size_t)((j + 1) % height) * width;
    const uint8_t *p00 = row[i % width].colour, *p10 = row[(i + 1) % width].colour;
    const uint8_t *p01 = next[i % width].colour, *p11 = next[(i + 1) % width].colour;
    Texel texel;
    uint8_t *bytes = (uint8_t *)&texel;
    for (int c = 0; c < 8; c++) {
        int left = (p00[c] * (256 - t) + p01[c] * t + 128) >> 8,
            right = (p10[c] * (256 - t) + p11[c] * t + 128) >> 8;
        bytes[c] = (uint8_t)((left * (256 - s) + right * s + 128) >> 8);
    }
    return texel;
}

static void fetch_lookup(const Source *source, Origin origin, float *lookup) {
    lookup[0] = ((float)origin.u / 256 + 0.5f) / (float)source->width;
    lookup[1] = ((float)origin.v / 256 + 0.5f) / (float)source->height;
    lookup[2] = level_at(source, origin) / 65535;
}

WIDE static void fetch_texels(const Source *source, size_t count, Texel *texels) {
    const Texel *const all = source->texels;
    const size_t width = (size_t)source->width;
    const uint32_t inner_width = (uint32_t)source->width - 1, inner_height = (uint32_t)source->height - 1;
    for (size_t k = 0; k < count; k++) {
        Origin origin;
        memcpy(&origin, texels + k, sizeof origin);
        const uint32_t i = (uint32_t)(origin.u >> 8), j = (uint32_t)(origin.v >> 8);
        if (i < inner_width && j < inner_height) {
            const Texel *p = all + (j * width + i);
            Bytes b00, b10, b01, b11;
            LOAD(b00, p), LOAD(b10, p + 1), LOAD(b01, p + width), LOAD(b11, p + width + 1);
            Words p00 = WORDS_OF(b00), p10 = WORDS_OF(b10), p01 = WORDS_OF(b01), p11 = WORDS_OF(b11);
            const uint16_t s = origin.u & 255, t = origin.v & 255;
            Words left = MIX(p00, p01, t), right = MIX(p10, p11, t);
            Bytes bytes = __builtin_convertvector(MIX(left, right, s), Bytes);
            STORE(bytes, texels + k);
        } else
            texels[k] = origin.u == NOWHERE ? (Texel){0} : texel_at_edge(source, origin);
    }
}

static void fetch_lookups(const Source *source, const Destination *destination) {
    size_t count = (size_t)destination->width * destination->height;
    for (size_t k = 0; k < count; k++) {
        float *lookup = destination->lookup + 3 * k;
        Origin origin;
        memcpy(&origin, destination->texels + k, sizeof origin);
        if (origin.u == NOWHERE)
            lookup[0] = lookup[1] = lookup[2] = 0;
        else
            fetch_lookup(source, origin, lookup);
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

static Painter painter_create(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                              Destination *destination) {
    size_t cells = (size_t)source->width + 1 + LANES,
           texels = (size_t)destination->width * destination->height;
    Painter painter = {.source = source, .destination = destination, .behind = factors->behind};
    painter.below = landed_row_create(source->width);
    painter.above = landed_row_create(source->width);
    painter.columns = (float *)allocate(cells + 1, sizeof(float)) + 1;
    for (int i = -1; i <= source->width; i++)
        painter.columns[i] = 256 * ((float)source->width * painter.below.u[i] - 0.5f);
    painter.covers = allocate(cells, sizeof *painter.covers);
    painter.from = allocate(cells, sizeof *painter.from);
    painter.some = allocate(cells, sizeof *painter.some);
    painter.many = allocate(cells, sizeof *painter.many);
    painter.block = allocate(1, sizeof *painter.block);
    painter.lines = allocate(
        (size_t)(destination->width > destination->height ? destination->width : destination->height),
        sizeof *painter.lines);
    if (visibility == VISIBILITY_DEPTH_BUFFER) {
        painter.nearest = allocate(texels, sizeof *painter.nearest);
        memset(painter.nearest, 0xff, texels * sizeof *painter.nearest);
    }
    return painter;
}

static void painter_destroy(Painter *painter) {
    landed_row_destroy(&painter->below);
    landed_row_destroy(&painter->above);
    free(painter->columns - 1);
    free(painter->covers);
    free(painter->from);
    free(painter->some);
    free(painter->many);
    free(painter->block);
    free(painter->lines);
    free(painter->nearest);
}

static void swap(LandedRow *a, LandedRow *b) {
    LandedRow other = *a;
    *a = *b;
    *b = other;
}

/* The cells between the two rows that were landed last. */
static void paint_row(Painter *painter, const Run columns[2]) {
    float height = (float)painter->source->height;
    painter->row = 256 * (height * painter->below.v - 0.5f);
    painter->next_row = 256 * (height * painter->above.v - 0.5f);
    cells_sort(painter);
    for (int run = 0; run < 2; run++) {
        if (painter->nearest)
            paint_by_depth(painter, columns[run]);
        else
            paint_in_order(painter, columns[run]);
    }
}

void fill_cells(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                Destination *destination, WarpCounts *counts) {
    Sheets sheets = cell_sheets(source, factors, visibility);
    Landing landing = landing_create(source, factors, destination);
    Painter painter = painter_create(source, factors, visibility, destination);
    size_t count = (size_t)destination->width * destination->height;
    memset(destination->texels, NOWHERE_BYTE, count * sizeof *destination->texels);
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
            paint_row(&painter, sheets.columns);
        }
    }
    if (destination->lookup) fetch_lookups(source, destination);
    fetch_texels(source, count, destination->texels);
    painter_destroy(&painter);
}
