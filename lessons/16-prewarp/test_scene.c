/* The scene around the warps: its source and its truth, which polygons a view gets, where they lie, and the
 * views that paces are taken from. */
#define _GNU_SOURCE /* mkdtemp */
#include "context.h"
#include "fail.h"
#include "pace.h"
#include "scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound))
        fail_msg("got %.17g, expected %.17g within %g", value, expected, bound);
}

/* ---- A scene from images made here ---- */

typedef void *Load(const Options *options);

static Prewarp *load(Load *loader, const Image *colour, const Image *height, double scale) {
    char folder[] = "/tmp/texel-prewarp-XXXXXX";
    if (!mkdtemp(folder)) fail_msg("%s cannot be made", folder);
    char *paths[] = {text("%s/colour.exr", folder), text("%s/height.exr", folder)};
    image_save(colour, paths[0]);
    const char *reason = image_write_raw(height, paths[1], 32);
    if (reason) fail_msg("%s: %s", paths[1], reason);
    Prewarp *prewarp = loader(&(Options){.colour = paths[0], .height = paths[1], .scale = scale});
    for (int i = 0; i < 2; i++) remove(paths[i]), free(paths[i]);
    rmdir(folder);
    return prewarp;
}

/* Of different heights everywhere. */
static Image uneven(int width, int height) {
    Image image = image_create(width, height, 1);
    for (int i = 0; i < width * height; i++) image.pixels[i] = (float)((i * 37 % 101) / 100.0);
    return image;
}

static Image plain_colour(int width, int height, float grey) {
    Image image = image_create(width, height, 3);
    for (int i = 0; i < 3 * width * height; i++) image.pixels[i] = grey;
    return image;
}

static Prewarp *load_uneven(Load *loader, int width, int height) {
    Image colour = plain_colour(width, height, 0.5f), heights = uneven(width, height);
    Prewarp *prewarp = load(loader, &colour, &heights, 0.1);
    image_destroy(&colour);
    image_destroy(&heights);
    return prewarp;
}

/* ---- Loading ---- */

static void test_resampled(void **state) {
    (void)state;
    Image image = uneven(5, 3), same = scene_resampled(&image, 5, 3), finer = scene_resampled(&image, 10, 3);
    assert_int_equal(same.channels, 1);
    for (int i = 0; i < 15; i++) near(same.pixels[i], image.pixels[i], 1e-7);
    /* The centres of columns 4 and 5 of ten lie a quarter of a texel left and right of that of 2 of five. */
    const float *row = image_at(&image, 0, 1);
    near(*image_at(&finer, 4, 1), 0.75 * row[2] + 0.25 * row[1], 1e-6);
    near(*image_at(&finer, 5, 1), 0.75 * row[2] + 0.25 * row[3], 1e-6);
    image_destroy(&image);
    image_destroy(&same);
    image_destroy(&finer);
}

/* A source has the larger number of columns and of rows; the polygon the colour's shape. */
static void test_sizes_differ(void **state) {
    (void)state;
    Image colour = plain_colour(6, 3, 0.5f), height = uneven(4, 5);
    Prewarp *prewarp = load(scene_load, &colour, &height, 0.2);
    assert_int_equal(prewarp->source.width, 6);
    assert_int_equal(prewarp->source.height, 5);
    near(prewarp->source.aspect, 0.5, 0);
    near(prewarp->source.plane.b.y, 0.5, 0);
    near(prewarp->source.plane.origin.y, -0.25, 0);
    near(prewarp->source.scale, 0.2, 0);
    near(prewarp->source.base, 1, 0);
    near(scene_texels(prewarp).x, 4, 0);
    near(scene_texels(prewarp).y, 5, 0);
    scene_unload(prewarp);
    image_destroy(&colour);
    image_destroy(&height);
}

/* ---- The eye, and polygons ---- */

static void test_eye(void **state) {
    (void)state;
    Camera camera = {.eye = {1, 2, 5}, .target = {1, -1, 1}, .up = {0, 1, 0}, .fov_y_degrees = 40};
    Eye eye = scene_eye(&camera);
    near(eye.w, 1, 0);
    near(eye.at.z, 5, 0);
    camera.fov_y_degrees = 0, camera.height = 1;
    eye = scene_eye(&camera); /* a direction: toward the eye from the target */
    near(eye.w, 0, 0);
    near(eye.at.x, 0, 0);
    near(eye.at.y, 0.6, 1e-15);
    near(eye.at.z, 0.8, 1e-15);
}

