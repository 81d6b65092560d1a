#include "fill.h"

#include "fail.h"
#include "lanes.h"

#include <stdlib.h>

/* Where a destination texel comes from: its u and v in 1/65536 of the source, v in the upper half. */
typedef uint32_t Origin;

static const Origin NOWHERE = 0xffffffff; /* which rounds to no u and v of a cell: v ends at 65534 */

/* Which destination texel takes an origin: its number, or one of these. */
enum {
    NOTHING = -1, /* painted like any other: there is room for it */
    MANY = -2,    /* of the first choice: the cell may cover more texels than there are choices */
    FOLDED = -3   /* of the first choice: perhaps some, but the cell is not convex */
};

/* As many cells of one row as there are lanes. Most cover one texel at most, few more than one of a row or
 * column of two, few of those more than two of a box of four: these are the choices. */
enum { CHOICES = 4 };
enum { SOME = 1, MORE = 2, MOST = 4, ODD = 8 };

typedef struct {
    int at[CHOICES][LANES];
    Origin from[CHOICES][LANES];
    int kind; /* what some cell of it has: SOME at least a choice, MORE two, MOST four, ODD is MANY or FOLDED
               */
} Group;

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
    Group *groups;       /* of the cells between these rows */
    int *many;           /* in the order of painting: cells that cover many */
    uint8_t *origins;    /* of each destination texel, four bytes */
    Block *block;
    Line *lines;
} Painter;

/* Texels beyond a side that count as inside, so that rounding tears nothing. */
static const float SLACK = 1e-4f, FAR = 1e9f;

/* ---- What cells cover ---- */

/* Choice n: the texel that many after the start, seen from which the sides' areas are b, r, t and l, if it
 * lies in the cell. */
#define CHOOSE(n, after, b, r, t, l, u, v, here)                                                             \
    {                                                                                                        \
        Ints inside = ((b) >= -SLACK) & ((r) >= -SLACK) & ((t) >= -SLACK) & ((l) >= -SLACK) & (here);        \
        Ints at = (start + (after)) | ~inside; /* NOTHING is -1 */                                           \
        Floats at_u = GREATEST(u, u_left), at_v = GREATEST(v, low_v);                                        \
        at_u = LEAST(at_u, u_right), at_v = LEAST(at_v, high_v);                                             \
        Uints from = (Uints)INTS_OF(at_v) << 16 | (Uints)INTS_OF(at_u);                                      \
        STORE(at, group->at[n]), STORE(from, group->from[n]);                                                \
    }

