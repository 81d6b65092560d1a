/* Where rays meet the exact shapes: planes and cylinders against points chosen first, and reliefs against a
 * brute march that knows nothing of cells or roots. */
#include "truth.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdint.h>
#include <stdlib.h>

#include "random.h" /* behind cmocka.h */

static Ray ray_between(Vec3 from, Vec3 to) { return (Ray){from, vec3_normalize(vec3_sub(to, from))}; }

static void test_plane(void **state) {
    (void)state;
    for (int i = 0; i < 1000; i++) {
        double u = random_in(0, 1), v = random_in(0, 1);
        Vec3 point = v3((u - 0.5) * 3, (v - 0.5) * 0.7, 0);
        Vec3 eye = v3(random_in(-5, 5), random_in(-5, 5), random_in(-5, 5));
        Sample sample = truth_plane(ray_between(eye, point), 3, 0.7);
        assert_true(sample.hit);
        near(sample.u, u, 1e-12);
        near(sample.v, v, 1e-12);
        near(sample.depth, vec3_length(vec3_sub(point, eye)), 1e-11);
    }
    assert_false(truth_plane((Ray){{0, 0, 1}, {0, 0, 1}}, 1, 1).hit);    /* away */
    assert_false(truth_plane((Ray){{0, 0, 1}, {1, 0, 0}}, 1, 1).hit);    /* beside */
    assert_false(truth_plane((Ray){{-2, 0, 0}, {1, 0, 0}}, 1, 1).hit);   /* within */
    assert_false(truth_plane((Ray){{0.6, 0, 1}, {0, 0, -1}}, 1, 1).hit); /* past its edge */
}

static void test_cylinder(void **state) {
    (void)state;
    const double radius = 1.3, height = 2.0;
    for (int i = 0; i < 1000; i++) {
        double theta = random_in(-PI, PI), v = random_in(0, 1);
        Vec3 out = v3(sin(theta), 0, cos(theta)), point = vec3_scale(out, radius);
        point.y = (v - 0.5) * height;
        Vec3 way = v3(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1));
        if (vec3_dot(way, out) < 0)
            way = vec3_scale(way, -1); /* outward, so that the point is the first met */
        Sample sample = truth_cylinder(ray_between(vec3_add(point, way), point), radius, height);
        assert_true(sample.hit);
        near(sample.u, theta / (2 * PI) + 0.5, 1e-7); /* a ray that only grazes is met less exactly */
        near(sample.v, v, 1e-7);
    }
    assert_false(truth_cylinder((Ray){{0, 0, 5}, {0, 0, 1}}, radius, height).hit);
    assert_false(truth_cylinder((Ray){{1.31, 0, 5}, {0, 0, -1}}, radius, height).hit);
    assert_true(truth_cylinder((Ray){{1.29, 0, 5}, {0, 0, -1}}, radius, height).hit);
    assert_false(truth_cylinder((Ray){{0, 1.1, 5}, {0, 0, -1}}, radius, height).hit);
    assert_false(truth_cylinder((Ray){{0, 0, 0}, {0, 1, 0}}, radius, height).hit); /* along the axis */
    near(truth_cylinder((Ray){{0, 0, 0}, {0, 0, 1}}, radius, height).depth, radius, 1e-15); /* from inside */
    near(truth_cylinder((Ray){{0, 0, 5}, {0, 0, -1}}, radius, height).u, 0.5, 1e-15);
    near(truth_cylinder((Ray){{5, 0, 0}, {-1, 0, 0}}, radius, height).u, 0.75, 1e-15);
}

/* ---- Reliefs by brute force ---- */

static double above(const Relief *relief, Ray ray, double t) {
    Vec3 p = ray_at(ray, t);
    double h;
    image_sample(relief->height, p.x / relief->width + 0.5, p.y / (relief->width * relief->aspect) + 0.5, &h);
    return p.z - relief->width * relief->scale * (h - relief->base);
}

enum { STEPS = 20000 };

/* The first t at which the ray is at or below the surface: tiny steps through the layer of heights, then
 * bisection. */
static double march(const Relief *relief, Ray ray) {
    double depth = relief->width * relief->scale;
    double from = fmax(0, (depth * (1 - relief->base) - ray.origin.z) / ray.direction.z);
    double to = (-depth * relief->base - ray.origin.z) / ray.direction.z, step = (to - from) / STEPS;
    for (int i = 1; i <= STEPS; i++) {
        double low = from + (i - 1) * step, high = i == STEPS ? to : from + i * step;
        if (above(relief, ray, high) > 0) continue;
        for (int k = 0; k < 60; k++) {
            double middle = (low + high) / 2;
            if (above(relief, ray, middle) > 0)
                low = middle;
            else
                high = middle;
        }
        return high;
    }
    return to;
}

