/* Cones for the search `cone`. */
#ifndef LESSON_CONE_H
#define LESSON_CONE_H

#include "image.h"

/* The cone map: one number for each cell (pyramid.h) of a height map of one channel, m >= 0. No point of the
 * repeated bilinear surface rises above a cone of slope m that stands on any point of that cell's patch: with
 * p in the cell, h(q) <= h(p) + m |q - p|   for all q, distances in texels, so m is height a texel. Cones as
 * first published (Dummer 2006) hold for the texels' centres alone, and a ray may pass through what lies
 * between them; that cones must hold for the interpolated surface is Bán, Valasek, Bálint and Vad's point
 * (EGSR 2024). m is an upper bound, not always the least: test_cone.c says how near it comes. All cores work
 * on it. */
Image cone_build(const Image *height);

#endif
