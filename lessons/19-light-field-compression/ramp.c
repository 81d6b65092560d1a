#include "ramp.h"

#include "codec.h"
#include "fail.h"
#include "lanes.h"
#include "parallel.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* Colours are roots of linear light throughout: what the eye and sRGB take for even steps, and what costs a
 * shader one multiplication. */

enum { BLOCK_U = 8, BLOCK_V = 8, BLOCK_S = 2, BLOCK_T = 2, TEXELS = BLOCK_U * BLOCK_V * BLOCK_S * BLOCK_T };
enum { LEAVES_MOST = 64, LEAF_WORDS = 3, LEAF_BYTES = RAMP_LEAF_BYTES, SPLIT_BITS = 6, BASE_BITS = 26 };
static const int block_shift[4] = {3, 3, 1, 1};
enum { COLOUR_MOST = 127, SLOPE_MOST = 511, LEVEL_MOST = 1023, SCALES = 8 };

/* ---- A leaf: two colours, and a ramp between them ---- */

typedef struct {
    float a[3], b[3];
    float level,
        slope[4]; /* the share of b: level + slope . place, within 0..1; place from the leaf's lowest texel */
} Ramp;

static int rounded(float value, int most) {
    float nearest = roundf(value);
    return nearest < (float)-most ? -most : nearest > (float)most ? most : (int)nearest;
}

/* Slopes are in 512ths of a scale, 1/16 to 8, the least that holds them all; and the level, from 1/2, in
 * 64ths: where the ramp is 1/2 anywhere in a leaf of 8 x 8 x 2 x 2 texels, it is within 16 of its scales of
 * that at the lowest one. So what is kept of where an edge lies does not depend on how steep it is. A ramp
 * beyond the largest scale is made less steep, around where it is 1/2. */
static void leaf_write(const Ramp *ramp, uint32_t leaf[LEAF_WORDS]) {
    float needed = fabsf(ramp->level - 0.5f) * (64.0f / LEVEL_MOST), scale = 0.0625f, shrink;
    for (int i = 0; i < 4; i++) needed = fmaxf(needed, fabsf(ramp->slope[i]) * (512.0f / SLOPE_MOST));
    uint32_t number = 0, slope[4], colour[2] = {0, 0};
    for (; scale < needed && number < SCALES - 1; number++) scale *= 2.0f;
    shrink = needed > scale ? scale / needed : 1.0f;
    for (int i = 0; i < 4; i++)
        slope[i] = (uint32_t)rounded(ramp->slope[i] * shrink / scale * 512.0f, SLOPE_MOST) & 0x3ff;
    uint32_t level = (uint32_t)rounded((ramp->level - 0.5f) * shrink / scale * 64.0f, LEVEL_MOST);
    for (int k = 0; k < 3; k++) {
        colour[0] |= (uint32_t)rounded(ramp->a[k] * COLOUR_MOST, COLOUR_MOST) << 7 * k;
        colour[1] |= (uint32_t)rounded(ramp->b[k] * COLOUR_MOST, COLOUR_MOST) << 7 * k;
    }
    leaf[0] = colour[0] | level << 21;
    leaf[1] = colour[1] | slope[3] << 21 | number >> 2 << 31;
    leaf[2] = slope[0] | slope[1] << 10 | slope[2] << 20 | number << 30;
}

/* `bits` bits of a word, from bit `from` on, in two's complement. */
static float signed_bits(uint32_t word, int from, int bits) {
    return (float)((int32_t)(word << (32 - from - bits)) >> (32 - bits));
}

static Ramp leaf_read(const uint32_t leaf[LEAF_WORDS]) {
    Ramp ramp;
    float scale = (float)(1u << (leaf[2] >> 30 | leaf[1] >> 31 << 2)) / 16.0f;
    for (int k = 0; k < 3; k++) {
        ramp.a[k] = (float)(leaf[0] >> 7 * k & COLOUR_MOST) / COLOUR_MOST;
        ramp.b[k] = (float)(leaf[1] >> 7 * k & COLOUR_MOST) / COLOUR_MOST;
    }
    ramp.level = 0.5f + signed_bits(leaf[0], 21, 11) * scale / 64.0f;
    for (int i = 0; i < 3; i++) ramp.slope[i] = signed_bits(leaf[2], 10 * i, 10) * scale / 512.0f;
    ramp.slope[3] = signed_bits(leaf[1], 21, 10) * scale / 512.0f;
    return ramp;
}

