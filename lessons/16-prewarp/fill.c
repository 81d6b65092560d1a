#include "fill.h"

#include "fail.h"
#include "lanes.h"
#include "origin.h"

#include <stdlib.h>

/* Painting first writes only where each destination texel comes from (origin.h): what is painted over was
 * never fetched. Origins lie in the upper half of the destination's own memory: from the first texel to the
 * last, each is read before the texel that takes its place is written. */

/* Which destination texel takes an origin: its number, or one of these. */
enum {
    NOTHING = -1, /* painted like any other, in the half that holds no origins: cheaper than to ask */
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
    int kind; /* what cells are in it: SOME with a choice, MORE with two, MOST with four, ODD ones that are
                 MANY or FOLDED */
} Group;

/* The same cells where some of them cover many: what is linear over each one's box, at the first centre. */
typedef struct {
    float sides[4][LANES];                  /* the sides' areas, see cells_sort; a texel to the right they */
    float right[4][LANES], above[4][LANES]; /* are less by `right`, a texel above more by `above` */
    float u_0[LANES], u_x[LANES], u_y[LANES], v_0[LANES], v_x[LANES], v_y[LANES];
    float u_left[LANES], u_right[LANES];
    int start[LANES], columns[LANES], rows[LANES]; /* the box: its first texel and size */
} Wide;

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
    Wide *wides;         /* of those groups that are ODD */
    uint8_t *origins;    /* of all destination texels */
} Painter;

/* Texels beyond a side that count as inside, so that rounding tears nothing. */
static const float SLACK = 1e-4f;

/* ---- What cells cover ---- */

/* Choice n: the texel that many after the start, seen from which the sides' areas are b, r, t and l, if it
 * lies in the cell. */
#define CHOOSE(n, after, b, r, t, l, u, v, here)                                                             \
    {                                                                                                        \
        Floats least0 = LEAST(b, r), least1 = LEAST(t, l), least = LEAST(least0, least1);                    \
        Ints inside = (least >= -SLACK) & (here);                                                            \
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
        min0 = LEAST(t0, t1), min1 = LEAST(t2, t3), max0 = GREATEST(t0, t1), max1 = GREATEST(t2, t3);
        Floats least_turn = LEAST(min0, min1), greatest_turn = GREATEST(max0, max1);
        Ints convex = least_turn > zero;
        some &= greatest_turn > zero;
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
        if (kind & ODD) {
            Wide *wide = painter->wides + i / LANES;
            Ints at, name = (MANY & convex) | (FOLDED & ~convex);
            LOAD(at, group->at[0]);
            at = (name & odd) | (at & ~odd);
            STORE(at, group->at[0]);
            STORE(b, wide->sides[0]), STORE(r, wide->sides[1]), STORE(t, wide->sides[2]),
                STORE(l, wide->sides[3]);
            STORE(b_x, wide->above[0]), STORE(r_x, wide->above[1]), STORE(t_x, wide->above[2]),
                STORE(l_x, wide->above[3]);
            STORE(b_y, wide->right[0]), STORE(r_y, wide->right[1]), STORE(t_y, wide->right[2]),
                STORE(l_y, wide->right[3]);
            STORE(u_0, wide->u_0), STORE(u_x, wide->u_x), STORE(u_y, wide->u_y), STORE(v_0, wide->v_0),
                STORE(v_x, wide->v_x), STORE(v_y, wide->v_y);
            STORE(u_left, wide->u_left), STORE(u_right, wide->u_right);
            STORE(start, wide->start), STORE(columns, wide->columns), STORE(rows, wide->rows);
        }
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
    }
}

/* ---- Painting ---- */

