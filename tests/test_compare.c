/* The error of one image against another: numbers that can be worked out by hand, and FLIP against the values
 * of its authors' own program. */
#include "compare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static Image filled(int width, int height, int channels, float value) {
    Image image = image_create(width, height, channels);
    for (int i = 0; i < width * height * channels; i++) image.pixels[i] = value;
    return image;
}

static Image noise(int width, int height, int channels, uint32_t seed) {
    Image image = image_create(width, height, channels);
    for (int i = 0; i < width * height * channels; i++) {
        seed = seed * 1664525 + 1013904223;
        image.pixels[i] = (float)(seed >> 8) / (1 << 24);
    }
    return image;
}

static Difference difference_of(const Image *test, const Image *reference) {
    Difference difference = {NAN, NAN, NAN, NAN};
    Image map;
    const char *reason = compare(test, reference, &difference, &map);
    if (reason) fail_msg("%s", reason);
    image_destroy(&map);
    return difference;
}

static double flip_images(const Image *test, const Image *reference, Image *map) {
    Seen seen_test = seen_create(test), seen_reference = seen_create(reference);
    double error = flip(&seen_test, &seen_reference, map);
    seen_destroy(&seen_test);
    seen_destroy(&seen_reference);
    return error;
}

/* ---- Failures, with their place ------------------------------------------------------------------------ */

static void assert_refused(const Image *test, const Image *reference, const char *reason) {
    Difference difference = {1, 2, 3, 4};
    Image map = {.width = 5};
    const char *said = compare(test, reference, &difference, &map);
    assert_non_null(said);
    assert_string_equal(said, reason);
    assert_true(difference.rmse == 1 && difference.psnr_db == 2 && difference.flip == 3);
    assert_true(difference.max_abs == 4 && map.width == 5 && !map.pixels);
}

static void refuses_another_shape(void **state) {
    (void)state;
    Image a = filled(4, 3, 3, 0), b = filled(3, 4, 3, 0), grey = filled(4, 3, 1, 0),
          four = filled(4, 3, 4, 0);
    assert_refused(&a, &b, "another size: 4x3 pixels against the reference's 3x4");
    assert_refused(&grey, &a, "another number of channels: 1 against the reference's 3");
    assert_refused(&four, &grey, "another number of channels: 4 against the reference's 1");
    image_at(&four, 1, 1)[3] = NAN; /* a fourth channel is ignored */
    assert_true(difference_of(&four, &a).rmse == 0);
    assert_true(difference_of(&a, &four).rmse == 0);
    image_destroy(&a);
    image_destroy(&b);
    image_destroy(&grey);
    image_destroy(&four);
}

static void refuses_what_is_not_finite(void **state) {
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++)
        for (int channels = 1; channels <= 3; channels += 2) {
            Image good = filled(5, 4, channels, 0.5f), broken = filled(5, 4, channels, 0.5f);
            image_at(&broken, 3, 2)[channels - 1] = bad[i];
            image_at(&broken, 1, 3)[0] = bad[i]; /* only the first one is named */
            assert_refused(&broken, &good, "the test is not finite at column 3, row 2 from the bottom");
            assert_refused(&good, &broken, "the reference is not finite at column 3, row 2 from the bottom");
            assert_refused(&broken, &broken, "the test is not finite at column 3, row 2 from the bottom");
            image_destroy(&good);
            image_destroy(&broken);
        }
}

/* ---- Numbers by hand ----------------------------------------------------------------------------------- */

static void identical_images_do_not_differ(void **state) {
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        Image a = noise(40, 30, channels, 1);
        a.pixels[0] = 1e6f; /* high dynamic range is no failure */
        a.pixels[1] = -5;
        Image map;
        Difference d;
        assert_null(compare(&a, &a, &d, &map));
        assert_true(d.rmse == 0 && d.psnr_db == 100 && d.flip == 0 && d.max_abs == 0);
        for (int i = 0; i < 40 * 30; i++) assert_true(map.pixels[i] == 0);
        image_destroy(&map);
        image_destroy(&a);
    }
}

