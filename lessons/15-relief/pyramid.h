/* What the searches `maximum` and `cone` read. Between texel centres the surface is made of cells,
 * bilinear patches: cell (x, y) lies between the centres of texels (x, y), (x + 1, y), (x, y + 1) and (x + 1,
 * y + 1) of the repeated map, and nowhere rises above the highest of the four. height has one channel. */
#ifndef LESSON_PYRAMID_H
#define LESSON_PYRAMID_H

#include "image.h"

/* The four heights of each cell, in the order above: one texel with four channels a cell. */
Image corners_build(const Image *height);

/* The maximum mip pyramid (Tevs, Ihrke, Seidel 2008). Texel (x, y) of level k is the largest height in the
 * block of 2^k x 2^k cells from (2^k x, 2^k y) on; blocks do not go on beyond the map, so the last ones may
 * be smaller. Level 0 has its sides rounded up to powers of two, so that the levels are a mip chain of
 * OpenGL; what lies beyond the map there is 0 and is not meant to be read. */
enum { PYRAMID_LEVELS_MAX = 15 };

typedef struct {
    Image levels[PYRAMID_LEVELS_MAX];
    int count;
} Pyramid;

Pyramid pyramid_build(const Image *height);
void pyramid_destroy(Pyramid *pyramid);

#endif
