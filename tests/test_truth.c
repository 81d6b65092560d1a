/* The integral over a pixel, and what it says of its own error: on a scene whose answers are known. */
#include "truth.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* cmocka wants the four above before it */
#include <cmocka.h>

static const Camera camera = {.eye = {0, 0, 1}, .up = {0, 1, 0}, .height = 24, .near = 0.1, .far = 10};
enum { WIDTH = 32, HEIGHT = 24 }; /* with that camera a pixel is one unit of the world */

/* Black or white by the bits of the ray's place: every sample is a coin of its own. */
static Sample coin(const void *scene, Ray ray) {
    (void)scene;
    uint64_t bits[2];
    memcpy(bits, &ray.origin.x, 8);
    memcpy(bits + 1, &ray.origin.y, 8);
    uint64_t mixed = (bits[0] * 0x9e3779b97f4a7c15u ^ bits[1]) * 0xd6e8feb86659fd93u;
    double value = (double)(mixed >> 63);
    return (Sample){.colour = v3(value, value, value), .hit = true};
}

/* White to the right of x = 0.25, of which there is nothing to the left. */
static Sample edge(const void *scene, Ray ray) {
    (void)scene;
    return (Sample){.colour = v3(1, 1, 1), .hit = ray.origin.x > 0.25};
}

static Exact render(Sample (*sample)(const void *, Ray), int samples, PixelFilter filter) {
    Truth truth = {.sample = sample, .background = v3(0, 0, 0)};
    return truth_render(&truth, &camera, WIDTH, HEIGHT, samples, filter);
}

/* Each half of a pixel is the mean of n coins, of variance 1/4 n. The whole is off the first half by half the
 * difference of the two: by sqrt(2 / 4 n) / 2 = sqrt(1 / 8 n). */
static void rmse_is_the_change_of_doubling(void **state) {
    (void)state;
    for (int strata = 2; strata <= 6; strata += 2) {
        int n = strata * strata;
        Exact exact = render(coin, 2 * n, FILTER_BOX);
        assert_true(fabs(exact.rmse / sqrt(1.0 / (8.0 * n)) - 1.0) < 0.1);
        image_destroy(&exact.image);
    }
}

/* The edge cuts column 16, which is x of 0..1, a quarter of the way: three quarters of its square are white.
 */
static void box_is_the_mean_over_the_square(void **state) {
    (void)state;
    Exact exact = render(edge, 512, FILTER_BOX);
    for (int y = 0; y < HEIGHT; y++) {
        assert_true(image_at(&exact.image, 15, y)[0] == 0.0f && image_at(&exact.image, 17, y)[0] == 1.0f);
        assert_true(fabsf(image_at(&exact.image, 16, y)[0] - 0.75f) < 0.03f);
    }
    image_destroy(&exact.image);
}

/* The share of exp(-2 r^2), r < 1, to the right of a line at distance d: by summing small squares. */
static double gaussian_share(double d) {
    enum { STEPS = 1000 };
    double all = 0, right = 0;
    for (int j = 0; j < STEPS; j++)
        for (int i = 0; i < STEPS; i++) {
            double x = (i + 0.5) * 2 / STEPS - 1, y = (j + 0.5) * 2 / STEPS - 1, r2 = x * x + y * y;
            double weight = r2 < 1 ? exp(-2 * r2) : 0;
            all += weight;
            if (x > d) right += weight;
        }
    return right / all;
}

static void gaussian_is_its_formula(void **state) {
    (void)state;
    Exact exact = render(edge, 512, FILTER_GAUSSIAN);
    for (int x = 14; x <= 18; x++) { /* pixel 16 has its centre at 0.5 */
        double expected = gaussian_share(0.25 - (x - 16 + 0.5)), mean = 0;
        for (int y = 0; y < HEIGHT; y++) mean += image_at(&exact.image, x, y)[0] / HEIGHT;
        assert_true(fabs(mean - expected) < 0.004);
    }
    image_destroy(&exact.image);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rmse_is_the_change_of_doubling),
        cmocka_unit_test(box_is_the_mean_over_the_square),
        cmocka_unit_test(gaussian_is_its_formula),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("truth", tests, NULL, NULL);
}
