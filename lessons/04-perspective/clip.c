/* Clip space: how a point gets there, and how a polygon is cut before it is divided by w. */
#include "raster.h"

/* The new vertices are computed in doubles: with w from 1e-6 to 1e8 floats could put one behind the eye. */
#ifdef __clang__
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
#define float double
#pragma GCC visibility push(hidden)
#include "clip.glsl"
#pragma GCC visibility pop
#undef float

static const double LEAST_W = 1e-6, LARGEST = 1e8, GUARD_PIXELS = 1 << 20;

ClipVertex clip_vertex(const Camera *camera, int width, int height, Vec3 p, double s, double t) {
    Vec3 forward = vec3_normalize(vec3_sub(camera->target, camera->eye));
    Vec3 right = vec3_normalize(vec3_cross(forward, camera->up));
    Vec3 up = vec3_cross(right, forward);
    Vec3 d = vec3_sub(p, camera->eye);
    double near = camera->near, far = camera->far, distance = vec3_dot(forward, d);
    ClipVertex v = {.x = vec3_dot(right, d) * height / width, .y = vec3_dot(up, d), .s = s, .t = t};
    double scale;
    if (camera->fov_y_degrees > 0) {
        scale = 1 / tan(radians(camera->fov_y_degrees) / 2);
        v.z = ((far + near) * distance - 2 * far * near) / (far - near);
        v.w = distance;
    } else {
        scale = 2 / camera->height;
        v.z = (2 * distance - (far + near)) / (far - near);
        v.w = 1;
    }
    v.x *= scale;
    v.y *= scale;
    return v;
}

ClipVertex clip_vertex_mix(const ClipVertex *a, const ClipVertex *b, double t) {
    return (ClipVertex){clip_mix(a->x, b->x, t), clip_mix(a->y, b->y, t), clip_mix(a->z, b->z, t),
                        clip_mix(a->w, b->w, t), clip_mix(a->s, b->s, t), clip_mix(a->t, b->t, t),
                        clip_mix(a->r, b->r, t), clip_mix(a->g, b->g, t), clip_mix(a->b, b->b, t)};
}

static bool vertex_usable(const ClipVertex *v) {
    const double numbers[9] = {v->x, v->y, v->z, v->w, v->s, v->t, v->r, v->g, v->b};
    for (int i = 0; i < 9; i++)
        if (!(fabs(numbers[i]) <= LARGEST)) return false; /* false for a NaN too */
    return true;
}

/* A plane of clip space: x, y, z and w weighted, plus a constant, is >= 0 inside. */
typedef struct {
    double x, y, z, w, constant;
} ClipPlane;

static double plane_distance(const ClipPlane *plane, const ClipVertex *v) {
    return plane->x * v->x + plane->y * v->y + plane->z * v->z + plane->w * v->w + plane->constant;
}

/* Sutherland and Hodgman 1974: walks around the polygon and keeps what is inside of one plane. */
static int clip_against(const ClipPlane *plane, const ClipVertex *in, int corners, ClipVertex *out) {
    int kept = 0;
    for (int i = 0; i < corners; i++) {
        const ClipVertex *a = &in[i], *b = &in[(i + 1) % corners];
        double at_a = plane_distance(plane, a), at_b = plane_distance(plane, b);
        if (kept + 2 > CLIPPED_CORNERS_MAX) return 0; /* a convex polygon never comes here */
        if (at_a >= 0) out[kept++] = *a;
        if (at_a >= 0 && at_b < 0) out[kept++] = clip_vertex_mix(a, b, clip_parameter(at_a, at_b));
        if (at_a < 0 && at_b >= 0) out[kept++] = clip_vertex_mix(b, a, clip_parameter(at_b, at_a));
    }
    return kept;
}

int polygon_clip(const ClipVertex *polygon, int corners, int width, int height, ClipVertex *out) {
    /* So far off the picture, the edges of the rasterizer would no longer fit into its integers. */
    double guard_x = GUARD_PIXELS / (0.5 * width), guard_y = GUARD_PIXELS / (0.5 * height);
    const ClipPlane planes[6] = {{.w = 1, .constant = -LEAST_W}, {.z = 1, .w = 1},
                                 {.x = 1, .w = guard_x},         {.x = -1, .w = guard_x},
                                 {.y = 1, .w = guard_y},         {.y = -1, .w = guard_y}};
    ClipVertex other[CLIPPED_CORNERS_MAX];
    if (corners < 3 || corners > POLYGON_CORNERS_MAX) return 0;
    for (int i = 0; i < corners; i++) {
        if (!vertex_usable(&polygon[i])) return 0;
        out[i] = polygon[i];
    }
    for (int i = 0; i < 6; i += 2) { /* two planes a turn, so that the result ends up in out */
        corners = clip_against(&planes[i], out, corners, other);
        corners = clip_against(&planes[i + 1], other, corners, out);
    }
    return corners < 3 ? 0 : corners;
}
