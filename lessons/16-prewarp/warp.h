/* The pre-warp: a relief texture moved, texel by texel, into a flat image that then is mapped onto the
 * polygon as any texture is. See common/prewarp.h for the equations; the ways to warp differ in how texels
 * that land on one another are told apart, in how the holes between them are filled, and in the order of the
 * work. */
#ifndef LESSON_WARP_H
#define LESSON_WARP_H

#include "image.h"
#include "prewarp.h"

#include <stdint.h>

/* What a texel carries along: eight bytes, so that one store moves it. */
typedef struct {
    uint8_t colour[4]; /* red, green, blue in sRGB; alpha: 255 where something landed, 0 in a hole */
    uint8_t normal[4]; /* x, y, z of the unit normal as 127.5 + 127.5 n, rounded; and one to spare */
} Texel;

/* A relief texture ready to be warped, row 0 at the bottom. */
typedef struct {
    int width, height;
    double scale, base, aspect; /* as in Relief of truth.h, whose width is 1 here */
    Plane plane;                /* of the polygon: mesh_plane(1, aspect) */
    uint16_t *levels;           /* heights in 16 bits, 65535 for h = 1: an index for tables over the levels */
    Texel *texels;
} Source;

/* Where texels land. (u, v) of its lower left corner and of its upper right one, in the polygon's texture
 * coordinates: 0, 0 and 1, 1 but for a destination that was enlarged to hold what overflows. */
typedef struct {
    int width, height;
    Vec2 low, high;
    Texel *texels;
    float *lookup; /* NULL, or three floats a texel: the source's u and v, and its height h there */
} Destination;

/* The source from linear colour (three channels), heights (one channel; of the same size) and normals (three
 * channels, n_x n_y n_z). source_destroy frees it. */
Source source_create(const Image *colour, const Image *heights, const Image *normals, double scale,
                     double base);
void source_destroy(Source *source);

/* A destination of width x height texels over low..high; destination_destroy frees it. With lookup, where
 * each texel came from is kept too, which costs time. */
Destination destination_create(int width, int height, Vec2 low, Vec2 high, bool lookup);
void destination_destroy(Destination *destination);

#endif
