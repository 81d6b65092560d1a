/* Whole objects by pre-warp: the surfaces of all six reliefs, moved to where an eye sees them on the faces of
 * the box that it looks through. */
#ifndef LESSON_WARP_H
#define LESSON_WARP_H

#include "box.h"

/* What ends up on a face that the eye looks through: texels whose colour and normal OpenGL maps onto it, four
 * numbers of 16 bits each. Both are multiplied by alpha, the share of the texel that is covered, so that they
 * may be filtered: what a texture gives is to be divided by its alpha. Row 0 first, size x size. */
typedef struct {
    int face;
    uint16_t *colour; /* linear red, green and blue, and 1, times 65535 alpha */
    uint16_t *normal; /* (n + 1) / 2 and 1, times 65535 alpha */
} Destination;

typedef struct {
    Destination destinations[FACES];
    int size, samples; /* texels a side; samples a side of a texel: 1, 2 or 4 */
    int count;         /* destinations in use */
    float *depths;     /* of the samples: see grid.h */
    uint32_t *texels;  /* which of them they show */
} Warp;

/* Memory for destinations of size x size texels, samples x samples each; warp_destroy frees it. */
Warp warp_create(int size, int samples);
void warp_destroy(Warp *warp);

/* What of the box is warped. */
typedef struct {
    unsigned sources; /* bit i: face i */
    bool rims;        /* or cells alone */
} Parts;

/* Fills the destinations that an eye looks through, on all cores. */
void warp_box(Warp *warp, const Box *box, Eye eye, Parts parts);

#endif
