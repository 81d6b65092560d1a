/* The scenes `cylinder` and `sides`: prisms that should look like the cylinder around them. Each face lies
 * inside it, and its depth map (base 0) is the arc's height above the chord. The cylinder has radius 1 around
 * the y axis; u and v are arc length and height in circumferences, so texels are square on it. */
#ifndef LESSON_PRISM_H
#define LESSON_PRISM_H

#include "lesson.h"

#define CYLINDER_HEIGHT PI /* half a circumference: v over 0..0.5 */

enum { SIDES_MIN = 3, SIDES_MAX = 64, CYLINDER_SIDES = 8, SMOOTH_SIDES = 32, DEPTH_TEXELS = 4096 };

/* Scene callbacks, see lesson.h. `cylinder`: below the joint at y = 0 eight sides with the technique, above
 * it 32 without, both with a corner toward +z. `sides`: one prism, with as many sides as the knob says and a
 * face toward +z. */
void *prism_load_cylinder(const Options *options);
void *prism_load_sides(const Options *options);
void prism_unload(void *data);
void prism_draw(const Frame *frame);
Sample prism_truth(const void *data, Ray ray);
Vec2 prism_texels(const void *data);
void prism_measure_joint(const Shots *shots,
                         Table *table); /* joint_mismatch_texels_*, chord_error_texels_rms */
void prism_measure_sides(const Shots *shots, Table *table); /* distortion_texels_rms and _max of the face */

/* The arc's height above the chord, all around the prism: DEPTH_TEXELS x 1 heights 0..1, 1 at the middle of
 * each face, a corner at u = corner. The caller destroys it. And what 1 stands for, in widths of the texture
 * as it lies on the faces: the arc's rise, 1 - cos(pi / sides), over the prism's girth, 2 sides sin(pi /
 * sides). */
Image prism_depth_map(int sides, double corner);
double prism_scale(int sides);

#endif
