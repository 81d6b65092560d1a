/* One pass with a depth buffer (West): texels come in any order, and of those that land on one destination
 * texel the nearest stays.
 *
 * What tells the nearest? All of them lie on one ray, and along it the distance from the eye grows with 1 +
 * k3 d for any eye at a finite distance. At infinity k3 is 0 and 1 + k3 d tells nothing; but d does, on any
 * ray: it rises toward an eye that f points to, and falls toward an eye behind. (k3 is negative for the one
 * and positive for the other, so both say the same.) Whether the polygon is the relief's top or its bottom is
 * all one. So the buffer holds what the source is stored as, its levels in 16 bits, and nothing is computed.
 */
#ifndef LESSON_DEPTH_BUFFER_H
#define LESSON_DEPTH_BUFFER_H

#include "forward.h"

/* Whether a texel of that level is nearer to the eye than another on its ray. */
static inline bool is_nearer(const PrewarpFactors *factors, int level, int than) {
    return factors->behind ? level < than : level > than;
}

/* warp_forward with VISIBILITY_DEPTH_BUFFER and FILLING_NONE, into an empty destination. */
void depth_buffer_texels(const Source *source, const PrewarpFactors *factors, Destination *destination,
                         WarpCounts *counts);

#endif