static float share_at(const Ramp *ramp, const float place[4]) {
    float share = ramp->level;
    for (int i = 0; i < 4; i++) share += ramp->slope[i] * place[i];
    return share < 0.0f ? 0.0f : share > 1.0f ? 1.0f : share;
}

/* ---- Fitting one ---- */

/* The texels of a leaf, u fastest; those beyond the field, and behind the last some to a multiple of LANES,
 * weigh nothing. Places are from the leaf's middle. */
typedef struct {
    int count, padded;
    float middle[4];
    const float (*place)[TEXELS];
    float colour[3][TEXELS], weight[TEXELS], target[TEXELS];
} Part;

enum { UNKNOWNS = 5, SUMS = UNKNOWNS * (UNKNOWNS + 1) / 2 + UNKNOWNS, STEPS = 6, TURNS = 2 };
static const double SETTLED = 1e-3; /* of a plane, and of its slopes a texel */

static double apart(const Part *part, int i, const float colour[3]) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
        sum += (double)(part->colour[k][i] - colour[k]) * (part->colour[k][i] - colour[k]);
    return part->weight[i] > 0.0f ? sum : -1.0;
}

static int farthest(const Part *part, const float colour[3]) {
    int best = 0;
    double most = -1.0;
    for (int i = 0; i < part->count; i++) {
        double far = apart(part, i, colour);
        if (far > most) most = far, best = i;
    }
    return best;
}

/* Two colours far from one another: the one farthest from the mean, and the one farthest from that. False
 * where there is but one. */
static bool find_ends(const Part *part, Ramp *ramp) {
    float mean[3] = {0}, total = 0.0f;
    for (int i = 0; i < part->count; i++) {
        total += part->weight[i];
        for (int k = 0; k < 3; k++) mean[k] += part->colour[k][i] * part->weight[i];
    }
    for (int k = 0; k < 3; k++) mean[k] /= total;
    int a = farthest(part, mean);
    for (int k = 0; k < 3; k++) ramp->a[k] = part->colour[k][a];
    int b = farthest(part, ramp->a);
    for (int k = 0; k < 3; k++) ramp->b[k] = part->colour[k][b];
    return apart(part, b, ramp->a) > 0.0;
}

/* The share of b that each colour asks for: the foot of its perpendicular. */
WIDE static void find_targets(Part *part, const Ramp *ramp) {
    float d[3], squared = 1e-12f;
    for (int k = 0; k < 3; k++) d[k] = ramp->b[k] - ramp->a[k], squared += d[k] * d[k];
    for (int i = 0; i < part->padded; i += LANES) {
        Floats colour, target = ALL(0.0f);
        for (int k = 0; k < 3; k++) {
            LOAD(colour, part->colour[k] + i);
            target += (colour - ramp->a[k]) * (d[k] / squared);
        }
        target = LEAST(GREATEST(target, ALL(0.0f)), ALL(1.0f));
        STORE(target, part->target + i);
    }
}

/* The sums of the normal equations for (level, slope), over the texels that the ramp does not rightly hold at
 * 0 or 1 already; ramp NULL: over all. In order: the upper half of the matrix row by row, the right side. */
WIDE static void sum_plane(const Part *part, const Ramp *ramp, float sums[SUMS]) {
    Floats total[SUMS] = {{0}};
    for (int i = 0; i < part->padded; i += LANES) {
        Floats x[UNKNOWNS] = {ALL(1.0f)}, weight, target;
        for (int k = 0; k < 4; k++) LOAD(x[1 + k], part->place[k] + i);
        LOAD(weight, part->weight + i);
        LOAD(target, part->target + i);
        if (ramp) {
            Floats share = ALL(ramp->level);
            for (int k = 0; k < 4; k++) share += ramp->slope[k] * x[1 + k];
            Ints held = ((share <= 0.0f) & (target <= 0.002f)) | ((share >= 1.0f) & (target >= 0.998f));
            weight = PICK(held, ALL(0.0f), weight);
        }
        int n = 0;
#pragma GCC unroll 5
        for (int a = 0; a < UNKNOWNS; a++) {
            Floats weighted = weight * x[a];
#pragma GCC unroll 5
            for (int b = a; b < UNKNOWNS; b++) total[n++] += weighted * x[b];
            total[SUMS - UNKNOWNS + a] += weighted * target;
        }
    }
    float lanes[SUMS][LANES];
    memcpy(lanes, total, sizeof lanes);
    for (int n = 0; n < SUMS; n++) {
        for (int half = LANES / 2; half > 0; half /= 2)
            for (int lane = 0; lane < half; lane++) lanes[n][lane] += lanes[n][lane + half];
        sums[n] = lanes[n][0];
    }
}

