/* What the lesson adds to the wall (common/wall.h): the maps that fast searches stand on, a light, and what
 * is measured of a picture. */
#ifndef LESSON_RELIEF_H
#define LESSON_RELIEF_H

#include "wall.h"

/* The maps that searches stand on beside the heights: see pyramid.h and cone.h. */
typedef struct {
    Texture corners, pyramid, cones;
    double pyramid_ms, cones_ms; /* what they took to build; the corners count with the pyramid */
} Maps;

/* Builds corners and pyramid for a height map of one channel; maps_need_cones builds the cones, once, for
 * that takes longer. maps_bind gives the program in use corner_map, pyramid_map and cone_map. */
Maps maps_create(const Image *height);
void maps_need_cones(Maps *maps, const Image *height);
void maps_bind(const Maps *maps, Program *program);
void maps_destroy(Maps *maps);

typedef struct {
    Wall wall;
    Maps maps;
    bool lit;
    Vec3 light; /* unit, toward it, in the polygon's frame */
} Field;

/* A technique's variant. SHADOWED: the light's own ray is followed too. The others: which maps it reads. */
enum { HEIGHTS, SHADOWED, PYRAMID, CONES };

/* Scene callbacks, see lesson.h. The polygon is the relief's top (base 1, or what the file says). */
void *relief_load(const Options *options);
void *relief_load_lit(const Options *options);
void *relief_load_cut(const Options *options); /* it ends with the polygon; base 1 whatever the file says */
void relief_unload(void *data);
void relief_draw(const Frame *frame);
void relief_move(void *data, double seconds); /* the light, once around in 12 s */
Sample relief_truth(const void *data, Ray ray);
Vec2 relief_texels(const void *data); /* the height map's size */
void relief_measure(const Shots *shots, Table *table);

/* Whether no part of the relief stands between the point of its surface at (u, v) and the light. */
bool relief_is_lit(const Relief *relief, Vec3 light, double u, double v);

#endif
