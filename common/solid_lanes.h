/* Solids that eight rays at a time meet, all from one origin: what light fields are synthesised by, and what
 * Embree's boxes around solids hold when it is raced against that. In floats; the exact light along a ray is
 * light_scene.h's, which shares no code with this. */
#ifndef TEXEL_SOLID_LANES_H
#define TEXEL_SOLID_LANES_H

#include "lanes.h"
#include "light_field.h"
#include "light_scene.h"

typedef struct {
    float x, y, z;
} Point;

INLINE float dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE Point cross(Point a, Point b) {
    return (Point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
INLINE Point scaled(Point a, float s) { return (Point){a.x * s, a.y * s, a.z * s}; }
INLINE Point sum(Point a, Point b) { return (Point){a.x + b.x, a.y + b.y, a.z + b.z}; }
INLINE Point point_of(Vec3 v) { return (Point){(float)v.x, (float)v.y, (float)v.z}; }

/* ---- A solid in the frame of an origin, from which all rays start ---- */

typedef struct {
    SolidKind kind;
    Point centre, axis[3], half, colour; /* axis: the solid's own, as they lie in the frame */
    Point around[3];                     /* centre x axis */
    float along[3];                      /* centre . axis */
} NearSolid;

/* The solid's own axes in the world: turned about x, about y, about z, in that order. */
INLINE void solid_axes_of(const Solid *solid, Vec3 axes[3]) {
    Vec3 a =
        v3(radians(solid->turn_degrees.x), radians(solid->turn_degrees.y), radians(solid->turn_degrees.z));
    for (int i = 0; i < 3; i++) {
        Vec3 p = v3(i == 0, i == 1, i == 2);
        p = v3(p.x, cos(a.x) * p.y - sin(a.x) * p.z, sin(a.x) * p.y + cos(a.x) * p.z);
        p = v3(cos(a.y) * p.x + sin(a.y) * p.z, p.y, cos(a.y) * p.z - sin(a.y) * p.x);
        axes[i] = v3(cos(a.z) * p.x - sin(a.z) * p.y, sin(a.z) * p.x + cos(a.z) * p.y, p.z);
    }
}

INLINE Point point_in(const FieldFrame *frame, Vec3 v) {
    return (Point){(float)vec3_dot(v, frame->e_x), (float)vec3_dot(v, frame->e_y),
                   (float)vec3_dot(v, frame->e_z)};
}

/* axes: the solid's, in the world. */
INLINE NearSolid near_solid(const Solid *solid, const Vec3 axes[3], const FieldFrame *frame) {
    NearSolid near = {.kind = solid->kind,
                      .centre = point_in(frame, vec3_sub(solid->centre, frame->at)),
                      .half = scaled(point_of(solid->size), 0.5f),
                      .colour = point_of(solid->colour)};
    for (int k = 0; solid->kind != SOLID_SPHERE && k < 3; k++) {
        near.axis[k] = point_in(frame, axes[k]);
        near.around[k] = cross(near.centre, near.axis[k]);
        near.along[k] = dot(near.centre, near.axis[k]);
    }
    return near;
}

/* ---- Eight rays at once: t w, where w = -d ---- */

typedef struct {
    Floats x, y, z;
} Points;

typedef struct {
    Floats t;
    Points normal;
    Ints met;
} Meeting;

#define DOT(a, b) ((a).x * (b).x + (a).y * (b).y + (a).z * (b).z)
#define ROOT(a)                                                                                              \
    __extension__({                                                                                          \
        Floats a_ = (a), b_;                                                                                 \
        for (int k_ = 0; k_ < LANES; k_++) b_[k_] = __builtin_sqrtf(a_[k_]);                                 \
        b_;                                                                                                  \
    })
/* `of` with the sign of `by`. */
#define SIGNED(of, by) ((Floats)((Ints)ALL(of) | ((Ints)(by)&INT32_MIN)))

INLINE void meet_sphere(const NearSolid *solid, const Points *way, float start, Meeting *meeting) {
    const Points w = *way;
    Floats passing = DOT(w, solid->centre); /* where the ray passes the centre, and by how much */
    Points off = {passing * w.x - solid->centre.x, passing * w.y - solid->centre.y,
                  passing * w.z - solid->centre.z};
    float radius = solid->half.x;
    Floats inside = radius * radius - DOT(off, off), deep = ROOT(GREATEST(inside, ALL(0.0f)));
    meeting->t = passing - deep;
    meeting->met = (inside >= 0.0f) & (meeting->t >= start);
    float scale = 1.0f / radius;
    meeting->normal =
        (Points){(off.x - deep * w.x) * scale, (off.y - deep * w.y) * scale, (off.z - deep * w.z) * scale};
}

/* A line and a cylinder's axis whose angle has a sine whose square is less count as parallel: where the line
 * enters the round is then lost in rounding, and it can meet only the end. */
static const float PARALLEL = 1e-6f;
/* By how much, of the square of the radius, a met point may lie outside the round for rounding. */
static const float ROUND_ROOM = 1e-3f;

/* Within the round: |t w - c|, without its part along the axis, is the radius. The discriminant is
 * A r^2 - (w . (c x axis))^2, which does not cancel. */
INLINE void meet_cylinder(const NearSolid *solid, const Points *way, float start, Meeting *meeting) {
    const Points w = *way;
    Point axis = solid->axis[1];
    float radius = solid->half.x, along = solid->along[1];
    Floats w_along = DOT(w, axis), a = 1.0f - w_along * w_along;
    Floats b = DOT(w, solid->centre) - w_along * along, c = DOT(w, solid->around[1]);
    Ints parallel = a < PARALLEL;
    Floats inside = a * (radius * radius) - c * c, root = ROOT(GREATEST(inside, ALL(0.0f)));
    Floats side = SIGNED(solid->half.y, w_along);
    Floats enter = PICK(parallel, ALL(-INFINITY), (b - root) / a);
    Floats leave = PICK(parallel, ALL(INFINITY), (b + root) / a);
    Floats near = (along - side) / w_along, far = (along + side) / w_along;
    Ints flat = near > enter;
    meeting->t = PICK(flat, near, enter);
    Points at = {meeting->t * w.x - solid->centre.x, meeting->t * w.y - solid->centre.y,
                 meeting->t * w.z - solid->centre.z};
    Floats at_along = DOT(at, axis), out = DOT(at, at) - at_along * at_along;
    meeting->met = ((inside >= 0.0f) | parallel) & (meeting->t <= leave) & (meeting->t <= far) &
                   (meeting->t >= start) & (out <= radius * radius * (1.0f + ROUND_ROOM));
    Floats up = -SIGNED(1.0f, w_along);
    float scale = 1.0f / radius;
    meeting->normal = (Points){PICK(flat, up * axis.x, (at.x - at_along * axis.x) * scale),
                               PICK(flat, up * axis.y, (at.y - at_along * axis.y) * scale),
                               PICK(flat, up * axis.z, (at.z - at_along * axis.z) * scale)};
}

INLINE void meet_box(const NearSolid *solid, const Points *way, float start, Meeting *meeting) {
    const Points w = *way;
    const float halves[3] = {solid->half.x, solid->half.y, solid->half.z};
    meeting->t = ALL(-INFINITY);
    meeting->normal = (Points){{0}, {0}, {0}};
    Floats leave = ALL(INFINITY);
    for (int k = 0; k < 3; k++) {
        Point axis = solid->axis[k];
        Floats w_along = DOT(w, axis), side = SIGNED(halves[k], w_along), up = -SIGNED(1.0f, w_along);
        Floats near = (solid->along[k] - side) / w_along, far = (solid->along[k] + side) / w_along;
        Ints later = near > meeting->t;
        meeting->t = PICK(later, near, meeting->t);
        leave = LEAST(leave, far);
        meeting->normal =
            (Points){PICK(later, up * axis.x, meeting->normal.x), PICK(later, up * axis.y, meeting->normal.y),
                     PICK(later, up * axis.z, meeting->normal.z)};
    }
    meeting->met = (meeting->t <= leave) & (meeting->t >= start);
}

/* A surface faces the light if N.L is more than rounding: the sides of a box along the light are at exactly
 * 0, where a highlight would begin at once, and turned into the frame of a block they are at +-1e-7. */
static const float FACING_LEAST = 1e-6f;

/* What light_scene.h says of a surface's light, for solids that nothing shades. */
INLINE void shade(Point colour, Point light, const Meeting *meeting, const Points *way, Points *shaded) {
    const Points normal = meeting->normal, w = *way;
    Floats facing = DOT(normal, light), zero = ALL(0.0f);
    Floats mirrored = DOT(w, light) - 2.0f * facing * DOT(normal, w); /* R.V with V = -w */
    Floats shine = GREATEST(mirrored, zero);
    shine *= shine, shine *= shine, shine *= shine, shine *= shine, shine *= shine; /* ^32 */
    Ints lit = facing > FACING_LEAST;
    Floats diffuse = (float)LIGHT_AMBIENT + (float)LIGHT_DIFFUSE * PICK(lit, facing, zero);
    Floats highlight = (float)LIGHT_SPECULAR * PICK(lit, shine, zero);
    *shaded = (Points){colour.x * diffuse + highlight, colour.y * diffuse + highlight,
                       colour.z * diffuse + highlight};
}

#endif
