/* The forward pre-warp in one pass: each texel of the source is moved to where the eye sees it. Two choices
 * make a way to warp: what becomes of texels that land on one another, and of the holes that stay between
 * them. The order of the work is in sheets.h, where texels land is in landing.h, what is done with them there
 * is a painter's business. */
#ifndef LESSON_FORWARD_H
#define LESSON_FORWARD_H

#include "landing.h"
#include "sheets.h"
#include "warp.h"

typedef enum {
    VISIBILITY_DEPTH_BUFFER,   /* the nearest stays; any order will do (West) */
    VISIBILITY_OCCLUSION_ORDER /* the last stays, and the order makes it the nearest (McMillan) */
} Visibility;

typedef enum {
    FILLING_NONE,   /* a texel goes to the one destination texel whose centre is nearest */
    FILLING_LINEAR, /* between a texel, the one before it and the one above it, values are interpolated (West)
                     */
    FILLING_SPLAT   /* a texel is a spot, opaque in the middle and transparent outward */
} Filling;

typedef struct {
    int behind;  /* texels that were not moved: 1 + k3 d is not above LANDING_W_MIN */
    int outside; /* texels that were moved beyond the edges of the destination */
} WarpCounts;

/* Warps the source into the destination, which is emptied first: where nothing lands, all eight bytes are 0
 * (and the lookup is 0, 0, 0). Where the warp is not possible (the eye lies in the plane) the destination
 * stays empty and every texel counts as behind. counts may be NULL. Ends the program if memory runs out. */
void warp_forward(const Source *source, const PrewarpFactors *factors, Visibility visibility, Filling filling,
                  Destination *destination, WarpCounts *counts);

/* A painter of texels one by one: called with a row and a run of its columns, whose order it keeps. */
typedef void PaintTexels(void *painter, const LandedRow *row, Run columns);

/* Calls paint for all texels of the source, in the order that the visibility asks for (by rows from the
 * bottom for the depth buffer), and counts those that are lost. */
void forward_texels(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                    const Destination *destination, PaintTexels *paint, void *painter, WarpCounts *counts);

/* Adds those of a row's texels that are lost to counts, if that is not NULL. */
void forward_count(const LandedRow *row, const Destination *destination, WarpCounts *counts);

#endif