/* The square's corner (s, t) / 2 goes to the plane's u and v. */
static void test_lay(void **state) {
    (void)state;
    Plane plane = {{1, 2, 3}, {4, 0, 0}, {0, 0, 2}, {0, 1, 0}};
    Layer layer = {0};
    layer_lay(&layer, &plane, v2(-0.5, 0), v2(1, 1.5));
    for (int corner = 0; corner < 4; corner++) {
        double s = corner & 1 ? 0.5 : -0.5, t = corner & 2 ? 0.5 : -0.5;
        double u = corner & 1 ? 1 : -0.5, v = corner & 2 ? 1.5 : 0, at[4];
        for (int k = 0; k < 4; k++) at[k] = layer.model[k] * s + layer.model[4 + k] * t + layer.model[12 + k];
        near(at[0], 1 + 4 * u, 1e-6);
        near(at[1], 2, 1e-6);
        near(at[2], 3 + 2 * v, 1e-6);
        near(at[3], 1, 0);
    }
}

/* A filter mixes texels by how much of them there is: half of one weighs half, in colour as in normal. */
static void test_layers_are_weighed(void **state) {
    (void)state;
    Destination destination = destination_create(2, 1, v2(0, 0), v2(1, 1), false);
    destination.texels[0] = (Texel){{188, 64, 0, 128}, {255, 128, 10, 0}};
    destination.texels[1] = (Texel){{188, 64, 0, 255}, {255, 128, 10, 0}};
    Layer layer = {0};
    layer_write(&layer, &destination);
    for (int c = 0; c < 3; c++) {
        uint8_t colour = destination.texels[1].colour[c], normal = destination.texels[1].normal[c];
        assert_int_equal(layer.colours[1][c], colour);
        assert_int_equal(layer.normals[1][c], 257 * normal);
        near(srgb_decode(layer.colours[0][c] / 255.0), srgb_decode(colour / 255.0) * 128 / 255, 0.004);
        near(layer.normals[0][c], 257.0 * normal * 128 / 255, 1);
    }
    assert_int_equal(layer.normals[0][3], 257 * 128);
    layer_destroy(&layer);
    destination_destroy(&destination);
}

static int layers_seen(Prewarp *prewarp, Way way, Vec3 eye, double fov_y_degrees) {
    Technique technique = {.variant = way};
    Frame frame = {.technique = &technique,
                   .data = prewarp,
                   .camera = {.eye = eye, .up = {0, 1, 0}, .fov_y_degrees = fov_y_degrees, .height = 1}};
    scene_prepare(&frame);
    return prewarp->layer_count;
}

/* Base 1: as many edges as the eye stands beyond. Base 0: all four for an eye over the polygon, and but the
 * two that are away from an eye at infinity. */
static void test_layers(void **state) {
    (void)state;
    Prewarp *top = load_uneven(scene_load_overflow, 9, 9), *bottom = load_uneven(scene_load_bottom, 9, 9);
    assert_int_equal(layers_seen(top, ORDER_LINEAR, v3(2, 2, 2), 40), 1);
    assert_int_equal(layers_seen(top, RESIZED, v3(2, 2, 2), 40), 1);
    assert_int_equal(layers_seen(top, AUXILIARY, v3(2, 2, 2), 40), 3);
    assert_int_equal(layers_seen(top, AUXILIARY, v3(2, 0.2, 2), 40), 2);
    assert_int_equal(layers_seen(top, AUXILIARY, v3(0.1, 0.2, 2), 40), 1);
    assert_int_equal(layers_seen(top, AUXILIARY, v3(2, 2, 2), 0), 3);
    assert_int_equal(layers_seen(bottom, AUXILIARY, v3(0.1, 0.2, 2), 40), 5);
    assert_int_equal(layers_seen(bottom, AUXILIARY, v3(2, 2, 2), 0), 3);
    scene_unload(top);
    scene_unload(bottom);
}

/* An eye in the polygon's plane, or behind it, sees nothing, whatever the way; one within the relief's own
 * layer of heights, and one right above the plane, see something. */
static void test_hard_eyes(void **state) {
    (void)state;
    Prewarp *top = load_uneven(scene_load, 9, 9), *bottom = load_uneven(scene_load_bottom, 9, 9);
    for (int way = DEPTH_NONE; way <= RESIZED; way++) {
        assert_int_equal(layers_seen(top, way, v3(2, 1, 0), 40), 0);
        assert_int_equal(layers_seen(top, way, v3(2, 1, 0), 0), 0);
        assert_int_equal(layers_seen(top, way, v3(0.2, 0.1, -1), 40), 0);
        assert_int_equal(layers_seen(top, way, v3(0.2, 0.1, -1), 0), 0);
        assert_true(layers_seen(top, way, v3(0.2, 0.1, 1e-6), 40) > 0);
        assert_true(layers_seen(top, way, v3(2, 0.1, 1e-6), 0) > 0);
        assert_true(layers_seen(bottom, way, v3(0.2, 0.1, 0.05), 40) > 0);
        assert_true(layers_seen(bottom, way, v3(0.5, 0, 0.05), 40) > 0); /* the epipole on an edge */
    }
    scene_unload(top);
    scene_unload(bottom);
}

