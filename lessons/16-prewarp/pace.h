/* How fast a way to warp is: everything counts that a new view asks for, and OpenGL for nothing. */
#ifndef LESSON_PACE_H
#define LESSON_PACE_H

#include "scene.h"

/* Nanoseconds of one warp for one eye: the fastest of at least three, or of one that is slow. */
double pace_warp(const Prewarp *prewarp, Way way, Eye eye);

/* Nanoseconds a warp and a scatter, means over views at random: eyes up to 75 degrees from the normal, one to
 * three widths from the polygon's middle. The scatter moves the same texels through a table of where they
 * land: the least that any forward warp has to do. Each view's is the fastest of at least three, or of one
 * that is slow; scatter and warp take turns, and the view is another each time. */
typedef struct {
    double warp_ns, scatter_ns;
} Pace;

Pace pace_random(const Prewarp *prewarp, Way way);

/* Eye number i of those. */
Eye pace_eye(int i);

/* For each of the source's texels the index of the destination's, of the source's size, that it lands in, or
 * one past the last. The caller frees it. */
uint32_t *pace_table(const Source *source, Eye eye);

#endif
