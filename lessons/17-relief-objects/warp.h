/* Whole objects by pre-warp: the surfaces of all six reliefs, moved to where an eye outside of the box sees
 * them on the one to three faces that face it. */
#ifndef LESSON_WARP_H
#define LESSON_WARP_H

#include "box.h"

enum { DESTINATIONS = 3 };

/* What ends up on a face that faces the eye: texels whose colour and normal OpenGL maps onto it, four numbers
 * of 16 bits each. Both are multiplied by alpha, the share of the texel that is covered, so that they may be
 * filtered: what a texture gives is to be divided by its alpha. Row 0 first, size x size. */
typedef struct {
    int face;
    uint16_t *colour; /* linear red, green and blue, and 1, times 65535 alpha */
    uint16_t *normal; /* (n + 1) / 2 and 1, times 65535 alpha */
} Destination;

typedef struct {
    Destination destinations[DESTINATIONS];
    int size, samples; /* texels a side; samples a side of a texel: 1, 2 or 4 */
    int count;         /* destinations in use */
    float *depths;     /* of each sample: see warp.c */
    uint32_t *winners; /* whose texel it shows */
} Warp;

/* Memory for destinations of size x size texels, samples x samples each; warp_destroy frees it. */
Warp warp_create(int size, int samples);
void warp_destroy(Warp *warp);

/* Fills the destinations that an eye sees, from those source faces whose bit is set, on all cores. Returns
 * false, with none in use, for an eye in the box. */
bool warp_box(Warp *warp, const Box *box, Eye eye, unsigned sources);

#endif