/* Solves m x = right for a symmetric positive definite m, of which the upper half is read, as L D L^T. */
static void solve(double m[UNKNOWNS][UNKNOWNS], const double right[UNKNOWNS], double x[UNKNOWNS]) {
    for (int i = 0; i < UNKNOWNS; i++) {
        x[i] = right[i];
        for (int row = i + 1; row < UNKNOWNS; row++) {
            m[row][i] = m[i][row] / m[i][i];
            for (int k = row; k < UNKNOWNS; k++) m[row][k] -= m[row][i] * m[i][k];
        }
    }
    for (int i = 0; i < UNKNOWNS; i++)
        for (int k = 0; k < i; k++) x[i] -= m[i][k] * x[k];
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        x[i] /= m[i][i];
        for (int k = i + 1; k < UNKNOWNS; k++) x[i] -= m[k][i] * x[k];
    }
}

/* Least squares of a plane that is cut off at 0 and 1, by Newton's steps: each solves for the texels that the
 * last left between, or on the wrong side. What they do not determine (a leaf one texel wide) stays as it is.
 */
static void fit_plane(const Part *part, Ramp *ramp, bool first) {
    double moved = INFINITY;
    for (int step = 0; step < STEPS && moved > SETTLED; step++) {
        bool all = first && step == 0;
        float sums[SUMS];
        sum_plane(part, all ? NULL : ramp, sums);
        if (sums[0] <= 0.0f) return;
        double m[UNKNOWNS][UNKNOWNS], right[UNKNOWNS], next[UNKNOWNS];
        double now[UNKNOWNS] = {ramp->level, ramp->slope[0], ramp->slope[1], ramp->slope[2], ramp->slope[3]};
        int n = 0;
        for (int a = 0; a < UNKNOWNS; a++)
            for (int b = a; b < UNKNOWNS; b++) m[a][b] = sums[n++];
        for (int a = 0; a < UNKNOWNS; a++) {
            double keep = 1e-5 * m[a][a] + 1e-6 * sums[0];
            m[a][a] += keep;
            right[a] = sums[SUMS - UNKNOWNS + a] + (all ? 0.0 : keep * now[a]);
        }
        solve(m, right, next);
        moved = 0.0;
        for (int a = 0; a < UNKNOWNS; a++) moved = fmax(moved, fabs(next[a] - now[a]));
        ramp->level = (float)next[0];
        for (int k = 0; k < 4; k++) ramp->slope[k] = (float)next[1 + k];
    }
}

/* The two colours that are best for the ramp: least squares for each channel. */
WIDE static void fit_ends(const Part *part, Ramp *ramp) {
    enum { AA, AB, BB, RIGHT };
    Floats total[RIGHT + 6] = {{0}};
    for (int i = 0; i < part->padded; i += LANES) {
        Floats b = ALL(ramp->level), x, weight;
        for (int k = 0; k < 4; k++) {
            LOAD(x, part->place[k] + i);
            b += ramp->slope[k] * x;
        }
        b = LEAST(GREATEST(b, ALL(0.0f)), ALL(1.0f));
        LOAD(weight, part->weight + i);
        Floats a = (1.0f - b) * weight;
        total[AA] += a * (1.0f - b), total[AB] += a * b;
        b *= weight;
        total[BB] += b * b;
        for (int k = 0; k < 3; k++) {
            LOAD(x, part->colour[k] + i);
            total[RIGHT + k] += a * x, total[RIGHT + 3 + k] += b * x;
        }
    }
    double sums[RIGHT + 6] = {0};
    for (int n = 0; n < RIGHT + 6; n++)
        for (int lane = 0; lane < LANES; lane++) sums[n] += total[n][lane];
    double keep = 1e-4 * (sums[AA] + sums[BB]) + 1e-9, aa = sums[AA] + keep, bb = sums[BB] + keep;
    double determinant = aa * bb - sums[AB] * sums[AB];
    for (int k = 0; k < 3; k++) {
        double a = sums[RIGHT + k] + keep * ramp->a[k], b = sums[RIGHT + 3 + k] + keep * ramp->b[k];
        ramp->a[k] = (float)fmin(fmax((a * bb - b * sums[AB]) / determinant, 0.0), 1.0);
        ramp->b[k] = (float)fmin(fmax((b * aa - a * sums[AB]) / determinant, 0.0), 1.0);
    }
}

