#include "prewarp.h"

/* The vector from the eye to the plane's origin, or for an eye infinitely far any vector away from it: the
 * paper's c = C_s - C_t, whose length k1 and k2 do not depend on. */
static Vec3 away(Vec3 origin, Eye eye) {
    return eye.w > 0.0 ? vec3_sub(origin, vec3_scale(eye.at, 1.0 / eye.w)) : vec3_scale(eye.at, -1.0);
}

/* The vector q in the basis of a plane's a, b and c: Cramer's rule. */
static Vec3 in_basis(const Plane *plane, Vec3 c, Vec3 q) {
    Vec3 bc = vec3_cross(plane->b, c), ca = vec3_cross(c, plane->a), ab = vec3_cross(plane->a, plane->b);
    double volume = vec3_dot(plane->a, bc); /* of the parallelepiped; c.(a x b) is the same number */
    return v3(vec3_dot(q, bc) / volume, vec3_dot(q, ca) / volume, vec3_dot(q, ab) / volume);
}

/* Nothing is left of a volume but its rounding where c lies within 1e-9 radians of the plane. */
static bool is_possible(const Plane *plane, Vec3 c) {
    Vec3 ab = vec3_cross(plane->a, plane->b);
    return fabs(vec3_dot(ab, c)) > 1e-9 * vec3_length(ab) * vec3_length(c);
}

/* With f = k1 a + k2 b + k3 c, the point c + u_s a + v_s b + d f as the eye has it is
 *     (u_s + k1 d) a + (v_s + k2 d) b + (1 + k3 d) c,
 * and to lie in the image plane the factor of c must be 1: everything is divided by 1 + k3 d. */
PrewarpFactors prewarp_factors(const Plane *source, Eye eye) {
    Vec3 c = away(source->origin, eye);
    if (!is_possible(source, c)) return (PrewarpFactors){0};
    Vec3 k = in_basis(source, c, source->f);
    return (PrewarpFactors){k.x, k.y, eye.w > 0.0 ? k.z : 0.0, true, k.z > 0.0};
}

PrewarpMap prewarp_map(const Plane *source, const Plane *target, Eye eye) {
    Vec3 c = away(target->origin, eye);
    if (!is_possible(target, c)) return (PrewarpMap){.possible = false};
    const Vec3 parts[] = {source->a, source->b, source->f, vec3_sub(source->origin, target->origin)};
    PrewarpMap map = {.w = {0, 0, 0, 1}, .possible = true};
    for (int i = 0; i < 4; i++) {
        Vec3 k = in_basis(target, c, parts[i]);
        map.u[i] = k.x;
        map.v[i] = k.y;
        if (eye.w > 0.0) map.w[i] += k.z;
    }
    return map;
}