static void one_wrong_channel(void **state) {
    (void)state;
    Image reference = filled(20, 10, 3, 0.25f), test = filled(20, 10, 3, 0.25f);
    image_at(&test, 7, 3)[1] = 0.75f;
    Difference d = difference_of(&test, &reference);
    assert_float_equal(d.rmse, 0.5 / sqrt(600), 1e-12);
    assert_true(d.max_abs == 0.5);
    double step = srgb_encode(0.75) - srgb_encode(0.25);
    assert_float_equal(d.psnr_db, 10 * log10(600 / (step * step)), 1e-4);
    assert_true(d.flip > 0);
    Difference back = difference_of(&reference, &test); /* every measure here is symmetric */
    assert_memory_equal(&d, &back, sizeof d);
    image_destroy(&reference);
    image_destroy(&test);
}

static void psnr_is_clipped_and_rmse_is_not(void **state) {
    (void)state;
    Image white = filled(8, 8, 3, 1), bright = filled(8, 8, 3, 3), grey = filled(8, 8, 1, 0);
    Difference d = difference_of(&bright, &white);
    assert_true(d.rmse == 2 && d.max_abs == 2 && d.psnr_db == 100 && d.flip == 0);
    Image below = filled(8, 8, 1, -0.5f);
    d = difference_of(&below, &grey);
    assert_true(d.rmse == 0.5 && d.max_abs == 0.5 && d.psnr_db == 100 && d.flip == 0);
    Image near = filled(8, 8, 1, 1e-9f); /* 12.92e-9 of white: 157.8 dB, more than is told apart from none */
    assert_true(difference_of(&near, &grey).psnr_db == 100);
    Image dark = filled(8, 8, 1, 0.001f);
    assert_float_equal(difference_of(&dark, &grey).psnr_db, -20 * log10(0.01292), 1e-4);
    image_destroy(&white);
    image_destroy(&bright);
    image_destroy(&grey);
    image_destroy(&below);
    image_destroy(&near);
    image_destroy(&dark);
}

/* ---- FLIP ---------------------------------------------------------------------------------------------- */

static Image load_pair(char name, const char *which) {
    char path[512]; /* the pictures lie beside this file */
    snprintf(path, sizeof path, "%.*s/flip/%c-%s.png", (int)(strrchr(__FILE__, '/') - __FILE__), __FILE__,
             name, which);
    return image_load(path, IMAGE_COLOUR);
}

/* A noisy gradient; a floor, point sampled against area averaged; disks shifted by two pixels and turned in
 * hue. What the authors' LDR-FLIP 1.6 says of them at 67.02 pixels a degree: */
static const struct {
    char name;
    double mean, least, most;
} pairs[] = {
    {'a', 0.089634, 0.005912, 0.311575},
    {'b', 0.155867, 0.000000, 0.888159},
    {'c', 0.167479, 0.031015, 0.973559},
};

static void flip_is_the_authors(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        Image test = load_pair(pairs[i].name, "test"), reference = load_pair(pairs[i].name, "reference"), map;
        Difference d;
        assert_null(compare(&test, &reference, &d, &map));
        int count = map.width * map.height;
        double least = 1, most = 0, mean = 0;
        for (int k = 0; k < count; k++) {
            least = fmin(least, map.pixels[k]);
            most = fmax(most, map.pixels[k]);
            mean += map.pixels[k] / count;
        }
        assert_int_equal(map.channels, 1);
        assert_float_equal(d.flip, pairs[i].mean, 1e-4);
        assert_float_equal(d.flip, mean, 1e-6);
        assert_float_equal(least, pairs[i].least, 1e-5);
        assert_float_equal(most, pairs[i].most, 1e-5);
        image_destroy(&test);
        image_destroy(&reference);
        image_destroy(&map);
    }
}

/* Pairs of plain colours have no features: the error is the colours' alone, everywhere. */
static void flip_of_plain_colours(void **state) {
    (void)state;
    Image black = filled(30, 20, 3, 0), white = filled(30, 20, 3, 1), map;
    double error = flip_images(&white, &black, &map);
    assert_in_range((int)(error * 1000), 900, 1000);
    for (int i = 0; i < 600; i++) assert_float_equal(map.pixels[i], error, 1e-6);
    image_destroy(&map);

    Image blacker = filled(30, 20, 1, 0), whiter = filled(30, 20, 1, 1); /* grey is the same as three equal */
    assert_true(flip_images(&whiter, &blacker, &map) == error);
    image_destroy(&map);

    for (int a = 0; a < 8; a++) /* no pair of a screen's corners is worse than green and blue, which is 1 */
        for (int b = 0; b < 8; b++) {
            for (int i = 0; i < 600; i++)
                for (int c = 0; c < 3; c++) {
                    black.pixels[3 * i + c] = (float)(a >> c & 1);
                    white.pixels[3 * i + c] = (float)(b >> c & 1);
                }
            double pair = flip_images(&white, &black, &map);
            assert_true(pair <= 1 + 1e-6);
            if (a == 2 && b == 4) assert_float_equal(pair, 1, 1e-6);
            image_destroy(&map);
        }
    image_destroy(&black);
    image_destroy(&white);
    image_destroy(&blacker);
    image_destroy(&whiter);
}

