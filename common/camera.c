#include "camera.h"

#include <cglm/cglm.h>

/* The camera's axes: x to the right, y up, z forward in the picture (GL's z is backward). */
typedef struct {
    Vec3 right, up, forward;
} Axes;

static Axes camera_axes(const Camera *camera) {
    Vec3 forward = vec3_normalize(vec3_sub(camera->target, camera->eye));
    Vec3 right = vec3_normalize(vec3_cross(forward, camera->up));
    return (Axes){.right = right, .up = vec3_cross(right, forward), .forward = forward};
}

/* Half of what the picture shows from bottom to top: at distance 1 in perspective, everywhere otherwise. */
static double half_height(const Camera *camera) {
    return camera->fov_y_degrees > 0.0 ? tan(radians(camera->fov_y_degrees) / 2.0) : camera->height / 2.0;
}

Rays camera_rays(const Camera *camera, int width, int height) {
    Axes axes = camera_axes(camera);
    double pixel = 2.0 * half_height(camera) / height; /* pixels are square */
    bool perspective = camera->fov_y_degrees > 0.0;
    return (Rays){.perspective = perspective,
                  .fixed = perspective ? camera->eye : axes.forward,
                  .middle = perspective ? axes.forward : camera->eye,
                  .right = vec3_scale(axes.right, pixel),
                  .up = vec3_scale(axes.up, pixel),
                  .half_width = width / 2.0,
                  .half_height = height / 2.0};
}

Ray camera_ray(const Camera *camera, int width, int height, double x, double y) {
    Rays rays = camera_rays(camera, width, height);
    return rays_at(&rays, x, y);
}

Vec2 camera_project(const Camera *camera, int width, int height, Vec3 p) {
    Axes axes = camera_axes(camera);
    Vec3 way = vec3_sub(p, camera->eye);
    double pixel = 2.0 * half_height(camera) / height;
    if (camera->fov_y_degrees > 0.0) pixel *= vec3_dot(way, axes.forward);
    return v2(width / 2.0 + vec3_dot(way, axes.right) / pixel, height / 2.0 + vec3_dot(way, axes.up) / pixel);
}

void camera_matrices(const Camera *camera, int width, int height, mat4 view, mat4 projection) {
    Axes axes = camera_axes(camera);
    Vec3 rows[3] = {axes.right, axes.up, vec3_scale(axes.forward, -1.0)};
    glm_mat4_identity(view);
    for (int i = 0; i < 3; i++) {
        view[0][i] = (float)rows[i].x;
        view[1][i] = (float)rows[i].y;
        view[2][i] = (float)rows[i].z;
        view[3][i] = (float)-vec3_dot(rows[i], camera->eye);
    }
    /* Depth z = -near becomes -1 and z = -far becomes 1, after the division by w, which is -z or 1. */
    double half = half_height(camera), near = camera->near, far = camera->far, range = far - near;
    glm_mat4_zero(projection);
    projection[0][0] = (float)(height / (half * width));
    projection[1][1] = (float)(1.0 / half);
    if (camera->fov_y_degrees > 0.0) {
        projection[2][2] = (float)(-(far + near) / range);
        projection[3][2] = (float)(-2.0 * far * near / range);
        projection[2][3] = -1.0f;
    } else {
        projection[2][2] = (float)(-2.0 / range);
        projection[3][2] = (float)(-(far + near) / range);
        projection[3][3] = 1.0f;
    }
}

static double mix(double a, double b, double t) { return a + (b - a) * t; }

Camera camera_mix(const Camera *a, const Camera *b, double t) {
    return (Camera){.eye = vec3_mix(a->eye, b->eye, t),
                    .target = vec3_mix(a->target, b->target, t),
                    .up = vec3_mix(a->up, b->up, t),
                    .fov_y_degrees = mix(a->fov_y_degrees, b->fov_y_degrees, t),
                    .height = mix(a->height, b->height, t),
                    .near = mix(a->near, b->near, t),
                    .far = mix(a->far, b->far, t)};
}

/* ---- Moving by hand ---- */

static Vec3 turned(Vec3 v, Vec3 axis, double angle) { /* Rodrigues' formula; the axis has length one */
    Vec3 along = vec3_scale(axis, vec3_dot(axis, v) * (1.0 - cos(angle)));
    return vec3_add(vec3_add(vec3_scale(v, cos(angle)), vec3_scale(vec3_cross(axis, v), sin(angle))), along);
}

void camera_orbit(Camera *camera, double right, double up) {
    const double pole = radians(1.0);
    Vec3 axis = vec3_normalize(camera->up), way = vec3_sub(camera->eye, camera->target);
    way = turned(way, axis, right);
    double angle = acos(clamp(vec3_dot(vec3_normalize(way), axis), -1.0, 1.0));
    double wanted = clamp(angle - up, pole, PI - pole);
    way = turned(way, vec3_normalize(vec3_cross(axis, way)), wanted - angle);
    camera->eye = vec3_add(camera->target, way);
}

void camera_pan(Camera *camera, double right, double up) {
    Axes axes = camera_axes(camera);
    double distance = vec3_length(vec3_sub(camera->target, camera->eye));
    double shown = 2.0 * half_height(camera) * (camera->fov_y_degrees > 0.0 ? distance : 1.0);
    Vec3 way = vec3_add(vec3_scale(axes.right, right * shown), vec3_scale(axes.up, up * shown));
    camera->eye = vec3_add(camera->eye, way);
    camera->target = vec3_add(camera->target, way);
}

void camera_nearer(Camera *camera, double factor) {
    if (camera->fov_y_degrees > 0.0) {
        Vec3 way = vec3_sub(camera->eye, camera->target);
        double distance = vec3_length(way), nearest = fmin(distance, 2.0 * camera->near);
        double wanted = clamp(distance / factor, nearest, fmax(distance, camera->far));
        camera->eye = vec3_add(camera->target, vec3_scale(way, wanted / distance));
    } else {
        camera->height = clamp(camera->height / factor, 1e-6, 1e6);
    }
}
