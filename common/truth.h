/* The truth: exact pictures by rays in doubles, on all cores. Nothing here, nor what a scene's truth calls,
 * shares code with the techniques that it judges. */
#ifndef TEXEL_TRUTH_H
#define TEXEL_TRUTH_H

#include "camera.h"
#include "image.h"

#include <stdatomic.h>
#include <stdint.h>

/* What one ray meets. Colours are linear light; depth is the distance from the ray's origin. Where nothing is
 * hit, colour is not read: the background shows. unknown: the data say nothing here, so that no metric may.
 */
typedef struct {
    Vec3 colour;
    double u, v, depth;
    bool hit, unknown;
} Sample;

typedef struct {
    Sample (*sample)(const void *scene, Ray ray); /* called from many threads at once */
    const void *scene;
    Vec3 background;
    uint64_t key; /* names all that sample depends on: with it exact pictures are kept in cache; 0: never */
    const char *cache;       /* a folder */
    const atomic_bool *stop; /* or NULL: once true, what is being made ends soon and is good for nothing */
} Truth;

/* The filter of a pixel: the mean over its square, or exp(-2 r^2) out to a radius of one pixel. */
typedef enum { FILTER_BOX, FILTER_GAUSSIAN } PixelFilter;

typedef struct {
    Image image; /* three channels */
    double rmse; /* how much the image changed (rms) when its number of samples doubled last */
} Exact;

/* The exact picture: each pixel the weighted mean of `samples` rays (rounded to twice a square), stratified,
 * at places that depend on the pixel and nothing else. The caller destroys the image. */
Exact truth_render(const Truth *truth, const Camera *camera, int width, int height, int samples,
                   PixelFilter filter);

/* What the ray through each pixel's centre meets: width * height samples, row 0 first; the caller frees them.
 */
Sample *truth_centres(const Truth *truth, const Camera *camera, int width, int height);

/* The colour of an image at (u, v), as image_sample has it; one channel is grey. */
Vec3 truth_colour(const Image *image, double u, double v);

/* ---- Shapes that rays meet in closed form ---- */

/* The rectangle of mesh_plane: width x height around the origin, z = 0. A hit has u, v over 0..1 and depth.
 */
Sample truth_plane(Ray ray, double width, double height);

/* The side of the cylinder of that radius around the y axis, y in -height/2..height/2: the first crossing
 * from outside or inside. u = (theta + pi) / (2 pi) with theta from +z toward +x, as mesh_cylinder has it:
 * the arc length, exactly; v over 0..1. */
Sample truth_cylinder(Ray ray, double radius, double height);

/* ---- A relief: the height field of an image on a rectangle ---- */

/* Where a relief ends. REPEATED: the rectangle z = 0 is a window, through which rays must come, and the
 * relief goes on beyond its edges. CUT: rays must come through that window, but the surface ends where the
 * rectangle does. SLAB: there is no window; rays may come in through the sides of the layer of heights 0..1
 * too. */
typedef enum { RELIEF_REPEATED, RELIEF_CUT, RELIEF_SLAB } ReliefExtent;

typedef struct {
    const Image *height; /* one channel, h in 0..1, bilinear between texel centres, repeated */
    double width,
        aspect;         /* the rectangle of mesh_plane: its width in world units, its height over its width */
    double scale, base; /* the surface is at z = width scale (h - base) */
    ReliefExtent extent;
} Relief;

/* Where a ray that comes from above meets the surface: u and v of that point, within 0..1 but for
 * RELIEF_REPEATED. The field is walked cell by cell between texel centres; in each the bilinear patch's first
 * root is found. The surface has no sides: a ray that enters CUT or SLAB below it meets nothing. */
Sample truth_relief(const Relief *relief, Ray ray);

/* The unit normal of that surface at (u, v) of a hit: the bilinear patch's own, so it jumps where cells meet.
 */
Vec3 truth_relief_normal(const Relief *relief, double u, double v);

#endif
