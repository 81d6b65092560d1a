/* A scanline rasterizer: a polygon in clip space becomes edges, the edges become spans of pixels, and each
 * span is filled with a texture in one of several ways, most of them wrong in a way worth seeing.
 *
 * Which pixels are drawn is decided in integers, so that polygons that share an edge never miss a pixel and
 * never draw one twice. What a pixel shows is computed from the polygon as it was before it was snapped to
 * those integers. Row 0 is the bottom row, and pixel (x, y) has its centre at (x + 0.5, y + 0.5). */
#ifndef LESSON_RASTER_H
#define LESSON_RASTER_H

#include "camera.h"
#include "image.h"

#include <stdint.h>

/* A vertex in clip space, as GL's vertex shader leaves it: on the screen it is at x/w, y/w, both -1..1. The
 * texture coordinates s, t may be of any size (the texture repeats); r, g, b is for FILL_COLOUR. */
typedef struct {
    double x, y, z, w, s, t, r, g, b;
} ClipVertex;

/* The world's point p, which has the texture coordinates s, t, as the camera sees it. In doubles, for near
 * the horizon a rounding of x, y or w is multiplied by the distance. Its colour is black. */
ClipVertex clip_vertex(const Camera *camera, int width, int height, Vec3 p, double s, double t);

/* The point t of the way from a to b, all nine numbers linearly; exactly a for t = 0 and b for t = 1. */
ClipVertex clip_vertex_mix(const ClipVertex *a, const ClipVertex *b, double t);

enum { POLYGON_CORNERS_MAX = 8, CLIPPED_CORNERS_MAX = 14, SUBPIXEL_BITS = 8, SPLITS_MAX = 64 };

/* Cuts away what GL's near plane does (z < -w), what is at or behind the eye (w < 1e-6), and what lies more
 * than a million pixels off the picture. out has room for CLIPPED_CORNERS_MAX; returns how many corners are
 * left, or 0. A vertex that is not finite, or has a number beyond 1e8, makes that 0.
 *
 * An edge is always cut from its inner end to its outer one, so two polygons that share an edge get the same
 * new vertex, to the last bit, though they walk along it in opposite directions. */
int polygon_clip(const ClipVertex *polygon, int corners, int width, int height, ClipVertex *out);

typedef enum {
    FILL_COLOUR, /* the colours of the vertices, linear on the screen (Gouraud); the texture is not read */
    FILL_AFFINE, /* s and t linear on the screen, as if all vertices were at the same distance */
    FILL_SPANS,  /* s and t exact at every n-th pixel of a span, and at its last, linear between */
    FILL_PERSPECTIVE /* s/w, t/w and 1/w linear on the screen, and a division at each pixel */
} Filling;

/* What is drawn into, and how. NULL outputs are not written. There is no depth buffer: what is drawn later
 * covers what was drawn before. */
typedef struct {
    int width, height;    /* of all outputs, 1..IMAGE_SIDE_MAX */
    const Image *texture; /* three channels */
    Filling filling;
    int every;        /* FILL_SPANS: n, at least 1 */
    int dropped_bits; /* 0: vertices snap to 1/256 pixel; up to 8: to whole pixels, as early hardware did */
    Image *colour;    /* three channels */
    Image *lookup;    /* four channels: s, t, depth, hit (1) */
    double eye_x, eye_y; /* for depth: half the picture's width and height at distance 1 from the eye */
    uint16_t *drawn;     /* one more each time a pixel is drawn */
    float *bound; /* FILL_SPANS, FILL_PERSPECTIVE: how far s and t can be off inside the true shape, texels */
} Raster;

/* Draws a convex plane polygon of 3..POLYGON_CORNERS_MAX corners, in either direction. The top-left rule: a
 * pixel whose centre is on an edge belongs to the polygon if the edge is a left one, or a level one at the
 * top. FILL_COLOUR and FILL_AFFINE, which are not defined for more than three vertices, cut what has more
 * into a fan.
 *
 * A polygon's snapped shape can reach up to 1/512 pixel beyond its true one in x and in y. At a pixel centre
 * there its planes are extrapolated, but 1/w only down to half its least value on the polygon, and s and t
 * only as far beyond their ranges as these are wide. Where the true shape has no area, its mean is drawn. */
void raster_polygon(const Raster *raster, const ClipVertex *polygon, int corners);

/* Draws the parallelogram with corners (0,0), (1,0), (1,1), (0,1) of its own, split into splits x splits
 * equal ones in its plane (kept within 1..SPLITS_MAX), each of two triangles. FILL_COLOUR reads the texture
 * at the vertices. */
void raster_parallelogram(const Raster *raster, const ClipVertex corner[4], int splits);

/* Bilinear interpolation of three channels at (s, t), in floats; the texture repeats. */
void texture_read(const Image *texture, float s, float t, float colour[3]);

#endif