/* The squared error over all texels of what a shader will read, in units of 1/255 of a root, which are much
 * like codes of sRGB. */
WIDE static double leaf_error(const Part *part, const uint32_t leaf[LEAF_WORDS]) {
    Ramp ramp = leaf_read(leaf);
    Floats total = ALL(0.0f);
    for (int k = 0; k < 4; k++) ramp.level += ramp.slope[k] * part->middle[k];
    for (int i = 0; i < part->padded; i += LANES) {
        Floats share = ALL(ramp.level), x, weight;
        for (int k = 0; k < 4; k++) {
            LOAD(x, part->place[k] + i);
            share += ramp.slope[k] * x;
        }
        share = LEAST(GREATEST(share, ALL(0.0f)), ALL(1.0f));
        LOAD(weight, part->weight + i);
        for (int k = 0; k < 3; k++) {
            LOAD(x, part->colour[k] + i);
            x -= ramp.a[k] + (ramp.b[k] - ramp.a[k]) * share;
            total += weight * x * x;
        }
    }
    double sum = 0.0;
    for (int lane = 0; lane < LANES; lane++) sum += total[lane];
    return 255.0 * 255.0 * sum;
}

/* From the middle to the lowest texel. */
static void write_from_middle(const Part *part, const Ramp *ramp, uint32_t leaf[LEAF_WORDS]) {
    Ramp moved = *ramp;
    for (int k = 0; k < 4; k++) moved.level -= ramp->slope[k] * part->middle[k];
    leaf_write(&moved, leaf);
}

static double leaf_fit(Part *part, uint32_t leaf[LEAF_WORDS]) {
    Ramp ramp = {.level = 0.0f};
    if (!find_ends(part, &ramp)) {
        leaf_write(&ramp, leaf);
        return leaf_error(part, leaf);
    }
    double least = INFINITY;
    for (int turn = 0; turn < TURNS; turn++) {
        uint32_t tried[LEAF_WORDS];
        find_targets(part, &ramp);
        fit_plane(part, &ramp, turn == 0);
        fit_ends(part, &ramp);
        write_from_middle(part, &ramp, tried);
        double error = leaf_error(part, tried);
        if (error >= least) break;
        least = error;
        memcpy(leaf, tried, sizeof tried);
    }
    return least;
}

/* ---- How a block is split into leaves ---- */

/* u fastest, then v, s, t; weight 0: beyond the field. */
typedef struct {
    float roots[3][TEXELS], weight[TEXELS];
} BlockTexels;

typedef struct {
    int split[4], count; /* halvings along u, v, s, t; and leaves */
    uint32_t leaves[LEAVES_MOST][LEAF_WORDS];
    double error;
} Tiling;

/* The places of a leaf's texels for each number of halvings. */
static float places[4][4][2][2][4][TEXELS];
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void make_places(void) {
    for (int splits = 0; splits < 64; splits++) {
        const int split[4] = {splits & 3, splits >> 2 & 3, splits >> 4 & 1, splits >> 5};
        float(*to)[TEXELS] = places[split[0]][split[1]][split[2]][split[3]];
        for (int i = 0; i < TEXELS; i++)
            for (int k = 0, rest = i; k < 4; k++) {
                int size = 1 << (block_shift[k] - split[k]);
                to[k][i] = (float)(rest % size) - 0.5f * (float)(size - 1);
                rest /= size;
            }
    }
}

