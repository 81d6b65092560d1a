/* Splats: a texel lands as a round spot, opaque in the middle and transparent outward, so that the spots of
 * neighbours overlap and nothing shows between them while they are less than two radii apart.
 *
 * Spots are composited with premultiplied alpha, in linear light. In occlusion-compatible order each is laid
 * over what is there. With the depth buffer it is laid over a farther spot and under a nearer one, the other
 * being the one of which most is seen there: that is exact for two layers, while of three that come as near,
 * far, middle the last two stay swapped. */
#ifndef LESSON_SPLAT_H
#define LESSON_SPLAT_H

#include "forward.h"

/* A spot's radii in units of the distance at which neighbours of a level relief land: opaque up to the one,
 * then less and less, and nothing beyond the other. */
#define SPLAT_OPAQUE 0.5f
#define SPLAT_RADIUS 1.0f

/* warp_forward with FILLING_SPLAT, into an empty destination, whose alpha is then how much was covered: what
 * is below one half is a hole. Colours are not premultiplied there. The lookup is that of the spot of which
 * most is seen. */
void splat_texels(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                  Destination *destination, WarpCounts *counts);

#endif