/* Whether the depth buffer lets an origin through. */
INLINE bool is_nearest(const Painter *painter, ptrdiff_t at, Origin origin) {
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

INLINE void put(const Painter *painter, Target target, ptrdiff_t at, Origin origin) {
    if (target.deep && (at < 0 || !is_nearest(painter, at, origin))) return;
    memcpy(target.origins + at * (ptrdiff_t)sizeof origin, &origin, sizeof origin);
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

WIDE static void put_some(const Painter *painter, ptrdiff_t at, const int *inside, const Origin *from) {
    Target target = {painter->origins, painter->nearest != NULL};
    for (int n = 0; n < LANES; n++)
        if (inside[n]) put(painter, target, at + n, from[n]);
}

/* Cell k of a group, eight texels of a row of its box at a time: those that lie in the cell take their
 * origins, the others keep theirs. */
WIDE static void paint_many(const Painter *painter, const Wide *wide, int k) {
    const Destination *destination = painter->destination;
    uint8_t *const origins = painter->origins;
    const bool deep = painter->nearest != NULL;
    const int width = destination->width, columns = wide->columns[k], rows = wide->rows[k];
    const ptrdiff_t whole = (ptrdiff_t)width * destination->height - LANES; /* the last at with so many */
    const Floats u_left = ALL(wide->u_left[k]), u_right = ALL(wide->u_right[k]), low_v = ALL(painter->row),
                 high_v = ALL(painter->next_row);
    const Floats near = ALL(-SLACK * (float)(columns + rows)); /* rounding grows with the box */
    for (int x = 0; x < columns; x += LANES) {
        const Ints ramp = RAMP + x, within = ramp < columns;
        const Floats along = FLOATS_OF(ramp);
        Floats b = wide->sides[0][k] - wide->right[0][k] * along;
        Floats r = wide->sides[1][k] - wide->right[1][k] * along;
        Floats t = wide->sides[2][k] - wide->right[2][k] * along;
        Floats l = wide->sides[3][k] - wide->right[3][k] * along;
        Floats u = wide->u_0[k] + wide->u_x[k] * along, v = wide->v_0[k] + wide->v_x[k] * along;
        ptrdiff_t at = wide->start[k] + x;
        for (int y = 0; y < rows; y++, at += width) {
            Floats least0 = LEAST(b, r), least1 = LEAST(t, l), least = LEAST(least0, least1);
            Ints inside = (least >= near) & within;
            Floats at_u = GREATEST(u, u_left), at_v = GREATEST(v, low_v);
            at_u = LEAST(at_u, u_right), at_v = LEAST(at_v, high_v);
            Uints from = (Uints)INTS_OF(at_v) << 16 | (Uints)INTS_OF(at_u);
            if (at <= whole && !deep) {
                Uints kept;
                LOAD(kept, origins + at * (ptrdiff_t)sizeof(Origin));
                from = (from & (Uints)inside) | (kept & ~(Uints)inside);
                STORE(from, origins + at * (ptrdiff_t)sizeof(Origin));
            } else if (ANY(inside)) {
                int lanes[LANES];
                Origin some[LANES];
                STORE(inside, lanes), STORE(from, some);
                put_some(painter, at, lanes, some);
            }
            b += wide->above[0][k], r += wide->above[1][k], t += wide->above[2][k], l += wide->above[3][k];
            u += wide->u_y[k], v += wide->v_y[k];
        }
    }
}

/* The part of a run in group g. */
static inline Run run_within(Run run, int g) {
    int low = run.step > 0 ? run.first : run.end + 1, high = run.step > 0 ? run.end : run.first + 1;
    low = low < g * LANES ? 0 : low - g * LANES, high = high > (g + 1) * LANES ? LANES : high - g * LANES;
    return run.step > 0 ? (Run){low, high, 1} : (Run){high - 1, low - 1, -1};
}

INLINE void paint_choices(const Painter *painter, const Group *group, Run run, int choices, Target target) {
    for (int k = run.first; k != run.end; k += run.step)
        for (int n = 0; n < choices; n++) put(painter, target, group->at[n][k], group->from[n][k]);
}

INLINE void paint_cells(const Painter *painter, Run columns, Target target) {
    if (columns.first == columns.end) return;
    int step = columns.step, first = columns.first / LANES, end = (columns.end - step) / LANES + step;
    for (int g = first; g != end; g += step) {
        const Group *group = painter->groups + g;
        if (!group->kind) continue;
        Run run = run_within(columns, g);
        if (group->kind & ODD)
            for (int k = run.first; k != run.end; k += run.step) {
                if (group->at[0][k] == MANY)
                    paint_many(painter, painter->wides + g, k);
                else if (group->at[0][k] == FOLDED)
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
    painter.wides = allocate(cells / LANES, sizeof *painter.wides);
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
    free(painter->wides);
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
    if (destination->lookup) origins_lookup(source, painter.origins, count, destination->lookup);
    origins_fetch(source, painter.origins, count, destination->texels);
    painter_destroy(&painter);
}
