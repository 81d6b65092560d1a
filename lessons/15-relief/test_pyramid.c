/* The corners and the pyramid against the image itself: each maximum is reached within its block and nowhere
 * exceeded, for sizes that are neither square nor powers of two, and across the border. */
#include "pyramid.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdint.h>
#include <stdlib.h>

static uint64_t seed = 1;

static double random_in(double low, double high) {
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17; /* xorshift */
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

static Image random_map(int width, int height) {
    Image image = image_create(width, height, 1);
    for (int i = 0; i < width * height; i++) image.pixels[i] = (float)random_in(0, 1);
    return image;
}

static const int sizes[][2] = {{1, 1}, {1, 7}, {9, 1}, {2, 2}, {5, 3}, {8, 8}, {13, 16}, {33, 20}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static int smaller(int a, int b) { return a < b ? a : b; }

static void test_corners(void **state) {
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        Image map = random_map(sizes[s][0], sizes[s][1]), corners = corners_build(&map);
        assert_int_equal(corners.width, map.width);
        assert_int_equal(corners.height, map.height);
        for (int y = 0; y < map.height; y++)
            for (int x = 0; x < map.width; x++)
                for (int k = 0; k < 4; k++) {
                    double h;
                    image_sample(&map, (x + k % 2 + 0.5) / map.width, (y + k / 2 + 0.5) / map.height, &h);
                    assert_true(fabs(image_at(&corners, x, y)[k] - h) < 1e-12);
                }
        image_destroy(&corners);
        image_destroy(&map);
    }
}

/* The largest texel that is a corner of a cell in columns x0..x1-1 and rows y0..y1-1. */
static float highest_in(const Image *map, int x0, int x1, int y0, int y1) {
    float highest = 0.0f;
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            float h = *image_at(map, x % map->width, y % map->height);
            if (h > highest) highest = h;
        }
    return highest;
}

static void test_blocks(void **state) {
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        Image map = random_map(sizes[s][0], sizes[s][1]);
        Pyramid pyramid = pyramid_build(&map);
        for (int k = 0; k < pyramid.count; k++)
            for (int y = 0; y << k < map.height; y++)
                for (int x = 0; x << k < map.width; x++) {
                    int x1 = smaller((x + 1) << k, map.width), y1 = smaller((y + 1) << k, map.height);
                    float highest = highest_in(&map, x << k, x1, y << k, y1);
                    assert_true(*image_at(&pyramid.levels[k], x, y) == highest);
                }
        pyramid_destroy(&pyramid);
        image_destroy(&map);
    }
}

/* No point of the surface rises above any of the blocks that it lies in. */
static void test_nothing_rises_above(void **state) {
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        Image map = random_map(sizes[s][0], sizes[s][1]);
        Pyramid pyramid = pyramid_build(&map);
        for (int i = 0; i < 2000; i++) {
            double x = random_in(0, map.width), y = random_in(0, map.height), h;
            image_sample(&map, (x + 0.5) / map.width, (y + 0.5) / map.height, &h);
            for (int k = 0; k < pyramid.count; k++)
                assert_true(h <= *image_at(&pyramid.levels[k], (int)x >> k, (int)y >> k) + 1e-12);
        }
        pyramid_destroy(&pyramid);
        image_destroy(&map);
    }
}

static void test_levels_are_a_mip_chain(void **state) {
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        Image map = random_map(sizes[s][0], sizes[s][1]);
        Pyramid pyramid = pyramid_build(&map);
        const Image *levels = pyramid.levels, *last = &levels[pyramid.count - 1];
        assert_true(levels->width >= map.width && levels->width < 2 * map.width);
        assert_true(levels->height >= map.height && levels->height < 2 * map.height);
        for (int k = 0; k + 1 < pyramid.count; k++) {
            assert_int_equal(levels[k + 1].width, levels[k].width > 1 ? levels[k].width / 2 : 1);
            assert_int_equal(levels[k + 1].height, levels[k].height > 1 ? levels[k].height / 2 : 1);
        }
        assert_true(last->width == 1 && last->height == 1);
        assert_true(*image_at(last, 0, 0) == highest_in(&map, 0, map.width, 0, map.height));
        pyramid_destroy(&pyramid);
        image_destroy(&map);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_corners),
        cmocka_unit_test(test_blocks),
        cmocka_unit_test(test_nothing_rises_above),
        cmocka_unit_test(test_levels_are_a_mip_chain),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("the maximum mip pyramid", tests, NULL, NULL);
}