/* For each cell of a row: what it covers, and where in the source that lies.
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
    const Floats zero = {0}, low_v = ALL(painter->row), high_v = ALL(painter->next_row);
    const float rise = painter->next_row - painter->row, *columns_u = painter->columns;
    const int count = painter->below.count;
    Group *group = painter->groups;
    for (int i = 0; i <= count; i += LANES, group++) {
        Floats x00, x10, x11, x01, y00, y10, y11, y01, u_left, u_right;
        LOAD(x00, below_x + i - 1), LOAD(x10, below_x + i), LOAD(x01, above_x + i - 1),
            LOAD(x11, above_x + i);
        LOAD(y00, below_y + i - 1), LOAD(y10, below_y + i), LOAD(y01, above_y + i - 1),
            LOAD(y11, above_y + i);
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
        Ints some = (columns > 0) & (rows > 0) & somewhere;
        LOAD(u_left, columns_u + i - 1), LOAD(u_right, columns_u + i);
        Floats x = FLOATS_OF(column), y = FLOATS_OF(first_row);
        x00 -= x, x10 -= x, x11 -= x, x01 -= x, y00 -= y, y10 -= y, y11 -= y, y01 -= y;
        Floats b = x00 * y10 - y00 * x10, r = x10 * y11 - y10 * x11, t = x11 * y01 - y11 * x01,
               l = x01 * y00 - y01 * x00;
        Floats d = x11 * y00 - y11 * x00, e = x10 * y01 - y10 * x01;
        /* The four triangles of three corners: all turn left in a convex cell, none in one turned over. */
        Floats t0 = b + r + d, t1 = t + l - d, t2 = b + l + e, t3 = r + t - e;
        some &= (t0 > zero) | (t1 > zero) | (t2 > zero) | (t3 > zero);
        Ints convex = (t0 > zero) & (t1 > zero) & (t2 > zero) & (t3 > zero);
        Ints wider = columns > 1, higher = rows > 1, easy = some & convex & (columns <= 2) & (rows <= 2);
        Ints more = easy & (wider | higher), most = easy & wider & higher, odd = some & ~easy;
        Ints kinds = (some & SOME) | (more & MORE) | (most & MOST) | (odd & ODD);
        const int kind = group->kind = (int)EITHER(kinds);
        if (!kind) continue;
        Ints start = first_row * width + column;
        Floats b_x = x10 - x00, r_x = x11 - x10, t_x = x01 - x11, l_x = x00 - x01;
        Floats b_y = y10 - y00, r_y = y11 - y10, t_y = y01 - y11, l_y = y00 - y01;
        /* u and v of the parallelogram nearest to the cell: linear. */
        Floats area = b + r + t + l, share = 1.0f / area, u_r = (u_right - u_left) * share,
               v_r = rise * share;
        Floats u_x = (r_y - l_y) * u_r, u_y = (l_x - r_x) * u_r;
        Floats v_x = (t_y - b_y) * v_r, v_y = (b_x - t_x) * v_r;
        Floats x_c = 0.25f * (x00 + x10 + x11 + x01), y_c = 0.25f * (y00 + y10 + y11 + y01);
        Floats u_0 = 0.5f * (u_left + u_right) - x_c * u_x - y_c * u_y;
        Floats v_0 = 0.5f * (low_v + high_v) - x_c * v_x - y_c * v_y;
        CHOOSE(0, 0, b, r, t, l, u_0, v_0, easy)
        if (kind & MORE) {
            Ints after = (wider & 1) | (~wider & width);
            Floats b_1 = b + PICK(wider, -b_y, b_x), r_1 = r + PICK(wider, -r_y, r_x);
            Floats t_1 = t + PICK(wider, -t_y, t_x), l_1 = l + PICK(wider, -l_y, l_x);
            Floats u_1 = u_0 + PICK(wider, u_x, u_y), v_1 = v_0 + PICK(wider, v_x, v_y);
            CHOOSE(1, after, b_1, r_1, t_1, l_1, u_1, v_1, more)
            if (kind & MOST) {
                b += b_x, r += r_x, t += t_x, l += l_x, u_0 += u_y, v_0 += v_y;
                CHOOSE(2, width, b, r, t, l, u_0, v_0, most)
                b -= b_y, r -= r_y, t -= t_y, l -= l_y, u_0 += u_x, v_0 += v_x;
                CHOOSE(3, width + 1, b, r, t, l, u_0, v_0, most)
            }
        }
        if (kind & ODD) {
            Ints at, name = (MANY & convex) | (FOLDED & ~convex);
            LOAD(at, group->at[0]);
            at = (name & odd) | (at & ~odd);
            STORE(at, group->at[0]);
        }
    }
}

/* ---- Painting ---- */

/* A number of 1/65536 of an axis of so many texels, in 1/65536 of a texel from the first one's centre. */
static inline int from_centre(uint32_t share, int texels) { return (int)share * texels - 32768; }

/* Where an origin lies: between texels column and right of rows row and above, and so many 1/256 on. The
 * image repeats. */
typedef struct {
    int column, right, row, above, s, t;
} Place;

static Place place_of(const Source *source, Origin origin) {
    int width = source->width, height = source->height;
    int u = from_centre(origin & 65535, width), v = from_centre(origin >> 16, height);
    int i = (u >> 16) + width, j = (v >> 16) + height;
    return (Place){.column = i % width,
                   .right = (i + 1) % width,
                   .row = j % height,
                   .above = (j + 1) % height,
                   .s = u >> 8 & 255,
                   .t = v >> 8 & 255};
}

/* The source's level at an origin, bilinear. */
static float level_at(const Source *source, Origin origin) {
    Place p = place_of(source, origin);
    const uint16_t *row = source->levels + (size_t)p.row * source->width;
    const uint16_t *next = source->levels + (size_t)p.above * source->width;
    float s = (float)p.s / 256, t = (float)p.t / 256;
    float below = row[p.column] + s * (float)(row[p.right] - row[p.column]);
    float above = next[p.column] + s * (float)(next[p.right] - next[p.column]);
    return below + t * (above - below);
}