static void test_thin_reliefs(void **state) {
    (void)state;
    const int sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {2, 2}};
    for (int i = 0; i < 4; i++) {
        Prewarp *prewarp = load_uneven(scene_load_overflow, sizes[i][0], sizes[i][1]);
        for (int way = DEPTH_NONE; way <= RESIZED; way++)
            assert_true(layers_seen(prewarp, way, v3(0.8, 0.9, 1), 40) > 0);
        scene_unload(prewarp);
    }
}

/* ---- The truth ---- */

/* A flat relief in the polygon: its normal is z, so that light falls alike on all of it. */
static void test_truth_is_lit(void **state) {
    (void)state;
    Image colour = plain_colour(4, 4, 0.5f), height = plain_colour(4, 4, 1.0f);
    Prewarp *prewarp = load(scene_load, &colour, &height, 0.1);
    Vec3 light = scene_light(prewarp);
    near(vec3_length(light), 1, 1e-15);
    near(light.z / hypot(light.x, light.y), 0.7, 1e-15);
    near(atan2(light.y, light.x), radians(120), 1e-15);
    double expected = 0.5 * (0.3 + 0.7 * 0.7 / sqrt(1.49));
    Sample sample = scene_truth(prewarp, (Ray){v3(0.3, 0.1, 1), v3(0, 0, -1)});
    assert_true(sample.hit);
    near(sample.colour.x, expected, 1e-9);
    scene_move(prewarp, 2.5); /* a quarter of the way around */
    near(atan2(scene_light(prewarp).y, scene_light(prewarp).x), radians(-150), 1e-12);
    scene_unload(prewarp);
    image_destroy(&colour);
    image_destroy(&height);
}

/* ---- Paces ---- */

static void test_pace_views(void **state) {
    (void)state;
    for (int i = 0; i < 100; i++) {
        Eye eye = pace_eye(i), next = pace_eye(i + 1);
        double distance = vec3_length(eye.at);
        assert_true(distance >= 1 && distance <= 3);
        assert_true(eye.at.z / distance >= cos(radians(75)));
        assert_true(vec3_length(vec3_sub(eye.at, next.at)) > 0.01);
    }
}

/* Each texel's place by the line from the eye to its displaced point, met with the plane z = 0. */
static void test_pace_table(void **state) {
    (void)state;
    Prewarp *prewarp = load_uneven(scene_load, 9, 6);
    const Source *source = &prewarp->source;
    for (int i = 0; i < 20; i++) {
        Eye eye = pace_eye(i);
        uint32_t *table = pace_table(source, eye);
        for (int y = 0; y < 6; y++)
            for (int x = 0; x < 9; x++) {
                double d = 0.1 * (source->levels[9 * y + x] / 65535.0 - 1);
                Vec3 point = v3((x + 0.5) / 9 - 0.5, ((y + 0.5) / 6 - 0.5) * source->aspect, d);
                Vec3 met = vec3_mix(eye.at, point, eye.at.z / (eye.at.z - d));
                double column = floor((met.x + 0.5) * 9), row = floor((met.y / source->aspect + 0.5) * 6);
                bool inside = column >= 0 && column < 9 && row >= 0 && row < 6;
                assert_int_equal(table[9 * y + x], inside ? (int)row * 9 + (int)column : 54);
            }
        free(table);
    }
    scene_unload(prewarp);
}

static int make_context(void **state) {
    *state = context_offscreen();
    return 0;
}

static int end_context(void **state) {
    context_destroy(*state);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_resampled),
        cmocka_unit_test(test_sizes_differ),
        cmocka_unit_test(test_eye),
        cmocka_unit_test(test_lay),
        cmocka_unit_test(test_layers_are_weighed),
        cmocka_unit_test(test_layers),
        cmocka_unit_test(test_hard_eyes),
        cmocka_unit_test(test_thin_reliefs),
        cmocka_unit_test(test_truth_is_lit),
        cmocka_unit_test(test_pace_views),
        cmocka_unit_test(test_pace_table),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson 16: the scene", tests, make_context, end_context);
}
