/* What the lesson adds to the wall (common/wall.h): the paper's tangents, its distortion map, and what is
 * measured of a picture. */
#ifndef LESSON_PARALLAX_H
#define LESSON_PARALLAX_H

#include "wall.h"

typedef struct {
    Wall wall;
    Texture distortion;
} Parallax;

/* Scene callbacks, see lesson.h. The polygon is at the relief's top (base 1, or what the file says), or with
 * parallax_load_bottom at its bottom (base 0). */
void *parallax_load(const Options *options);
void *parallax_load_bottom(const Options *options);
void parallax_unload(void *data);
void parallax_draw(const Frame *frame);
void parallax_measure(const Shots *shots, Table *table); /* swimming, and where the iteration contracts */

/* The paper's tan theta_u and tan theta_v of a vector toward the eye in the polygon's frame, in doubles: what
 * view_tangents of parallax.glsl is in floats. */
Vec2 parallax_tangents(Vec3 view);

/* The largest |grad d| of the bilinear displacement, in texture widths per width. */
double parallax_steepness(const Relief *relief);

/* The distortion map of section 3.3 for a camera: at each texel of the height map the shift (u' - u, v' - v).
 * The caller destroys it. */
Image parallax_distortion(const Relief *relief, const Camera *camera);

/* Technique callback: builds the distortion map of section 3.3 for the frame's camera. */
void parallax_prepare_distortion(const Frame *frame);

#endif