/* Whether the depth buffer lets an origin through. */
static bool is_nearest(const Painter *painter, ptrdiff_t at, Origin origin) {
    float level = level_at(painter->source, origin);
    uint32_t depth = (uint32_t)(16 * (painter->behind ? level : 65535 - level));
    if (depth >= painter->nearest[at]) return false;
    painter->nearest[at] = depth;
    return true;
}

/* Where to, and whether past a depth buffer: known where it is compiled, so that the order pays nothing for
 * it. */
typedef struct {
    uint8_t *origins;
    bool deep;
} Target;

static inline __attribute__((always_inline)) void put(const Painter *painter, Target target, ptrdiff_t at,
                                                      Origin origin) {
    if (target.deep && (at < 0 || !is_nearest(painter, at, origin))) return;
    memcpy(target.origins + at * (ptrdiff_t)sizeof origin, &origin, sizeof origin);
}

static inline Origin origin_of(float u, float v) { return (uint32_t)(int)v << 16 | (uint32_t)(int)u; }

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

static void put_at(const Painter *painter, ptrdiff_t at, int i, float s, float t) {
    const float *u = painter->columns;
    Target target = {painter->origins, painter->nearest != NULL};
    put(painter, target, at,
        origin_of(u[i - 1] + (u[i] - u[i - 1]) * between(s, 0, 1),
                  painter->row + (painter->next_row - painter->row) * between(t, 0, 1)));
}

