#include "grid.h"

static const float NOTHING = 2.0f; /* deeper than the box, which is 1 deep */

void grid_clear(const Grid *grid) {
    size_t from = (size_t)grid->first * grid->stride,
           count = (size_t)(grid->end - grid->first) * grid->stride;
    for (size_t i = 0; i < count; i++) grid->depths[from + i] = NOTHING;
    memset(grid->texels + from, 0, count * sizeof *grid->texels);
}

/* Four samples take a depth and a texel where they are inside and it is nearer than what they have. */
static inline void take(float *depths, uint32_t *texels, Ints inside, Floats depth, Ints texel) {
    Floats old_depth = floats_load(depths);
    Ints nearer = inside & (Ints)(depth < old_depth), old_texel = ints_load(texels);
    Floats new_depth = floats_choose(nearer, depth, old_depth);
    Ints new_texel = ints_choose(nearer, texel, old_texel);
    memcpy(depths, &new_depth, sizeof new_depth);
    memcpy(texels, &new_texel, sizeof new_texel);
}

/* Most triangles are a few samples large: four at a time cost less than a branch for each, and where they
 * reach beyond the extent they are outside of the triangle. A little more than the triangle is drawn, so that
 * rounding leaves no gaps between two. */
void grid_triangle(const Grid *grid, Extent extent, Landed a, Landed b, Landed c, const uint32_t texels[3]) {
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
            Ints b_or_c =
                ints_choose(b_weight > c_weight, ints((int32_t)texels[1]), ints((int32_t)texels[2]));
            Ints texel =
                ints_choose((a_weight > b_weight) & (a_weight > c_weight), ints((int32_t)texels[0]), b_or_c);
            take(grid->depths + sample, grid->texels + sample, inside, depth, texel);
            b_weight += LANES * b_step;
            c_weight += LANES * c_step;
        }
    }
}

typedef uint16_t Shorts __attribute__((vector_size(2 * LANES)));

static Ints shorts_load(const uint16_t *from) {
    Shorts lanes;
    memcpy(&lanes, from, sizeof lanes);
    return __builtin_convertvector(lanes, Ints);
}

static void shorts_store(uint16_t *to, Ints from) {
    Shorts lanes = __builtin_convertvector(from, Shorts);
    memcpy(to, &lanes, sizeof lanes);
}

void grid_resolve(const Grid *grid, int samples, int row, const Texel *texels, uint16_t *colour,
                  uint16_t *normal) {
    const uint32_t *from = grid->texels + (size_t)row * samples * grid->stride;
    int shift = samples == 4 ? 4 : samples == 2 ? 2 : 0; /* divides by the number of samples */
    for (int i = 0; i < grid->width / samples; i++, from += samples) {
        Ints colours = {0}, normals = {0};
        for (int y = 0; y < samples; y++) {
            for (int x = 0; x < samples; x++) {
                const Texel *texel = &texels[from[y * grid->stride + x]];
                colours += shorts_load(texel->values);
                normals += shorts_load(texel->values + 4);
            }
        }
        shorts_store(colour + 4 * i, colours >> shift);
        shorts_store(normal + 4 * i, normals >> shift);
    }
}
