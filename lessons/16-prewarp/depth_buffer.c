#include "depth_buffer.h"

#include "fail.h"

#include <stdlib.h>

typedef struct {
    const PrewarpFactors *factors;
    Destination *destination;
    uint16_t *nearest; /* the level that each destination texel holds, if it holds one */
} Painter;

/* The destination texel whose centre is nearest takes the texel, unless it holds a nearer one. */
static void put_nearest(void *context, const LandedRow *row, Run columns) {
    const Painter *painter = context;
    const Destination *destination = painter->destination;
    float right = (float)destination->width - 0.5f, top = (float)destination->height - 0.5f;
    for (int i = columns.first; i != columns.end; i += columns.step) {
        float x = row->x[i], y = row->y[i];
        if (!(x >= -0.5f && x < right && y >= -0.5f && y < top)) continue;
        size_t at = (size_t)(int)(y + 0.5f) * destination->width + (size_t)(int)(x + 0.5f);
        bool empty = destination->texels[at].colour[3] == 0;
        if (!empty && !is_nearer(painter->factors, row->levels[i], painter->nearest[at])) continue;
        painter->nearest[at] = row->levels[i];
        destination->texels[at] = row->texels[i];
        if (!destination->lookup) continue;
        float *lookup = destination->lookup + 3 * at;
        lookup[0] = row->u[i], lookup[1] = row->v, lookup[2] = (float)row->levels[i] / 65535;
    }
}

void depth_buffer_texels(const Source *source, const PrewarpFactors *factors, Destination *destination,
                         WarpCounts *counts) {
    size_t count = (size_t)destination->width * destination->height;
    Painter painter = {factors, destination, allocate(count, sizeof *painter.nearest)};
    forward_texels(source, factors, VISIBILITY_DEPTH_BUFFER, destination, put_nearest, &painter, counts);
    free(painter.nearest);
}
