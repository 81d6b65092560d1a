/* Relief textures by pre-warp: the equations (Oliveira, Bishop, McAllister 2000; McMillan 1997).
 *
 * A relief texture is an image by parallel projection: its texel (u, v) with displacement d is the point
 *     x = C_s + u a + v b + d f.
 * The eye C_t sees that point where another texel (u_i, v_i), of displacement 0, lies. Moving each texel
 * there first leaves a flat image, which ordinary texture mapping then shows as if it had depth. */
#ifndef TEXEL_PREWARP_H
#define TEXEL_PREWARP_H

#include "vec.h"

#include <stdbool.h>

/* The basis of a source image: a and b over the whole image (u and v over 0..1), f a unit vector on either
 * side of their plane, not in it. a and b need be neither orthogonal nor of one length. */
typedef struct {
    Vec3 origin, a, b, f; /* origin is C_s */
} Plane;

/* An eye: a point, or for w = 0 the direction toward it, infinitely far. */
typedef struct {
    Vec3 at;
    double w;
} Eye;

/* u_i = (u_s + k1 d) / (1 + k3 d), v_i = (v_s + k2 d) / (1 + k3 d), where
 *     k1 = f.(b x c) / a.(b x c),  k2 = f.(c x a) / a.(b x c),  k3 = 1 / (c.f) for orthogonal f
 * with c = C_s - C_t, or the direction from the eye for one infinitely far, where k3 is 0.
 *
 * What has 1 + k3 d of zero or less is beside or behind the eye: it is not seen. Of points that land on one
 * another, all on one ray, the one with the greatest d is nearest to an eye on the side that f points to, and
 * the one with the least d to an eye behind: 1 + k3 d is their distance, up to a factor. */
typedef struct {
    double k1, k2, k3;
    bool possible; /* false where the eye lies in the source plane: a.(b x c) is 0, nothing can be warped */
    bool behind;   /* the eye is on the side that f points away from; k3 is positive, or 0 at infinity */
} PrewarpFactors;

PrewarpFactors prewarp_factors(const Plane *source, Eye eye);

/* The same between two planes: U, V and W are linear in (u_s, v_s, d, 1), and u_i = U / W, v_i = V / W are
 * texel coordinates of the target. W is positive in front of the eye, on the side where the target lies. For
 * target = source they are u_s + k1 d, v_s + k2 d, 1 + k3 d. */
typedef struct {
    double u[4], v[4], w[4];
    bool possible;
} PrewarpMap;

PrewarpMap prewarp_map(const Plane *source, const Plane *target, Eye eye);

#endif
