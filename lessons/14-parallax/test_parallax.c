/* The lesson's own C: the distortion map against the paper's equation, the prism's depth map against the
 * circle, the steepness against slopes that are known, and the search for a disparity in rows made by hand.
 */
#include "parallax.h"
#include "prism.h"
#include "stereo.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdlib.h>

static void near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound))
        fail_msg("got %.17g, expected %.17g within %g", value, expected, bound);
}

/* A height map of different heights everywhere. */
static Image uneven(int width, int height) {
    Image image = image_create(width, height, 1);
    for (int i = 0; i < width * height; i++) image.pixels[i] = (float)((i * 37 % 101) / 100.0);
    return image;
}

/* Independent of tangents: the ray from the eye through the polygon's point is followed to where it is d
 * above the polygon, and that is where u', v' must be. */
static void test_distortion_follows_the_ray(void **state) {
    (void)state;
    Image height = uneven(9, 6);
    Relief relief = {&height, 1.0, 0.7, 0.1, 0.4, RELIEF_REPEATED};
    Camera camera = {.eye = {0.9, -0.6, 1.1}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov_y_degrees = 40};
    Image map = parallax_distortion(&relief, &camera);
    assert_int_equal(map.width, 9);
    assert_int_equal(map.height, 6);
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            double u = (x + 0.5) / 9, v = (y + 0.5) / 6, d = 0.1 * (*image_at(&height, x, y) - 0.4);
            Vec3 point = v3(u - 0.5, (v - 0.5) * 0.7, 0), way = vec3_sub(point, camera.eye);
            Vec3 met = vec3_add(camera.eye, vec3_scale(way, (d - camera.eye.z) / way.z));
            near(image_at(&map, x, y)[0], met.x + 0.5 - u, 1e-7);
            near(image_at(&map, x, y)[1], met.y / 0.7 + 0.5 - v, 1e-7);
        }
    image_destroy(&map);
    image_destroy(&height);
}

/* The eye to the right of a hollow: what is seen there lies farther left (du = d tan theta, d < 0). */
static void test_distortion_sign(void **state) {
    (void)state;
    Image height = image_create(1, 1, 1); /* 0: the bottom */
    Relief relief = {&height, 1.0, 1.0, 0.1, 1.0, RELIEF_REPEATED};
    Camera camera = {.eye = {1, 0, 1}, .target = {0, 0, 0}, .up = {0, 1, 0}, .height = 1};
    Image map = parallax_distortion(&relief, &camera);
    near(map.pixels[0], -0.1, 1e-7);
    near(map.pixels[1], 0.0, 0.0);
    image_destroy(&map);
    image_destroy(&height);
}

static void test_tangents_in_the_plane(void **state) {
    (void)state;
    const Vec3 views[] = {{1, 0, 0}, {0.6, 0.8, -0.1}, {0, 0, -1}, {0, 0, 0}, {1, 1, 1e-7}};
    for (int i = 0; i < 5; i++) {
        Vec2 t = parallax_tangents(views[i]);
        assert_true(t.x == 0.0 && t.y == 0.0);
    }
    near(parallax_tangents(v3(3, -1, 2)).x, 1.5, 0.0);
    near(parallax_tangents(v3(3, -1, 2)).y, -0.5, 0.0);
}

/* Points of the arc from the map: each must be on the circle of radius 1, up to the map's floats. */
static void test_depth_map_is_the_circle(void **state) {
    (void)state;
    const int sides[] = {3, 4, 7, 8, 32, 64};
    for (int i = 0; i < 6; i++) {
        double half = PI / sides[i], width = 2 * sides[i] * sin(half), corner = 0.3;
        Image map = prism_depth_map(sides[i], corner);
        for (int x = 0; x < map.width; x++) {
            double u = (x + 0.5) / map.width - corner, face = (u - floor(u)) * sides[i];
            double along = (face - floor(face) - 0.5) * 2 * sin(half);
            double up = cos(half) + prism_scale(sides[i]) * width * *image_at(&map, x, 0);
            near(hypot(along, up), 1.0, 1e-7);
        }
        image_destroy(&map);
    }
}

static void test_steepness(void **state) {
    (void)state;
    Image ramp = image_create(4, 2, 1); /* 0, 1/4, 1/2, 3/4: the seam falls by 3/4 */
    for (int i = 0; i < 8; i++) ramp.pixels[i] = (float)(i % 4) / 4;
    Relief relief = {&ramp, 1.0, 0.5, 0.2, 1.0, RELIEF_REPEATED};
    near(parallax_steepness(&relief), 0.2 * 0.75 * 4, 1e-12);
    *image_at(&ramp, 3, 0) = *image_at(&ramp, 3, 1) = 0.25f; /* 0, 1/4, 1/2, 1/4 */
    near(parallax_steepness(&relief), 0.2 * 0.25 * 4, 1e-12);
    image_destroy(&ramp);
    Image one = image_create(1, 1, 1);
    relief.height = &one;
    near(parallax_steepness(&relief), 0.0, 0.0);
    image_destroy(&one);
}

static void test_find_in_a_row(void **state) {
    (void)state;
    /* u = 0.1, 0.2, ..., then a hole, then 0.25 again at another v, and backwards */
    const float row[][4] = {{0.1f, 0.5f, 1, 1}, {0.2f, 0.5f, 1, 1}, {0.3f, 0.5f, 1, 1}, {0, 0, 0, 0},
                            {0.4f, 0.5f, 1, 1}, {0.3f, 0.9f, 1, 1}, {0.2f, 0.9f, 1, 1}};
    near(stereo_find(row[0], 7, 0.25, 0.5), 2.0, 1e-6); /* halfway between the centres at 1.5 and 2.5 */
    near(stereo_find(row[0], 7, 0.25, 0.9), 6.0, 1e-6); /* the same u, nearer in v */
    near(stereo_find(row[0], 7, 0.1f, 0.5), 0.5, 1e-6); /* on a centre */
    near(stereo_find(row[0], 7, 0.05, 0.5), -1.0, 0.0); /* nowhere */
    near(stereo_find(row[0], 4, 0.35, 0.5), -1.0, 0.0); /* beyond a hole nothing is interpolated */
    near(stereo_find(row[0], 1, 0.1f, 0.5), -1.0, 0.0); /* one pixel has no neighbour */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distortion_follows_the_ray),
        cmocka_unit_test(test_distortion_sign),
        cmocka_unit_test(test_tangents_in_the_plane),
        cmocka_unit_test(test_depth_map_is_the_circle),
        cmocka_unit_test(test_steepness),
        cmocka_unit_test(test_find_in_a_row),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson 14", tests, NULL, NULL);
}