/* Whether nothing lies farther away there; in the order, for the depth buffer cannot know yet. */
static bool is_empty(const Painter *painter, ptrdiff_t at) {
    if (painter->nearest) return false;
    Origin origin;
    memcpy(&origin, painter->origins + at * (ptrdiff_t)sizeof origin, sizeof origin);
    return origin == NOWHERE;
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
            ptrdiff_t at = (ptrdiff_t)y * width + x;
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
        Uints from_uv = (Uints)INTS_OF(at_v) << 16 | (Uints)INTS_OF(at_u);
        STORE(first, lines[n].first), STORE(end, lines[n].end), STORE(from_uv, lines[n].from);
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
static inline __attribute__((always_inline)) void paint_many(const Painter *painter, Target target, int k) {
    const Block *block = painter->block;
    ptrdiff_t width = painter->destination->width;
    ptrdiff_t column_step = block->turned[k] ? width : 1, row_step = block->turned[k] ? 1 : width;
    ptrdiff_t start = block->start[k];
    const Line *line = painter->lines, *end_line = line + block->lines[k];
    for (; line < end_line; line++, start += row_step) {
        int x = line->first[k], end = line->end[k];
        ptrdiff_t at = start + x * column_step;
        put(painter, target, x < end ? at : NOTHING, line->from[k]);
        if (++x >= end) continue;
        float y = (float)(line - painter->lines), u = block->u_0[k] + block->u_y[k] * y,
              v = block->v_0[k] + block->v_y[k] * y;
        for (; x < end; x++) {
            at += column_step;
            float at_u = between(u + block->u_x[k] * (float)x, block->u_left[k], block->u_right[k]);
            float at_v = between(v + block->v_x[k] * (float)x, painter->row, painter->next_row);
            put(painter, target, at, origin_of(at_u, at_v));
        }
    }
}

/* The part of a run in group g. */
static inline Run run_within(Run run, int g) {
    int low = run.step > 0 ? run.first : run.end + 1, high = run.step > 0 ? run.end : run.first + 1;
    low = low < g * LANES ? 0 : low - g * LANES, high = high > (g + 1) * LANES ? LANES : high - g * LANES;
    return run.step > 0 ? (Run){low, high, 1} : (Run){high - 1, low - 1, -1};
}

static int list_many(const Painter *painter, Run columns, int first, int end, int step) {
    int count = 0;
    for (int g = first; g != end; g += step) {
        if (!(painter->groups[g].kind & ODD)) continue;
        Run run = run_within(columns, g);
        for (int k = run.first; k != run.end; k += run.step) {
            painter->many[count] = g * LANES + k;
            count += painter->groups[g].at[0][k] == MANY;
        }
    }
    return count;
}

static inline __attribute__((always_inline)) void paint_choices(const Painter *painter, const Group *group,
                                                                Run run, int choices, Target target) {
    for (int k = run.first; k != run.end; k += run.step)
        for (int n = 0; n < choices; n++) put(painter, target, group->at[n][k], group->from[n][k]);
}

static inline __attribute__((always_inline)) void paint_cells(const Painter *painter, Run columns,
                                                              Target target) {
    if (columns.first == columns.end) return;
    int step = columns.step, first = columns.first / LANES, end = (columns.end - step) / LANES + step;
    int many_count = list_many(painter, columns, first, end, step), used = 0;
    for (int g = first; g != end; g += step) {
        const Group *group = painter->groups + g;
        if (!group->kind) continue;
        Run run = run_within(columns, g);
        if (group->kind & ODD)
            for (int k = run.first; k != run.end; k += run.step) {
                if (group->at[0][k] == MANY) {
                    if (used % LANES == 0) block_fill(painter, painter->many + used, many_count - used);
                    paint_many(painter, target, used++ % LANES);
                } else if (group->at[0][k] == FOLDED)
                    paint_folded(painter, g * LANES + k);
                else
                    paint_choices(painter, group, (Run){k, k + 1, 1},
                                  group->kind & MOST   ? CHOICES
                                  : group->kind & MORE ? 2
                                                       : 1,
                                  target);
            }
        else if (group->kind & MOST)
            paint_choices(painter, group, run, CHOICES, target);
        else if (group->kind & MORE)
            paint_choices(painter, group, run, 2, target);
        else
            paint_choices(painter, group, run, 1, target);
    }
}

static void paint_in_order(const Painter *painter, Run columns) {
    paint_cells(painter, columns, (Target){painter->origins, false});
}

static void paint_by_depth(const Painter *painter, Run columns) {
    paint_cells(painter, columns, (Target){painter->origins, true});
}

/* ---- From origins to texels ---- */

/* Two times two texels that are neighbours in a row, byte by byte or two bytes a word. */
typedef uint16_t Words __attribute__((vector_size(32)));
typedef uint64_t Pair __attribute__((vector_size(16)));
typedef uint64_t Longs __attribute__((vector_size(32)));

/* (1 - weight / 256) a + weight / 256 b, rounded: exact in 16 bits. */
#define MIX(a, b, weight) (((a) * (256 - (weight)) + (b) * (weight) + 128) >> 8)

/* The texel at an origin, wherever that lies. */
static Texel texel_at(const Source *source, Origin origin) {
    Texel texel = {0};
    if (origin == NOWHERE) return texel;
    Place p = place_of(source, origin);
    const Texel *row = source->texels + (size_t)p.row * source->width;
    const Texel *next = source->texels + (size_t)p.above * source->width;
    const uint8_t *p00 = row[p.column].colour, *p10 = row[p.right].colour;
    const uint8_t *p01 = next[p.column].colour, *p11 = next[p.right].colour;
    uint8_t *bytes = (uint8_t *)&texel;
    for (int c = 0; c < 8; c++)
        bytes[c] = (uint8_t)MIX(MIX(p00[c], p01[c], p.t), MIX(p10[c], p11[c], p.t), p.s);
    return texel;
}

static void fetch_lookup(const Source *source, Origin origin, float *lookup) {
    lookup[0] = (float)(origin & 65535) / 65536;
    lookup[1] = (float)(origin >> 16) / 65536;
    lookup[2] = level_at(source, origin) / 65535;
}

/* A word is two bytes of a texel; both are mixed at once, each in a vector of its own. */
#define LOW(words) ((words)&255)
#define HIGH(words) ((words) >> 8)

/* Texels `first` and `second` of a block, each with its right neighbour, mixed with those above by t: the
 * even bytes and the odd ones. */
#define MIX_ROWS(even, odd, first, second)                                                                   \
    {                                                                                                        \
        const Texel *p_ = source->texels + index[first], *q_ = source->texels + index[second];               \
        Pair p0_, p1_, q0_, q1_;                                                                             \
        LOAD(p0_, p_), LOAD(q0_, q_), LOAD(p1_, p_ + width), LOAD(q1_, q_ + width);                          \
        Words a_ = (Words)__builtin_shufflevector(p0_, q0_, 0, 1, 2, 3),                                     \
              b_ = (Words)__builtin_shufflevector(p1_, q1_, 0, 1, 2, 3);                                     \
        Words t_ = (Words)__builtin_shufflevector(t, t, first, first, first, first, second, second, second,  \
                                                  second);                                                   \
        even = MIX(LOW(a_), LOW(b_), t_), odd = MIX(HIGH(a_), HIGH(b_), t_);                                 \
    }

/* Texels first to first + 3 of a block. */
#define FETCH_FOUR(first)                                                                                    \
    {                                                                                                        \
        Words even0, even1, odd0, odd1;                                                                      \
        MIX_ROWS(even0, odd0, first, first + 2)                                                              \
        MIX_ROWS(even1, odd1, first + 1, first + 3)                                                          \
        Words s_ = (Words)__builtin_shufflevector(s, s, first, first, first + 1, first + 1, first + 2,       \
                                                  first + 2, first + 3, first + 3);                          \
        Words even = MIX(LEFT(even0, even1), RIGHT(even0, even1), s_);                                       \
        Words odd = MIX(LEFT(odd0, odd1), RIGHT(odd0, odd1), s_);                                            \
        Words both = even | odd << 8;                                                                        \
        STORE(both, texels + n + (first));                                                                   \
    }
#define LEFT(a, b) ((Words)__builtin_shufflevector((Longs)(a), (Longs)(b), 0, 4, 2, 6))
#define RIGHT(a, b) ((Words)__builtin_shufflevector((Longs)(a), (Longs)(b), 1, 5, 3, 7))

WIDE static void fetch_texels(const Source *source, const uint8_t *origins, size_t count, Texel *texels) {
    const int width = source->width, height = source->height;
    size_t n = 0, even = width > 1 && height > 1 ? count / LANES * LANES : 0;
    for (; n < even; n += LANES) {
        Uints origin;
        LOAD(origin, origins + n * sizeof(Origin));
        Ints x = (Ints)(origin & 65535) * width - 32768, y = (Ints)(origin >> 16) * height - 32768;
        Ints i = x >> 16, j = y >> 16;
        Ints edge = ((Uints)i >= (uint32_t)(width - 1)) | ((Uints)j >= (uint32_t)(height - 1));
        Ints nowhere = origin == NOWHERE;
        if (ANY(edge) && ALL_OF(nowhere)) {
            memset(texels + n, 0, LANES * sizeof *texels);
            continue;
        }
        Ints at = (j * width + i) & ~edge;
        int index[LANES];
        STORE(at, index);
        x = x >> 8 & 255, y = y >> 8 & 255;
        Ints s = x | x << 16, t = y | y << 16;
        FETCH_FOUR(0)
        FETCH_FOUR(4)
        if (ANY(edge))
            for (int k = 0; k < LANES; k++)
                if (edge[k]) texels[n + k] = texel_at(source, origin[k]);
    }
    for (; n < count; n++) {
        Origin origin;
        memcpy(&origin, origins + n * sizeof origin, sizeof origin);
        texels[n] = texel_at(source, origin);
    }
}

static void fetch_lookups(const Source *source, const uint8_t *origins, size_t count, float *lookup) {
    for (size_t n = 0; n < count; n++, lookup += 3) {
        Origin origin;
        memcpy(&origin, origins + n * sizeof origin, sizeof origin);
        if (origin == NOWHERE)
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
        painter.columns[i] = least(65536 * painter.below.u[i] + 0.5f, 65535);
    painter.origins = (uint8_t *)destination->texels + texels * sizeof(Origin);
    painter.groups = allocate(cells / LANES, sizeof *painter.groups);
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
    free(painter->groups);
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
    painter->row = least(65536 * painter->below.v + 0.5f, 65534);
    painter->next_row = least(65536 * painter->above.v + 0.5f, 65534);
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
    memset(painter.origins, NOWHERE & 255, count * sizeof(Origin));
    for (int run = 0; run < 2; run++) {
        Run rows = sheets.rows[run];
        bool up = rows.step > 0;
        if (rows.first == rows.end) continue;
        LandedRow *next = up ? &painter.above : &painter.below, *last = up ? &painter.below : &painter.above;
        landing_place(&landing, source, up ? rows.first - 1 : rows.first, next);
        for (int j = rows.first; j != rows.end; j += rows.step) {
            swap(next, last);
            landing_place(&landing, source, up ? j : j - 1, next);
            if (j < source->height) forward_count(&painter.above, destination, counts);
            paint_row(&painter, sheets.columns);
        }
    }
    if (destination->lookup) fetch_lookups(source, painter.origins, count, destination->lookup);
    fetch_texels(source, painter.origins, count, destination->texels);
    painter_destroy(&painter);
}
