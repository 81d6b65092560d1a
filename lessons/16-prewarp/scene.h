/* A wall whose relief is warped in C for each view, and then lies on polygons that OpenGL draws: what all
 * scenes of the lesson load, draw, and are held against. */
#ifndef LESSON_SCENE_H
#define LESSON_SCENE_H

#include "wall.h"
#include "warp.h"

/* What one polygon of the picture shows: texels that landed on it, as textures. */
typedef struct {
    Texture colour, normal, lookup; /* lookup's id is 0 where nobody looks */
    float model[16];                /* from a square of width 1 around the origin, z = 0, to the polygon */
} Layer;

enum { LAYERS_MAX = 5 }; /* the polygon, and one at each of its edges */

typedef struct {
    Wall wall;
    Image normals; /* three channels, as floats: what the truth sees */
    double light_angle, ambient;
    Shape square;
    Layer plain, layers[LAYERS_MAX];
    int layer_count; /* of the view that was warped last */
} Prewarp;

/* Scene callbacks, see lesson.h. The polygon is at the relief's top (base 1, or what the file says), or with
 * scene_load_bottom at its bottom. The relief ends where the polygon does; it is seen through the polygon
 * alone. */
void *scene_load(const Options *options);
void *scene_load_bottom(const Options *options);
void scene_unload(void *data);
void scene_draw(const Frame *frame);
void scene_move(void *data, double seconds); /* the light goes around */
Sample scene_truth(const void *data, Ray ray);

/* The unit vector toward the light. */
Vec3 scene_light(const Prewarp *prewarp);

#endif