static void test_relief_against_marching(void **state) {
    (void)state;
    const int sizes[][2] = {{1, 1}, {2, 1}, {5, 3}, {8, 8}, {13, 7}};
    int earlier = 0, rays = 0;
    for (int i = 0; i < 5; i++) {
        Image height = image_create(sizes[i][0], sizes[i][1], 1);
        for (int k = 0; k < height.width * height.height; k++)
            height.pixels[k] = k % 5 == 4 ? 0.0f : k % 5 == 2 ? 1.0f : (float)random_in(0, 1);
        for (int k = 0; k < 60; k++) {
            Relief relief = {&height,     random_in(0.5, 2), random_in(0.5, 2), random_in(0.02, 0.3),
                             k % 3 / 2.0, RELIEF_REPEATED};
            double grazing = pow(10, random_in(-1.7, 0.5)); /* from 1 degree above the plane to its normal */
            Vec3 window = v3(random_in(-0.5, 0.5) * relief.width,
                             random_in(-0.5, 0.5) * relief.width * relief.aspect, 0);
            double turn = k % 7 == 0 ? PI / 2 * (k % 4) : random_in(-PI, PI); /* along the axes too */
            Vec3 eye = vec3_add(window, v3(4 * cos(turn), 4 * sin(turn), 4 * grazing));
            if (eye.z < relief.width * relief.scale)
                eye = vec3_add(eye, vec3_scale(vec3_sub(eye, window), 9));
            Ray ray = ray_between(eye, window);
            Sample sample = truth_relief(&relief, ray);
            assert_true(sample.hit);
            double t = march(&relief, ray);
            rays++;
            near(above(&relief, ray, sample.depth), 0, 1e-9);
            assert_true(sample.depth <= t + 1e-8);
            if (sample.depth < t - 1e-8) { /* a ridge grazed for less than a step: the march passes it by */
                earlier++;
                continue;
            }
            Vec3 p = ray_at(ray, t);
            near(sample.depth, t, 1e-8);
            near(sample.u, p.x / relief.width + 0.5, 1e-8);
            near(sample.v, p.y / (relief.width * relief.aspect) + 0.5, 1e-8);
        }
        image_destroy(&height);
    }
    assert_true(earlier * 50 < rays);
}

/* The first t at which the ray is at or below the surface within the slab's footprint, by small steps;
 * negative where there is none, or where the ray comes in below the surface. */
static double march_slab(const Relief *relief, Ray ray) {
    double height = relief->width * relief->aspect, top = relief->width * relief->scale * (1 - relief->base);
    bool began = false;
    for (double t = (top - ray.origin.z) / ray.direction.z; t < 40; t += 2e-4) {
        Vec3 p = ray_at(ray, t);
        bool inside = fabs(p.x) <= relief->width / 2 && fabs(p.y) <= height / 2;
        if (began && !inside) return -1;
        if (!inside) continue;
        if (above(relief, ray, t) <= 0) return began ? t : -1;
        began = true;
    }
    return -1;
}

/* A cut relief is the slab behind its window; both against marching, and misses as misses. */
static void test_relief_extents(void **state) {
    (void)state;
    Image height = image_create(6, 5, 1);
    for (int k = 0; k < 30; k++) height.pixels[k] = (float)random_in(0, 1);
    int hits = 0, misses = 0, behind = 0;
    for (int k = 0; k < 300; k++) {
        Relief relief = {&height, 1.5, 0.8, 0.2, k % 3 / 2.0, RELIEF_SLAB};
        Vec3 toward = v3(random_in(-0.9, 0.9), random_in(-0.8, 0.8), 0);
        Vec3 eye = v3(random_in(-4, 4), random_in(-4, 4), random_in(0.5, 2));
        Ray ray = ray_between(eye, toward);
        double t = march_slab(&relief, ray);
        Sample slab = truth_relief(&relief, ray);
        if (slab.hit != (t >= 0) || (slab.hit && fabs(slab.depth - t) > 3e-4)) {
            misses +=
                1000 * (slab.hit && t >= 0 && slab.depth > t); /* never later; a ridge may be passed by */
            behind++;
            continue;
        }
        slab.hit ? hits++ : misses++;
        relief.extent = RELIEF_CUT;
        Sample cut = truth_relief(&relief, ray), window = truth_plane(ray, 1.5, 1.5 * 0.8);
        assert_int_equal(cut.hit, slab.hit && window.hit);
        if (cut.hit) near(cut.depth, slab.depth, 0);
        if (slab.hit) assert_true(slab.u >= 0 && slab.u <= 1 && slab.v >= 0 && slab.v <= 1);
    }
    assert_true(hits > 100 && misses > 30 && misses < 1000 && behind < 6);
    image_destroy(&height);
}

