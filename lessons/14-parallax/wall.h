/* The scene most of the lesson happens on: one polygon with a colour and a depth, seen from several angles.
 */
#ifndef LESSON_WALL_H
#define LESSON_WALL_H

#include "lesson.h"

typedef struct {
    Image colour_image, height_image;
    Image mask; /* 1 where a height is known, 0 where not; no pixels: known everywhere */
    Texture colour, height, distortion;
    Shape polygon;
    Relief relief; /* the same polygon, as the truth sees it */
} Wall;

/* Scene callbacks, see lesson.h. The polygon is at the relief's top (base 1, or what the file says), or with
 * wall_load_bottom at its bottom (base 0). The scene's first other image is the mask, which counts only for a
 * height map of its size. */
void *wall_load(const Options *options);
void *wall_load_bottom(const Options *options);
void wall_unload(void *data);
void wall_draw(const Frame *frame);
Sample wall_truth(const void *data, Ray ray);
Vec2 wall_texels(const void *data);
void wall_measure(const Shots *shots, Table *table); /* swimming, and where the iteration contracts */

/* The paper's tan theta_u and tan theta_v of a vector toward the eye in the polygon's frame, in doubles: what
 * view_tangents of parallax.glsl is in floats. */
Vec2 wall_tangents(Vec3 view);

/* The largest |grad d| of the bilinear displacement, in texture widths per width. */
double wall_steepness(const Relief *relief);

/* The distortion map of section 3.3 for a camera: at each texel of the height map the shift (u' - u, v' - v).
 * The caller destroys it. */
Image wall_distortion(const Relief *relief, const Camera *camera);

/* Technique callback: builds the distortion map of section 3.3 for the frame's camera. */
void wall_prepare_distortion(const Frame *frame);

#endif
