/* Cameras: rays, projection and GL's matrices must tell of one and the same picture. */
#include "camera.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { CAMERAS = 500 };

static const int sizes[][2] = {{320, 240}, {1, 1}, {7, 500}, {1000, 3}, {1920, 1080}};
enum { SIZES = sizeof sizes / sizeof *sizes };

/* Numbers in low..high, the same in every run (Knuth's MMIX generator, its upper bits). */
static uint64_t seed = 1;

static double pick(double low, double high) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/* One call a statement: C leaves the order within a list of arguments or initializers open. */
static Vec3 pick_vector(double size) {
    double x = pick(-size, size);
    double y = pick(-size, size);
    double z = pick(-size, size);
    return v3(x, y, z);
}

/* Every second one is orthographic. The target is at least 1 away, and up at least 0.1 radians off the view.
 */
static Camera pick_camera(int i) {
    for (;;) {
        Camera camera = {.eye = pick_vector(5.0)};
        camera.target = pick_vector(5.0);
        camera.up = pick_vector(3.0);
        camera.fov_y_degrees = i % 2 ? 0.0 : pick(5.0, 120.0);
        camera.height = pick(0.5, 8.0);
        camera.near = pick(0.05, 0.5);
        camera.far = pick(15.0, 60.0);
        Vec3 way = vec3_sub(camera.target, camera.eye);
        double distance = vec3_length(way), length = vec3_length(camera.up);
        if (distance > 1.0 && length > 0.1 &&
            vec3_length(vec3_cross(way, camera.up)) > 0.1 * distance * length)
            return camera;
    }
}

static void expect_near(const char *what, int i, Vec3 got, Vec3 expected, double bound) {
    if (!(vec3_length(vec3_sub(got, expected)) <= bound))
        fail_msg("camera %d, %s: (%.17g, %.17g, %.17g), not (%.17g, %.17g, %.17g)", i, what, got.x, got.y,
                 got.z, expected.x, expected.y, expected.z);
}

/* By hand: from (0, 0, 5) toward the origin, 90 degrees, so that at distance 1 half the height is 1. */
static void known_rays(void **state) {
    (void)state;
    Camera camera = {.eye = {0, 0, 5}, .up = {0, 1, 0}, .fov_y_degrees = 90.0, .near = 0.1, .far = 10.0};
    Ray ray = camera_ray(&camera, 400, 200, 400.0, 200.0); /* the upper right corner */
    expect_near("origin", 0, ray.origin, v3(0, 0, 5), 0.0);
    expect_near("direction", 0, ray.direction, vec3_normalize(v3(2, 1, -1)), 1e-15);
    ray = camera_ray(&camera, 400, 200, 0.5, 0.5); /* the centre of pixel (0, 0), lower left */
    expect_near("direction", 0, ray.direction, vec3_normalize(v3(-1.995, -0.995, -1)), 1e-15);
    camera.fov_y_degrees = 0.0;
    camera.height = 3.0;
    ray = camera_ray(&camera, 400, 200, 400.0, 0.0); /* the lower right corner */
    expect_near("origin", 1, ray.origin, v3(3, -1.5, 5), 1e-15);
    expect_near("direction", 1, ray.direction, v3(0, 0, -1), 1e-15);
}

static void centre_hits_target(void **state) {
    (void)state;
    for (int i = 0; i < CAMERAS; i++) {
        Camera camera = pick_camera(i);
        int width = sizes[i % SIZES][0], height = sizes[i % SIZES][1];
        Ray ray = camera_ray(&camera, width, height, width / 2.0, height / 2.0);
        double distance = vec3_length(vec3_sub(camera.target, camera.eye));
        expect_near("centre", i, ray_at(ray, distance), camera.target, 1e-14);
        expect_near("eye", i, ray.origin, camera.eye, 0.0);
    }
}

