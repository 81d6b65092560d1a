/* Rays against solids. All three kinds are convex, so the line of a ray is inside one over a single span, and
 * that is what is computed: the span between two parallel planes, and the span within something round. A
 * sphere is round; a cylinder is where the line is within the round and between its ends; a box is three
 * pairs of planes. */
#include "solid.h"

#include <float.h>

/* Where a line is inside, from the point at enter to the one at leave, and the outward normals there, of any
 * length; they count only where the ends are finite. */
typedef struct {
    double enter, leave;
    Vec3 enter_normal, leave_normal;
} Span;

/* The line of a ray in a solid's own terms: at `at` for t = 0, in the direction `way`. */
typedef struct {
    Vec3 at, way;
} Line;

static const Span everywhere = {.enter = -INFINITY, .leave = INFINITY};
static const Span nowhere = {.enter = INFINITY, .leave = -INFINITY};

static Span span_both(Span a, Span b) {
    bool later = b.enter > a.enter, sooner = b.leave < a.leave;
    return (Span){.enter = later ? b.enter : a.enter,
                  .leave = sooner ? b.leave : a.leave,
                  .enter_normal = later ? b.enter_normal : a.enter_normal,
                  .leave_normal = sooner ? b.leave_normal : a.leave_normal};
}

/* Between the planes at -half and +half of an axis, along which the line is at x and goes by dx. */
static Span span_between(double x, double dx, double half, Vec3 axis) {
    if (dx == 0.0) return fabs(x) <= half ? everywhere : nowhere; /* 0 / 0 for a line within a plane */
    double side = copysign(half, dx);
    Vec3 ahead = vec3_scale(axis, copysign(1.0, dx));
    return (Span){(-side - x) / dx, (side - x) / dx, vec3_scale(ahead, -1.0), ahead};
}

/* Within a radius of the origin: the roots of |at + t way|^2 = radius^2. Their discriminant is written by a
 * cross product, which does not cancel as b^2 - a c would, far from the origin along something thin. */
static Span span_round(Vec3 at, Vec3 way, double radius) {
    double a = vec3_dot(way, way), b = vec3_dot(at, way);
    if (a < DBL_MIN) return vec3_length(at) <= radius ? everywhere : nowhere; /* along a cylinder's axis */
    Vec3 moment = vec3_cross(at, way);
    double discriminant = a * radius * radius - vec3_dot(moment, moment);
    if (!(discriminant >= 0.0)) return nowhere;
    Span span = {.enter = (-b - sqrt(discriminant)) / a, .leave = (-b + sqrt(discriminant)) / a};
    span.enter_normal = vec3_add(at, vec3_scale(way, span.enter));
    span.leave_normal = vec3_add(at, vec3_scale(way, span.leave));
    return span;
}

static Span span_solid(SolidKind kind, Vec3 size, Line line) {
    Vec3 at = line.at, way = line.way, half = vec3_scale(size, 0.5);
    if (kind == SOLID_SPHERE) return span_round(at, way, half.x);
    Span height = span_between(at.y, way.y, half.y, v3(0, 1, 0));
    if (kind == SOLID_CYLINDER)
        return span_both(height, span_round(v3(at.x, 0, at.z), v3(way.x, 0, way.z), half.x));
    Span width = span_between(at.x, way.x, half.x, v3(1, 0, 0));
    return span_both(span_both(width, height), span_between(at.z, way.z, half.z, v3(0, 0, 1)));
}

/* ---- Places: the solid's own axes as they lie in the world, and the sphere around it ---- */

typedef struct {
    Vec3 x, y, z;
} Axes;

static Vec3 turn(Vec3 p, Vec3 sine, Vec3 cosine) {
    p = v3(p.x, cosine.x * p.y - sine.x * p.z, sine.x * p.y + cosine.x * p.z);    /* about x: y toward z */
    p = v3(cosine.y * p.x + sine.y * p.z, p.y, cosine.y * p.z - sine.y * p.x);    /* about y: z toward x */
    return v3(cosine.z * p.x - sine.z * p.y, sine.z * p.x + cosine.z * p.y, p.z); /* about z: x toward y */
}

static Axes solid_axes(Vec3 degrees) {
    Vec3 angle = v3(radians(degrees.x), radians(degrees.y), radians(degrees.z));
    Vec3 sine = v3(sin(angle.x), sin(angle.y), sin(angle.z));
    Vec3 cosine = v3(cos(angle.x), cos(angle.y), cos(angle.z));
    return (Axes){turn(v3(1, 0, 0), sine, cosine), turn(v3(0, 1, 0), sine, cosine),
                  turn(v3(0, 0, 1), sine, cosine)};
}

static Vec3 into(Axes axes, Vec3 p) {
    return v3(vec3_dot(axes.x, p), vec3_dot(axes.y, p), vec3_dot(axes.z, p));
}

static Vec3 out_of(Axes axes, Vec3 p) {
    return vec3_add(vec3_add(vec3_scale(axes.x, p.x), vec3_scale(axes.y, p.y)), vec3_scale(axes.z, p.z));
}

/* The square of the distance from a solid's centre to its farthest point. */
static double solid_reach_squared(const Solid *solid) {
    Vec3 size = solid->size;
    if (solid->kind == SOLID_SPHERE) size = v3(size.x, 0, 0);
    if (solid->kind == SOLID_CYLINDER) size.z = 0;
    return vec3_dot(size, size) / 4.0;
}

bool solids_hit(const Solid *solids, int count, Ray ray, SolidHit *hit) {
    double nearest = INFINITY;
    for (int i = 0; i < count; i++) {
        const Solid *solid = &solids[i];
        /* The line is followed from the point where it passes the centre, so that what is computed is as
         * small as the solid, wherever the ray begins. */
        Vec3 toward = vec3_sub(solid->centre, ray.origin);
        double passing = vec3_dot(toward, ray.direction);
        Vec3 at = vec3_sub(vec3_scale(ray.direction, passing), toward);
        if (vec3_dot(at, at) > solid_reach_squared(solid)) continue;
        Axes axes = solid_axes(solid->turn_degrees);
        Span span = span_solid(solid->kind, solid->size, (Line){into(axes, at), into(axes, ray.direction)});
        bool outside = passing + span.enter >= 0.0;
        double depth = passing + (outside ? span.enter : span.leave);
        if (!(span.enter <= span.leave && depth >= 0.0 && depth < nearest)) continue;
        nearest = depth;
        Vec3 normal = out_of(axes, outside ? span.enter_normal : span.leave_normal);
        *hit = (SolidHit){.depth = depth, .normal = vec3_normalize(normal), .index = i};
    }
    return nearest < INFINITY;
}