/* Sizes below the filters' 21 taps, and not a multiple of anything. Mirrored images have mirrored errors. */
static void flip_of_any_size(void **state) {
    (void)state;
    const int sizes[][2] = {{1, 1}, {1, 7}, {16, 1}, {17, 3}, {33, 40}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        int width = sizes[i][0], height = sizes[i][1];
        Image a = noise(width, height, 3, 1), b = noise(width, height, 3, 2), map, turned;
        Image a_turned = image_create(width, height, 3), b_turned = image_create(width, height, 3);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                int to_x = width - 1 - x, to_y = height - 1 - y;
                memcpy(image_at(&a_turned, to_x, to_y), image_at(&a, x, y), 3 * sizeof(float));
                memcpy(image_at(&b_turned, to_x, to_y), image_at(&b, x, y), 3 * sizeof(float));
            }
        flip_images(&a, &b, &map);
        flip_images(&a_turned, &b_turned, &turned);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                float error = image_at(&map, x, y)[0];
                assert_true(error >= 0 && error <= 1 + 1e-6f);
                assert_float_equal(image_at(&turned, width - 1 - x, height - 1 - y)[0], error, 1e-4);
            }
        image_destroy(&map);
        image_destroy(&turned);
        image_destroy(&a);
        image_destroy(&b);
        image_destroy(&a_turned);
        image_destroy(&b_turned);
    }
}

/* compare hands FLIP what an 8-bit file would keep: less than half a code is no difference. */
static void flip_sees_bytes(void **state) {
    (void)state;
    Image a = filled(10, 10, 3, (float)srgb_decode(100 / 255.0)), b = filled(10, 10, 3, 0);
    for (int i = 0; i < 300; i++) b.pixels[i] = (float)srgb_decode(100.4 / 255.0);
    assert_true(difference_of(&a, &b).flip == 0);
    for (int i = 0; i < 300; i++) b.pixels[i] = (float)srgb_decode(100.6 / 255.0);
    double code = difference_of(&a, &b).flip;
    for (int i = 0; i < 300; i++) b.pixels[i] = (float)srgb_decode(101 / 255.0);
    assert_true(code > 0 && difference_of(&a, &b).flip == code);
    image_destroy(&a);
    image_destroy(&b);
}

static void heat_grows_lighter(void **state) {
    (void)state;
    Image map = image_create(1001, 1, 1);
    for (int i = 0; i <= 1000; i++) map.pixels[i] = (float)i / 1000;
    Image heat = compare_heat(&map);
    assert_int_equal(heat.channels, 3);
    double before = -1;
    for (int i = 0; i <= 1000; i++) {
        const float *p = image_at(&heat, i, 0);
        double luminance = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
        assert_true(luminance > before);
        before = luminance;
    }
    for (int c = 0; c < 3; c++) {
        assert_true(image_at(&heat, 0, 0)[c] == 0);
        assert_float_equal(image_at(&heat, 1000, 0)[c], 1, 1e-6);
    }
    image_destroy(&heat);
    image_destroy(&map);
}

int main(void) {
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refuses_another_shape),
        cmocka_unit_test(refuses_what_is_not_finite),
        cmocka_unit_test(identical_images_do_not_differ),
        cmocka_unit_test(one_wrong_channel),
        cmocka_unit_test(psnr_is_clipped_and_rmse_is_not),
        cmocka_unit_test(flip_is_the_authors),
        cmocka_unit_test(flip_of_plain_colours),
        cmocka_unit_test(flip_of_any_size),
        cmocka_unit_test(flip_sees_bytes),
        cmocka_unit_test(heat_grows_lighter),
    };
    return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