/* Whatever the size, x grows to the right and y along up: not mirrored, not turned. */
static void picture_is_upright(void **state) {
    (void)state;
    for (int i = 0; i < CAMERAS; i++) {
        Camera camera = pick_camera(i);
        Vec3 way = vec3_sub(camera.target, camera.eye), right = vec3_cross(way, camera.up);
        Vec2 centre = camera_project(&camera, 320, 240, camera.target);
        Vec2 beside = camera_project(&camera, 320, 240, vec3_add(camera.target, vec3_scale(right, 1e-3)));
        Vec2 above = camera_project(&camera, 320, 240, vec3_add(camera.target, vec3_scale(camera.up, 1e-3)));
        if (!(beside.x > centre.x && fabs(beside.y - centre.y) < 1e-9))
            fail_msg("camera %d: right goes by (%g, %g)", i, beside.x - centre.x, beside.y - centre.y);
        if (!(above.y > centre.y && fabs(above.x - centre.x) < 1e-9))
            fail_msg("camera %d: up goes by (%g, %g)", i, above.x - centre.x, above.y - centre.y);
    }
}

/* Rounding alone: 1e-12 of the picture's larger side. Directions have length one. */
static void project_inverts_ray(void **state) {
    (void)state;
    for (int i = 0; i < CAMERAS * SIZES; i++) {
        Camera camera = pick_camera(i);
        int width = sizes[i % SIZES][0], height = sizes[i % SIZES][1];
        double x = pick(0.0, width);
        double y = pick(0.0, height);
        Ray ray = camera_ray(&camera, width, height, x, y);
        if (!(fabs(vec3_length(ray.direction) - 1.0) < 1e-15)) fail_msg("camera %d: direction not one", i);
        Vec2 got = camera_project(&camera, width, height, ray_at(ray, pick(0.5, 20.0)));
        double bound = 1e-12 * fmax(width, height);
        if (!(fabs(got.x - x) < bound && fabs(got.y - y) < bound))
            fail_msg("camera %d, %d x %d: (%.17g, %.17g), not (%.17g, %.17g)", i, width, height, got.x, got.y,
                     x, y);
    }
}

/* column-major m times (p, 1), in doubles: what is seen is the rounding of the entries alone. */
static void transform(mat4 m, const double p[4], double out[4]) {
    for (int row = 0; row < 4; row++) {
        out[row] = 0.0;
        for (int column = 0; column < 4; column++) out[row] += (double)m[column][row] * p[column];
    }
}

/* The point p as GL has it: normalized device coordinates, -1..1 in the picture. */
static Vec3 gl_project(const Camera *camera, int width, int height, Vec3 p) {
    mat4 view, projection;
    double seen[4], clip[4], world[4] = {p.x, p.y, p.z, 1.0};
    camera_matrices(camera, width, height, view, projection);
    transform(view, world, seen);
    transform(projection, seen, clip);
    return v3(clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]);
}

/* A float is off by 6e-8 of itself at most; twice that is allowed for. So the view puts p off by that share
 * of the distances from the origin that meet in it; the projection magnifies this by its first two entries
 * over the depth, and an error in the depth moves a point at the edge as much as its share of the depth. */
static void matrices_agree_with_project(void **state) {
    (void)state;
    for (int i = 0; i < CAMERAS * SIZES; i++) {
        Camera camera = pick_camera(i);
        int width = sizes[i % SIZES][0], height = sizes[i % SIZES][1];
        double x = pick(0.0, width);
        double y = pick(0.0, height);
        Vec3 p = ray_at(camera_ray(&camera, width, height, x, y), pick(1.0, 20.0));
        mat4 view, projection;
        camera_matrices(&camera, width, height, view, projection);
        Vec3 forward = vec3_normalize(vec3_sub(camera.target, camera.eye));
        double depth = i % 2 ? 1.0 : vec3_dot(vec3_sub(p, camera.eye), forward);
        double magnified = (fmax(projection[0][0], projection[1][1]) + 1.0) / depth;
        double bound = 1.2e-7 * (1.0 + (vec3_length(p) + vec3_length(camera.eye)) * magnified);
        Vec3 device = gl_project(&camera, width, height, p);
        Vec2 pixel = camera_project(&camera, width, height, p);
        Vec2 error = v2(device.x - (2.0 * pixel.x / width - 1.0), device.y - (2.0 * pixel.y / height - 1.0));
        if (!(fabs(error.x) < bound && fabs(error.y) < bound))
            fail_msg("camera %d, %d x %d: off by (%g, %g), more than %g", i, width, height, error.x, error.y,
                     bound);
    }
}

