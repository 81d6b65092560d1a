/* Samples on a face of the box, and triangles drawn into them: each sample keeps the nearest surface that
 * landed on it. */
#ifndef LESSON_GRID_H
#define LESSON_GRID_H

#include "box.h"
#define LANES 4 /* a row of a tile is short */
#include "lanes.h"

/* A band of rows of a face's samples, whose places are 0.5, 1.5 and so on. Each is NOTHING deep and shows
 * texel 0 until something lands on it. */
typedef struct {
    int width, stride, first, end; /* samples in a row, and with those that only fill the last lanes; rows */
    float side;                    /* 1: what is counter-clockwise faces the eye; -1: what is clockwise */
    float *depths;                 /* of the whole face, row 0 first */
    uint32_t *texels;
} Grid;

/* A point where it lands: in samples from the face's lower left corner, and how deep. */
typedef struct {
    float x, y, depth;
} Landed;

/* Samples x0..x1 - 1 of rows y0..y1 - 1. */
typedef struct {
    int x0, x1, y0, y1;
} Extent;

void grid_clear(const Grid *grid);

/* The means of samples x samples (1, 2 or 4) for each texel of a row: the texels' values, where nothing,
 * which is texel 0, counts as 0. colour and normal get four numbers each. */
void grid_resolve(const Grid *grid, int samples, int row, const Texel *texels, uint16_t *colour,
                  uint16_t *normal);

/* The first of the samples low..high - 1 that is not below a place; high where there is none, low where the
 * place is no number. */
static inline Ints sample_from(Floats place, int low, int high) {
    Floats from = LEAST(GREATEST(place - 0.5f, ALL((float)low)), ALL((float)high));
    Ints below = __builtin_convertvector(from, Ints);
    return below - (Ints)(__builtin_convertvector(below, Floats) < from); /* what holds is -1 */
}

/* ---- Triangles: here, for with every call inlined the warp takes a tenth less ---- */

/* Four samples take a depth and a texel where they are inside and it is nearer than what they have. */
static inline void take(float *depths, uint32_t *texels, Ints inside, Floats depth, Ints texel) {
    Floats old_depth = FLOATS_AT(depths);
    Ints nearer = inside & (Ints)(depth < old_depth), old_texel = (Ints)FLOATS_AT(texels);
    Floats new_depth = PICK(nearer, depth, old_depth);
    Ints new_texel = PICK_INTS(nearer, texel, old_texel);
    memcpy(depths, &new_depth, sizeof new_depth);
    memcpy(texels, &new_texel, sizeof new_texel);
}

/* Draws a triangle, whose samples all lie in an extent within the grid, unless it faces away or one of its
 * corners is no number. A sample shows the texel of the corner that it is nearest to by its weights.
 *
 * Most triangles are a few samples large: four at a time cost less than a branch for each, and where they
 * reach beyond the extent they are outside of the triangle. A little more than the triangle is drawn, so that
 * rounding leaves no gaps between two. */
__attribute__((always_inline)) static inline void
grid_triangle(const Grid *grid, Extent extent, Landed a, Landed b, Landed c, const uint32_t texels[3]) {
    static const float little = -1e-4f;
    float bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    float area = bx * cy - by * cx;
    if (!(area * grid->side > 0.0f)) return;
    float scale = 1.0f / area, b_step = cy * scale, c_step = -by * scale;
    const Floats lanes = {0, 1, 2, 3};
    for (int y = extent.y0; y < extent.y1; y++) {
        float dx = (float)extent.x0 + 0.5f - a.x, dy = (float)y + 0.5f - a.y;
        Floats b_weight = (dx * cy - dy * cx) * scale + b_step * lanes;
        Floats c_weight = (bx * dy - by * dx) * scale + c_step * lanes;
        size_t sample = (size_t)y * grid->stride + extent.x0;
        for (int x = extent.x0; x < extent.x1; x += LANES, sample += LANES) {
            Floats a_weight = 1.0f - b_weight - c_weight;
            Floats depth = a.depth + b_weight * (b.depth - a.depth) + c_weight * (c.depth - a.depth);
            Ints inside = (a_weight > little) & (b_weight > little) & (c_weight > little);
            Ints b_or_c = PICK_INTS(b_weight > c_weight, ((int32_t)texels[1] + (Ints){0}),
                                    ((int32_t)texels[2] + (Ints){0}));
            Ints texel = PICK_INTS((a_weight > b_weight) & (a_weight > c_weight),
                                   ((int32_t)texels[0] + (Ints){0}), b_or_c);
            take(grid->depths + sample, grid->texels + sample, inside, depth, texel);
            b_weight += LANES * b_step;
            c_weight += LANES * c_step;
        }
    }
}

#endif
