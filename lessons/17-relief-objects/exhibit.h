/* What the lesson shows: an object as six reliefs in a box, as a mesh, and as rays have it. */
#ifndef LESSON_EXHIBIT_H
#define LESSON_EXHIBIT_H

#include "lesson.h"
#include "warp.h"

/* A technique's variant: what it makes of the six reliefs. */
typedef enum {
    EXHIBIT_MESH,
    EXHIBIT_FLAT,
    EXHIBIT_ALL,
    EXHIBIT_FRONTS,
    EXHIBIT_CELLS,
    EXHIBIT_BRIDGED
} Variant;

/* Scene callbacks, see lesson.h. The colour file is the front's relief; the other five lie beside it. */
void *exhibit_load_solids(const Options *options);
void *exhibit_load_bunny(const Options *options); /* the other file is its mesh */
void exhibit_unload(void *data);
void exhibit_prepare(const Frame *frame);
void exhibit_draw(const Frame *frame);
void exhibit_move(void *data, double seconds);
Sample exhibit_truth(const void *data, Ray ray);
void exhibit_measure(const Shots *shots, Table *table);

/* The unit vector toward the light: once around the vertical axis in eight seconds, from +z over +x. */
Vec3 exhibit_light(double seconds);

/* The eye of a camera. */
Eye exhibit_eye(const Camera *camera);

#endif
