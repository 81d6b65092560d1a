/* The inverse warp (Parilov's alternative): for each texel of the destination, what of the source does the
 * eye see there? The equations turned around give, for a destination texel and each displacement d, u_s = u_i
 * + (k3 u_i - k1) d,   v_s = v_i + (k3 v_i - k2) d: a straight line through the source, on which the first
 * point is sought that the relief is as high as. It is walked cell by cell between texel centres, in each of
 * which the height above the bilinear relief is a quadratic, so nothing is missed: slow, and the best that a
 * warp can be. */
#ifndef LESSON_INVERSE_H
#define LESSON_INVERSE_H

#include "warp.h"

/* Warps the source into the destination, which is emptied first. It stays empty where the warp is not
 * possible, where the line leaves the source before it meets the relief, and where it enters the source's
 * side below the relief. Colours are interpolated in linear light. */
void warp_inverse(const Source *source, const PrewarpFactors *factors, Destination *destination);

#endif