/* The normal against the surface itself, by differences. */
static void test_relief_normal(void **state) {
    (void)state;
    Image height = image_create(6, 5, 1);
    for (int k = 0; k < 30; k++) height.pixels[k] = (float)random_in(0, 1);
    Relief relief = {&height, 1.5, 0.8, 0.2, 1, RELIEF_REPEATED};
    for (int k = 0; k < 50; k++) {
        double u = random_in(0, 1), v = random_in(0, 1), step = 1e-7, h[3];
        image_sample(&height, u, v, &h[0]);
        image_sample(&height, u + step, v, &h[1]);
        image_sample(&height, u, v + step, &h[2]);
        Vec3 along_u = v3(step * 1.5, 0, 0.2 * 1.5 * (h[1] - h[0]));
        Vec3 along_v = v3(0, step * 1.5 * 0.8, 0.2 * 1.5 * (h[2] - h[0]));
        Vec3 normal = vec3_normalize(vec3_cross(along_u, along_v)), ours = truth_relief_normal(&relief, u, v);
        near(vec3_length(vec3_sub(normal, ours)), 0, 1e-5);
    }
    image_destroy(&height);
}

static void test_relief_special(void **state) {
    (void)state;
    Image height = image_create(4, 4, 1);
    for (int i = 0; i < 16; i++) height.pixels[i] = 0.25f;
    Relief relief = {&height, 1, 1, 0.2, 1, RELIEF_REPEATED};
    Ray down = {{0.1, 0.2, 3}, {0, 0, -1}};
    near(truth_relief(&relief, down).depth, 3.15, 1e-12);
    relief.base = 0;
    near(truth_relief(&relief, down).depth, 2.95, 1e-12);
    relief.scale = 0; /* the polygon itself */
    near(truth_relief(&relief, down).depth, 3, 1e-12);
    relief.scale = 0.2;
    assert_false(truth_relief(&relief, (Ray){{0, 0, -1}, {0, 0, 1}}).hit); /* from behind */
    assert_false(truth_relief(&relief, (Ray){{2, 0, 1}, {0, 0, -1}}).hit); /* outside the window */
    assert_false(truth_relief(&relief, (Ray){{-2, 0, 0}, {1, 0, 0}}).hit); /* in its plane */
    /* 45 degrees to the left: at depth 0.15 the point lies 0.15 widths further, outside of 0..1 too */
    relief.base = 1;
    Ray slanted = {{1.4 - 0.95, 0, 1}, {-0.70710678118654757, 0, -0.70710678118654757}};
    Sample sample = truth_relief(&relief, slanted);
    assert_false(sample.hit); /* it crosses z = 0 at x = -0.55 */
    slanted.origin.x += 0.1;
    sample = truth_relief(&relief, slanted);
    assert_true(sample.hit);
    near(sample.u, 0.05 - 0.15, 1e-12);
    image_destroy(&height);
}

/* An eye within the layer of heights: a ridge right behind it is not met, for the way begins at the eye. */
static void test_relief_from_within(void **state) {
    (void)state;
    Image height = image_create(8, 1, 1);
    height.pixels[2] = 1.0f; /* a ridge along x = -3/16, with z up to 0.4 */
    Relief relief = {&height, 1, 1, 0.4, 0, RELIEF_REPEATED};
    const double half = 0.70710678118654752;
    Ray down = {{0, 0.1, 0.2}, {half, 0, -half}}; /* backward it would pass through the ridge */
    Sample sample = truth_relief(&relief, down);
    assert_true(sample.hit);
    near(sample.depth, 0.2 / half, 1e-12);
    near(sample.u, 0.7, 1e-12);
    image_destroy(&height);
}

/* A surface as high as the layer: rays enter at it exactly, and rounding decides nothing. */
static void test_relief_at_the_top(void **state) {
    (void)state;
    Image height = image_create(3, 3, 1);
    for (int i = 0; i < 9; i++) height.pixels[i] = 1;
    for (int i = 0; i < 1000; i++) {
        Relief relief = {&height, 1, 1, random_in(0.02, 0.3), 1, i % 2 ? RELIEF_CUT : RELIEF_SLAB};
        Vec3 window = v3(random_in(-0.5, 0.5), random_in(-0.5, 0.5), 0);
        Vec3 eye = v3(random_in(-2, 2), random_in(-2, 2), random_in(0.1, 2));
        Sample sample = truth_relief(&relief, ray_between(eye, window));
        assert_true(sample.hit);
        near(sample.u, window.x + 0.5, 1e-9);
    }
    image_destroy(&height);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_cylinder),
        cmocka_unit_test(test_relief_against_marching),
        cmocka_unit_test(test_relief_extents),
        cmocka_unit_test(test_relief_normal),
        cmocka_unit_test(test_relief_special),
        cmocka_unit_test(test_relief_from_within),
        cmocka_unit_test(test_relief_at_the_top),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("shapes", tests, NULL, NULL);
}