/* Near the eye, a float's error of an eye up to 9 away is magnified by 2 / near. */
static void depth_runs_from_near_to_far(void **state) {
    (void)state;
    for (int i = 0; i < CAMERAS; i++) {
        Camera camera = pick_camera(i);
        Ray ray = camera_ray(&camera, 320, 240, 160.0, 120.0);
        Vec3 near = gl_project(&camera, 320, 240, ray_at(ray, camera.near));
        Vec3 middle = gl_project(&camera, 320, 240, ray_at(ray, (camera.near + camera.far) / 2.0));
        Vec3 far = gl_project(&camera, 320, 240, ray_at(ray, camera.far));
        if (!(fabs(near.z + 1.0) < 5e-6 / camera.near && fabs(far.z - 1.0) < 1e-5))
            fail_msg("camera %d: depth from %.9g to %.9g", i, near.z, far.z);
        bool between = i % 2 ? fabs(middle.z) < 1e-5 : middle.z > near.z && middle.z < far.z;
        if (!between) fail_msg("camera %d: depth %.9g halfway", i, middle.z);
    }
}

static void expect_mix(int i, const Camera *a, const Camera *b, double t) {
    Camera got = camera_mix(a, b, t);
    const Vec3 from[] = {a->eye, a->target, a->up, {a->fov_y_degrees, a->height, 0}, {a->near, a->far, 0}};
    const Vec3 to[] = {b->eye, b->target, b->up, {b->fov_y_degrees, b->height, 0}, {b->near, b->far, 0}};
    const Vec3 at[] = {
        got.eye, got.target, got.up, {got.fov_y_degrees, got.height, 0}, {got.near, got.far, 0}};
    for (int k = 0; k < 5; k++)
        expect_near("mix", i, at[k], vec3_add(vec3_scale(from[k], 1.0 - t), vec3_scale(to[k], t)), 1e-13);
}

static void mix_goes_from_end_to_end(void **state) {
    (void)state;
    for (int i = 0; i < CAMERAS; i++) {
        Camera a = pick_camera(i);
        Camera b = pick_camera(i);
        for (int quarter = 0; quarter <= 4; quarter++) expect_mix(i, &a, &b, quarter / 4.0);
    }
}

/* What the picture's middle shows after a pan was, before it, that part of the picture's height away. */
static void pan_moves_aside(void **state) {
    (void)state;
    for (int i = 0; i < CAMERAS; i++) {
        Camera before = pick_camera(i), after = before;
        camera_pan(&after, 0.25, -0.125);
        Vec2 seen = camera_project(&before, 320, 240, after.target);
        expect_near("pan", i, v3(seen.x, seen.y, 0), v3(160 + 60, 120 - 30, 0), 1e-7);
        Vec3 way = vec3_sub(before.eye, before.target);
        expect_near("pan's way", i, vec3_sub(after.eye, after.target), way, 1e-9 * (1 + vec3_length(way)));
    }
}

int main(void) {
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_rays),
        cmocka_unit_test(centre_hits_target),
        cmocka_unit_test(picture_is_upright),
        cmocka_unit_test(project_inverts_ray),
        cmocka_unit_test(matrices_agree_with_project),
        cmocka_unit_test(depth_runs_from_near_to_far),
        cmocka_unit_test(mix_goes_from_end_to_end),
        cmocka_unit_test(pan_moves_aside),
    };
    return cmocka_run_group_tests_name("camera", tests, NULL, NULL);
}