static void part_of(const BlockTexels *block, const int split[4], const int cell[4], Part *part) {
    int first[4], size[4];
    for (int k = 0; k < 4; k++) {
        size[k] = 1 << (block_shift[k] - split[k]);
        first[k] = cell[k] * size[k];
        part->middle[k] = 0.5f * (float)(size[k] - 1);
    }
    part->place = (const float(*)[TEXELS])places[split[0]][split[1]][split[2]][split[3]];
    int n = 0;
    for (int t = first[3]; t < first[3] + size[3]; t++)
        for (int s = first[2]; s < first[2] + size[2]; s++)
            for (int v = first[1]; v < first[1] + size[1]; v++, n += size[0]) {
                int from = ((t * BLOCK_S + s) * BLOCK_V + v) * BLOCK_U + first[0];
                for (int u = 0; u < size[0]; u++) {
                    for (int k = 0; k < 3; k++) part->colour[k][n + u] = block->roots[k][from + u];
                    part->weight[n + u] = block->weight[from + u];
                }
            }
    part->count = n;
    for (; n % LANES; n++) {
        part->weight[n] = 0.0f;
        for (int k = 0; k < 3; k++) part->colour[k][n] = 0.0f;
    }
    part->padded = n;
}

/* Texels beyond the field are black. */
WIDE static bool is_black(const Part *part) {
    for (int i = 0; i < part->padded; i += LANES)
        for (int k = 0; k < 3; k++) {
            Floats colour;
            LOAD(colour, part->colour[k] + i);
            if (ANY(colour > 0.0f)) return false;
        }
    return true;
}

/* Fits all leaves; false as soon as their error is beyond the limit. */
static bool tile(const BlockTexels *block, Tiling *tiling, double limit) {
    Part part;
    int cell[4], n = 0;
    tiling->error = 0.0;
    for (cell[3] = 0; cell[3] < 1 << tiling->split[3]; cell[3]++)
        for (cell[2] = 0; cell[2] < 1 << tiling->split[2]; cell[2]++)
            for (cell[1] = 0; cell[1] < 1 << tiling->split[1]; cell[1]++)
                for (cell[0] = 0; cell[0] < 1 << tiling->split[0]; cell[0]++, n++) {
                    part_of(block, tiling->split, cell, &part);
                    if (is_black(&part)) {
                        memset(tiling->leaves[n], 0, LEAF_BYTES);
                        continue;
                    }
                    tiling->error += leaf_fit(&part, tiling->leaves[n]);
                    if (tiling->error > limit) return false;
                }
    tiling->count = n;
    return true;
}

/* The tiling of least error + price * leaves, sought greedily: of all ways to halve the leaves along one axis
 * the best, again and again, one that gains nothing being forgiven if the next does. */
static void tile_best(const BlockTexels *block, double price, Tiling *best) {
    Tiling current, next, candidate;
    memset(best->split, 0, sizeof best->split);
    tile(block, best, INFINITY);
    current = *best;
    for (int forgiven = 0; forgiven < 2;) {
        double least = best->error + price * best->count, found = INFINITY;
        int count = 2 * current.count;
        if (count > LEAVES_MOST || price * count >= least) return;
        for (int axis = 0; axis < 4; axis++) {
            if (current.split[axis] == block_shift[axis]) continue;
            memcpy(candidate.split, current.split, sizeof candidate.split);
            candidate.split[axis]++;
            double limit = fmin(found, 1.2 * least) - price * count;
            if (!tile(block, &candidate, limit)) continue;
            found = candidate.error + price * count;
            next = candidate;
        }
        if (found == INFINITY) return;
        current = next;
        forgiven = found < least ? 0 : forgiven + 1;
        if (found < least) *best = next;
    }
}

/* ---- Bands ---- */

/* What one column of blocks, all of one u, comes to before it has its place among the leaves. */
typedef struct {
    uint32_t *leaves;
    size_t count, room;
    struct {
        uint32_t split, count;
        size_t first;
    } * blocks;
} Column;

typedef struct {
    const Encoded *encoded;
    const uint8_t *texels;
    int rows;
    double price;
    Blocks blocks;
    Column *columns;
} BandJob;

