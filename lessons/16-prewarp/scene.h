/* A wall whose relief is warped in C for each view, and then lies on polygons that OpenGL draws: what all
 * scenes of the lesson load, draw, and are held against. */
#ifndef LESSON_SCENE_H
#define LESSON_SCENE_H

#include "layer.h"
#include "wall.h"

/* The ways to warp: a technique's variant. */
typedef enum {
    PLAIN, /* not at all */
    DEPTH_NONE,
    DEPTH_LINEAR,
    DEPTH_SPLAT,
    ORDER_NONE,
    ORDER_LINEAR,
    ORDER_SPLAT,
    TWO_PASS,
    INVERSE,
    AUXILIARY, /* as ORDER_LINEAR, and polygons at the edges for what is seen beyond them */
    RESIZED,   /* as ORDER_LINEAR, on a polygon as large as what is seen */
} Way;

enum { LAYERS_MAX = 5 }; /* the polygon, and one at each of its edges */

/* Widths beyond each edge of the polygon that RESIZED goes: a relief that is seen along its plane has no end.
 */
#define RESIZED_LIMIT 2.0

typedef struct {
    Wall wall;
    Image normals; /* three channels, as floats: what the truth sees */
    Source source;
    double light_angle, ambient;
    Shape square;
    Destination destinations[2]; /* over the polygon, without and with a lookup; made when first used */
    Layer plain, layers[LAYERS_MAX];
    int layer_count;         /* of the view that was warped last; 0 where nothing is seen */
    struct Figures *figures; /* what has been measured of views, for all techniques */
} Prewarp;

/* Scene callbacks, see lesson.h. The polygon is at the relief's top (base 1, or what the file says), or with
 * scene_load_bottom at its bottom (base 0). The relief ends where the polygon does. For scene_load it is seen
 * through the polygon alone, for the others wherever it is. */
void *scene_load(const Options *options);
void *scene_load_overflow(const Options *options);
void *scene_load_bottom(const Options *options);
void scene_unload(void *data);
void scene_draw(const Frame *frame);
void scene_move(void *data, double seconds); /* the light goes around */
Sample scene_truth(const void *data, Ray ray);
Vec2 scene_texels(const void *data); /* the height map's size */
void scene_measure(const Shots *shots, Table *table);

/* Technique callback: warps the source for the frame's camera, and writes the layers. An eye in the polygon's
 * plane or behind it sees nothing: the relief has one side. */
void scene_prepare(const Frame *frame);

/* The eye of a camera. */
Eye scene_eye(const Camera *camera);

/* The unit vector toward the light. */
Vec3 scene_light(const Prewarp *prewarp);

/* An image at the centres of width x height texels, bilinear: itself where it has that size. The caller
 * destroys it. */
Image scene_resampled(const Image *image, int width, int height);

/* Warps the source onto the polygon, or for a destination that is larger onto its plane; it becomes empty
 * where nothing can be warped. Not for PLAIN. */
void scene_warp(const Prewarp *prewarp, Way way, Eye eye, Destination *destination);

#endif
