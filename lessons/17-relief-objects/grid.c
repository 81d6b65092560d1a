#include "grid.h"

static const float NOTHING = 2.0f; /* deeper than the box, which is 1 deep */

void grid_clear(const Grid *grid) {
    size_t from = (size_t)grid->first * grid->stride,
           count = (size_t)(grid->end - grid->first) * grid->stride;
    for (size_t i = 0; i < count; i++) grid->depths[from + i] = NOTHING;
    memset(grid->texels + from, 0, count * sizeof *grid->texels);
}

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