/* Copies a block's texels; false where all are black. */
static bool block_read(const BandJob *job, int u0, int s0, int t0, BlockTexels *block) {
    const Field *field = &job->encoded->field;
    int end[4] = {field->u - u0, job->rows, field->s - s0, field->t - t0};
    bool any = false;
    for (int k = 0; k < 4; k++)
        if (end[k] > 1 << block_shift[k]) end[k] = 1 << block_shift[k];
    memset(block, 0, sizeof *block);
    for (int v = 0; v < end[1]; v++)
        for (int u = 0; u < end[0]; u++)
            for (int t = 0; t < end[3]; t++)
                for (int s = 0; s < end[2]; s++) {
                    size_t from = (((size_t)v * (size_t)field->u + (size_t)(u0 + u)) * (size_t)field->t +
                                   (size_t)(t0 + t)) *
                                      (size_t)field->s +
                                  (size_t)(s0 + s);
                    const uint8_t *texel = job->texels + FIELD_TEXEL * from;
                    int at = ((t * BLOCK_S + s) * BLOCK_V + v) * BLOCK_U + u;
                    block->weight[at] = 1.0f;
                    for (int k = 0; k < 3; k++) block->roots[k][at] = root_of(texel[k]);
                    any = any || (texel[0] | texel[1] | texel[2]);
                }
    return any;
}

static void encode_column(void *context, int u) {
    BandJob *job = context;
    Column *column = &job->columns[u];
    BlockTexels block;
    Tiling tiling;
    for (int t = 0, n = 0; t < job->blocks.t; t++)
        for (int s = 0; s < job->blocks.s; s++, n++) {
            column->blocks[n].count = 0;
            if (!block_read(job, u * BLOCK_U, s * BLOCK_S, t * BLOCK_T, &block)) continue;
            tile_best(&block, job->price, &tiling);
            if (column->room - column->count < (size_t)tiling.count) {
                column->room = 2 * column->room + LEAVES_MOST;
                column->leaves = realloc(column->leaves, column->room * LEAF_BYTES);
                if (!column->leaves) fail("out of memory: %zu leaves", column->room);
            }
            column->blocks[n].split = (uint32_t)(tiling.split[0] | tiling.split[1] << 2 |
                                                 tiling.split[2] << 4 | tiling.split[3] << 5);
            column->blocks[n].count = (uint32_t)tiling.count;
            column->blocks[n].first = column->count;
            memcpy(column->leaves + LEAF_WORDS * column->count, tiling.leaves,
                   (size_t)tiling.count * LEAF_BYTES);
            column->count += (size_t)tiling.count;
        }
}

/* Blocks of a band with equal leaves share them: a table of where leaves are, by their checksum. */
typedef struct {
    size_t *first; /* + 1, of the plane's leaves; 0: free */
    uint32_t *count;
    size_t mask;
} Seen;

static size_t leaves_place(Plane *plane, Seen *seen, const uint32_t *leaves, uint32_t count) {
    size_t bytes = (size_t)count * LEAF_BYTES;
    size_t slot = (size_t)field_checksum(count, leaves, bytes) & seen->mask;
    for (; seen->first[slot]; slot = (slot + 1) & seen->mask) {
        size_t first = seen->first[slot] - 1;
        if (seen->count[slot] == count && memcmp(plane->data + first * LEAF_BYTES, leaves, bytes) == 0)
            return first;
    }
    size_t first = plane->bytes / LEAF_BYTES;
    memcpy(plane_extend(plane, bytes), leaves, bytes);
    seen->first[slot] = first + 1, seen->count[slot] = count;
    return first;
}

