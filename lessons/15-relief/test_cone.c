/* Cones against the surface: nothing of it rises above one, wherever in its cell the cone stands, and none is
 * much wider open than what a brute search finds that it must be. */
#include "cone.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdint.h>

static uint64_t seed = 1;

static double random_in(double low, double high) {
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17; /* xorshift */
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

/* Texel centres at whole numbers. */
static double surface(const Image *map, double x, double y) {
    double h;
    image_sample(map, (x + 0.5) / map->width, (y + 0.5) / map->height, &h);
    return h;
}

typedef double Field(int x, int y);

static double rough(int x, int y) {
    (void)x, (void)y;
    return random_in(0, 1);
}
static double pins(int x, int y) {
    (void)x, (void)y;
    return random_in(0, 1) < 0.03;
}
static double waves(int x, int y) { return 0.5 + 0.25 * sin(0.7 * x) + 0.25 * cos(0.4 * x + 0.5 * y); }
static double steps(int x, int y) { return x / 4 % 2 + y / 5 % 2 == 1 ? 0.9 : 0.2; }

static Image map_of(Field *field, int width, int height) {
    Image map = image_create(width, height, 1);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) *image_at(&map, x, y) = (float)field(x, y);
    return map;
}

static Field *const fields[] = {rough, pins, waves, steps};
static const int sizes[][2] = {{24, 17}, {32, 32}, {1, 9}, {5, 2}, {1, 1}};
enum { FIELDS = sizeof fields / sizeof *fields, SIZES = sizeof sizes / sizeof *sizes };

/* Along a line from p in the cell (x, y) the surface stays below the cone: at places close together, and
 * where the line crosses from one cell into the next, for there its bends are. */
static void check_line(const Image *map, double m, double px, double py) {
    double angle = random_in(0, 2 * PI), dx = cos(angle), dy = sin(angle), h = surface(map, px, py);
    for (int i = 1; i < 400; i++) {
        double along_x = (floor(px) + (dx > 0 ? i : 1 - i) - px) / dx;
        double along_y = (floor(py) + (dy > 0 ? i : 1 - i) - py) / dy;
        const double places[] = {0.11 * i, along_x, along_y};
        for (int k = 0; k < 3; k++) {
            double r = places[k];
            if (!(r < 44.0)) continue;
            double rise = surface(map, px + r * dx, py + r * dy) - h;
            if (rise > m * r + 1e-9)
                fail_msg("at distance %g the surface is %g above a cone of %g", r, rise, m);
        }
    }
}

static void test_nothing_rises_above_a_cone(void **state) {
    (void)state;
    for (int f = 0; f < FIELDS; f++)
        for (int s = 0; s < SIZES; s++) {
            Image map = map_of(fields[f], sizes[s][0], sizes[s][1]), cones = cone_build(&map);
            for (int i = 0; i < 4000; i++) {
                int x = (int)random_in(0, map.width), y = (int)random_in(0, map.height);
                double m = *image_at(&cones, x, y);
                check_line(&map, m, x + random_in(0, 1), y + random_in(0, 1));
            }
            image_destroy(&cones);
            image_destroy(&map);
        }
}

/* A pin, and ground that rises a little: the steepest way to the pin's top begins between two texels, whence
 * it is shorter than from the lower of them and rises more than from the higher. A slope that was enough for
 * the texels would be 1 % too little. */
static void test_between_texels(void **state) {
    (void)state;
    Image map = image_create(12, 12, 1);
    *image_at(&map, 5, 5) = 1.0f;
    *image_at(&map, 8, 5) = *image_at(&map, 9, 5) = 0.055f;
    Image cones = cone_build(&map);
    double m = *image_at(&cones, 8, 4), to_texels = fmax(1.0 / sqrt(10.0), (1.0 - 0.055) / 3.0);
    double needed = (1.0 - surface(&map, 8.0, 4.5)) / sqrt(9.25);
    assert_true(needed > 1.01 * to_texels);
    assert_true(m >= needed);
    image_destroy(&cones);
    image_destroy(&map);
}

/* A pin, and behind it, but in another direction, one that needs a slope 1 % steeper: so little that all of
 * its block is granted what it can need at most, unseen. */
static void test_what_is_granted_unseen(void **state) {
    (void)state;
    Image map = image_create(128, 128, 1);
    *image_at(&map, 19, 10) = 0.2f;
    *image_at(&map, 10, 41) = 0.76523f;
    Image cones = cone_build(&map);
    double m = *image_at(&cones, 10, 10), needed = *image_at(&map, 10, 41) / 30.0;
    assert_true(needed >
                1.005 * (0.2 / 8.0) * (1.0 + 0.5 / 49.0)); /* what the near pin may be found to need */
    assert_true(m >= needed && m < 1.1 * needed);
    image_destroy(&cones);
    image_destroy(&map);
}

/* The steepest way up from a point, over all texels and the middles between them. */
static double steepest_from(const Image *map, double px, double py) {
    double steepest = 0.0, h = surface(map, px, py);
    for (double y = py - map->height; y <= py + map->height; y += 0.5)
        for (double x = px - map->width; x <= px + map->width; x += 0.5)
            if (x != px || y != py)
                steepest = fmax(steepest, (surface(map, x, y) - h) / hypot(x - px, y - py));
    return steepest;
}

static double steepest_from_cell(const Image *map, int x, int y) {
    double steepest = 0.0;
    for (int k = 0; k < 9; k++)
        steepest = fmax(steepest, steepest_from(map, x + 0.5 * (k % 3), y + 0.5 * (k / 3)));
    return steepest;
}

/* Over all cells the slopes are at most `excess` more than what is needed. */
static void check_excess(Field *field, double excess) {
    Image map = map_of(field, 24, 17), cones = cone_build(&map);
    double sum = 0.0, needed = 0.0;
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            double m = *image_at(&cones, x, y), steepest = steepest_from_cell(&map, x, y);
            assert_true(m >= steepest - 1e-9);
            sum += m, needed += steepest;
        }
    if (!(sum <= (1.0 + excess) * needed)) fail_msg("%.3f of what is needed", sum / needed);
    image_destroy(&cones);
    image_destroy(&map);
}

static void test_cones_are_hardly_too_wide(void **state) {
    (void)state;
    check_excess(rough, 0.45);
    check_excess(waves, 0.25);
    check_excess(steps, 0.55);
    check_excess(pins, 0.5);
}

/* No slope at all on a flat map; a ramp's own on a ramp (but at its seam); a peak's foot needs the peak's
 * slope. */
static void test_known_cones(void **state) {
    (void)state;
    Image flat = image_create(7, 5, 1), cones = cone_build(&flat);
    for (int i = 0; i < 35; i++) assert_true(cones.pixels[i] < 1e-30);
    image_destroy(&cones);
    *image_at(&flat, 3, 2) = 1.0f;
    cones = cone_build(&flat);
    assert_true(fabs(*image_at(&cones, 3, 2) - sqrt(2.0)) < 1e-6);
    image_destroy(&cones);
    image_destroy(&flat);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_rises_above_a_cone),
        cmocka_unit_test(test_between_texels),
        cmocka_unit_test(test_what_is_granted_unseen),
        cmocka_unit_test(test_cones_are_hardly_too_wide),
        cmocka_unit_test(test_known_cones),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("the cone map", tests, NULL, NULL);
}
