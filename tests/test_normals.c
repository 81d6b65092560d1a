/* Normals of height images whose slopes are known. */
#include "normals.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void expect(const float *texel, double x, double y, double z) {
    double length = sqrt(x * x + y * y + z * z);
    const double expected[] = {x / length, y / length, z / length};
    for (int i = 0; i < 3; i++)
        if (!(fabs(texel[i] - expected[i]) <= 1e-7))
            fail_msg("component %d: got %.9g, expected %.9g", i, texel[i], expected[i]);
}

static void test_flat(void **state) {
    (void)state;
    Image height = image_create(3, 2, 1), normals = height_normals(&height, 0.5, 1.0);
    assert_int_equal(normals.width, 3);
    assert_int_equal(normals.height, 2);
    assert_int_equal(normals.channels, 3);
    for (int i = 0; i < 6; i++) expect(normals.pixels + 3 * i, 0, 0, 1);
    image_destroy(&normals);
    image_destroy(&height);
}

/* A plane that rises by 1/8 a column of 8 and by 1/16 a row of 4: dh/du = 1, dh/dv = 1/4, and a texture half
 * as high as it is wide makes that 1/2 in y. Against the slope leans the normal. */
static void test_tilted_plane(void **state) {
    (void)state;
    Image height = image_create(8, 4, 1);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 8; x++) *image_at(&height, x, y) = (float)(x / 8.0 + y / 16.0);
    Image normals = height_normals(&height, 0.1, 0.5);
    for (int y = 1; y < 3; y++)
        for (int x = 1; x < 7; x++) expect(image_at(&normals, x, y), -0.1, -0.05, 1);
    image_destroy(&normals);
    image_destroy(&height);
}

/* At an edge the neighbour is the one at the other edge; other channels do not count. */
static void test_wraps(void **state) {
    (void)state;
    Image height = image_create(4, 4, 2);
    *image_at(&height, 0, 0) = 1.0f;
    *image_at(&height, 2, 2) = 0.0f, image_at(&height, 2, 2)[1] = 1.0f;
    Image normals = height_normals(&height, 0.1, 1.0);
    expect(image_at(&normals, 3, 0), -0.2, 0, 1); /* 1 from the middle to the right, 4 texels / 2 */
    expect(image_at(&normals, 1, 0), 0.2, 0, 1);
    expect(image_at(&normals, 0, 3), 0, -0.2, 1);
    expect(image_at(&normals, 0, 1), 0, 0.2, 1);
    expect(image_at(&normals, 0, 0), 0, 0, 1);
    expect(image_at(&normals, 2, 1), 0, 0, 1);
    image_destroy(&normals);
    image_destroy(&height);
}

/* A texel that is its own neighbour has no slope. */
static void test_one_texel(void **state) {
    (void)state;
    Image height = image_create(1, 1, 1);
    height.pixels[0] = 0.7f;
    Image normals = height_normals(&height, 10.0, 1.0);
    expect(normals.pixels, 0, 0, 1);
    image_destroy(&normals);
    image_destroy(&height);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_tilted_plane),
        cmocka_unit_test(test_wraps),
        cmocka_unit_test(test_one_texel),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("normals", tests, NULL, NULL);
}