static void ramp_encode(Encoded *encoded, int band, int rows, const uint8_t *texels) {
    Blocks blocks = encoded->blocks;
    size_t count = (size_t)blocks.s * (size_t)blocks.t, all = count * (size_t)blocks.u, room = 1;
    double tolerance = encoded->knob / 4.0;
    BandJob job = {encoded, texels,
                   rows,    tolerance * tolerance * RAMP_PRICE,
                   blocks,  allocate((size_t)blocks.u, sizeof(Column))};
    for (int u = 0; u < blocks.u; u++) job.columns[u].blocks = allocate(count, sizeof *job.columns[u].blocks);
    pthread_once(&once, make_places);
    parallel_for(blocks.u, encode_column, &job);
    while (room < 2 * all) room *= 2;
    Seen seen = {allocate(room, sizeof(size_t)), allocate(room, sizeof(uint32_t)), room - 1};
    Plane *table = &encoded->planes[0], *leaves = &encoded->planes[1];
    if (band == 0) plane_extend(leaves, LEAF_BYTES); /* leaf 0, black */
    uint8_t *entries = plane_extend(table, all * sizeof(uint32_t));
    for (int u = 0; u < blocks.u; u++) {
        Column *column = &job.columns[u];
        for (size_t n = 0; n < count; n++) {
            if (!column->blocks[n].count) continue;
            size_t first = leaves->before / LEAF_BYTES +
                           leaves_place(leaves, &seen, column->leaves + LEAF_WORDS * column->blocks[n].first,
                                        column->blocks[n].count);
            if (first + LEAVES_MOST >= (size_t)1 << BASE_BITS)
                fail("more leaves than %d bits can tell apart", BASE_BITS);
            uint32_t entry = (uint32_t)first << SPLIT_BITS | column->blocks[n].split;
            int s = (int)(n % (size_t)blocks.s), t = (int)(n / (size_t)blocks.s);
            memcpy(entries + sizeof entry * block_number(&blocks, u, 0, s, t), &entry, sizeof entry);
        }
        free(column->blocks), free(column->leaves);
    }
    free(seen.first), free(seen.count), free(job.columns);
}

/* ---- Decoding ---- */

static void ramp_decode(const Encoded *encoded, const int at[4], float *light) {
    Blocks blocks = encoded->blocks;
    uint32_t entry, leaf[LEAF_WORDS], cell = 0;
    size_t number = block_number(&blocks, at[0] / BLOCK_U, at[1] / BLOCK_V, at[2] / BLOCK_S, at[3] / BLOCK_T);
    memcpy(&entry, plane_at(&encoded->planes[0], sizeof entry * number), sizeof entry);
    light[0] = light[1] = light[2] = 0.0f;
    if (!entry) return; /* black: the leaf for it is in the first band, which may not be here */
    const int split[4] = {(int)(entry & 3), (int)(entry >> 2 & 3), (int)(entry >> 4 & 1),
                          (int)(entry >> 5 & 1)};
    float place[4];
    for (int k = 3; k >= 0; k--) {
        int within = at[k] & ((1 << block_shift[k]) - 1), shift = block_shift[k] - split[k];
        cell = cell << split[k] | (uint32_t)(within >> shift);
        place[k] = (float)(within & ((1 << shift) - 1));
    }
    memcpy(leaf, plane_at(&encoded->planes[1], (size_t)LEAF_BYTES * ((entry >> SPLIT_BITS) + cell)),
           LEAF_BYTES);
    Ramp ramp = leaf_read(leaf);
    float share = share_at(&ramp, place);
    for (int k = 0; k < 3; k++) {
        float root = ramp.a[k] + (ramp.b[k] - ramp.a[k]) * share;
        light[k] = root * root;
    }
}

/* ---- What a file may hold ---- */

static int64_t ramp_size(const Encoded *encoded, int plane, int band) {
    (void)band;
    Blocks blocks = encoded->blocks;
    return plane ? -1 : (int64_t)sizeof(uint32_t) * blocks.u * blocks.s * blocks.t;
}

static bool ramp_refers(const Encoded *encoded) {
    const Plane *table = &encoded->planes[0];
    size_t begin = encoded->planes[1].before / LEAF_BYTES,
           end = begin + encoded->planes[1].bytes / LEAF_BYTES;
    if (encoded->planes[1].bytes % LEAF_BYTES || end < 1) return false;
    for (size_t i = 0; i < table->bytes; i += sizeof(uint32_t)) {
        uint32_t entry;
        memcpy(&entry, table->data + i, sizeof entry);
        int halvings = (int)((entry & 3) + (entry >> 2 & 3) + (entry >> 4 & 1) + (entry >> 5 & 1));
        size_t first = entry >> SPLIT_BITS;
        if (entry && (first < begin || first + ((size_t)1 << halvings) > end)) return false;
    }
    return true;
}

const Codec codec_ramp = {
    .name = "ramp",
    .number = 4,
    .block = {BLOCK_U, BLOCK_V, BLOCK_S, BLOCK_T},
    .knobs = {1, 256},
    .planes = {{.tag = FIELD_TAG('T', 'A', 'B', 'L')}, {.tag = FIELD_TAG('L', 'E', 'A', 'F')}},
    .encode = ramp_encode,
    .decode = ramp_decode,
    .size = ramp_size,
    .refers = ramp_refers};
