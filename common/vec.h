/* Vectors of doubles: what cameras, meshes and the truth compute with.
 * Everything is by value and none of it can fail. GL's own matrices come from cglm instead, whose types
 * vec2 and vec3 are why the constructors here are called v2 and v3. */
#ifndef TEXEL_VEC_H
#define TEXEL_VEC_H

#include <math.h>

#define PI 3.14159265358979323846

typedef struct {
    double x, y;
} Vec2;

typedef struct {
    double x, y, z;
} Vec3;

/* A half line: the points origin + t direction, t >= 0. The direction has length one. */
typedef struct {
    Vec3 origin, direction;
} Ray;

/* (Declared, then returned: C++ reads this too, and has no compound literals.) */
static inline Vec2 v2(double x, double y) {
    Vec2 v = {x, y};
    return v;
}
static inline Vec3 v3(double x, double y, double z) {
    Vec3 v = {x, y, z};
    return v;
}
static inline Vec3 vec3_add(Vec3 a, Vec3 b) { return v3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline Vec3 vec3_sub(Vec3 a, Vec3 b) { return v3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline Vec3 vec3_scale(Vec3 a, double s) { return v3(a.x * s, a.y * s, a.z * s); }
static inline Vec3 vec3_multiply(Vec3 a, Vec3 b) { return v3(a.x * b.x, a.y * b.y, a.z * b.z); }
static inline Vec3 vec3_mix(Vec3 a, Vec3 b, double t) { return vec3_add(a, vec3_scale(vec3_sub(b, a), t)); }
static inline double vec3_dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Vec3 vec3_cross(Vec3 a, Vec3 b) {
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double vec3_length(Vec3 a) { return sqrt(vec3_dot(a, a)); }
static inline Vec3 vec3_normalize(Vec3 a) { return vec3_scale(a, 1.0 / vec3_length(a)); }
static inline Vec3 ray_at(Ray ray, double t) { return vec3_add(ray.origin, vec3_scale(ray.direction, t)); }
static inline double radians(double degrees) { return degrees * (PI / 180.0); }
static inline double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

#endif
