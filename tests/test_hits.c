/* Lookups against exact hits that were made by hand. */
#include "hits.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void near(double value, double expected) {
    if (!(fabs(value - expected) <= 1e-4)) fail_msg("got %.17g, expected %.17g", value, expected);
}

/* A row of n lookups at u = v = 0.5, all exactly hit there. */
static void fill(Image *lookup, Sample *exact, int n) {
    *lookup = image_create(n, 1, 4);
    for (int i = 0; i < n; i++) {
        float *found = image_at(lookup, i, 0);
        found[0] = found[1] = 0.5f;
        found[3] = 1.0f;
        exact[i] = (Sample){.u = 0.5, .v = 0.5, .hit = true};
    }
}

static void test_exact(void **state) {
    (void)state;
    Image lookup;
    Sample exact[7];
    fill(&lookup, exact, 7);
    HitErrors errors = hit_errors(&lookup, exact, v2(256, 128));
    near(errors.wrong_percent, 0);
    near(errors.p99, 0);
    image_destroy(&lookup);
}

/* Texels differ in size along u and v: 1.5 of them along v are as wrong as 1.5 along u, and 0.9 are not. */
static void test_texels(void **state) {
    (void)state;
    Image lookup;
    Sample exact[4];
    fill(&lookup, exact, 4);
    image_at(&lookup, 0, 0)[0] += 1.5f / 256;
    image_at(&lookup, 1, 0)[1] -= 1.5f / 128;
    image_at(&lookup, 2, 0)[1] += 0.9f / 128;
    HitErrors errors = hit_errors(&lookup, exact, v2(256, 128));
    near(errors.wrong_percent, 50);
    near(errors.p99, 1.5);
    image_destroy(&lookup);
}

/* A hit against a miss is wrong; misses of both, and what is unknown, are no part of the whole. */
static void test_misses(void **state) {
    (void)state;
    Image lookup;
    Sample exact[10];
    fill(&lookup, exact, 10);
    exact[0].hit = false;              /* found where nothing is */
    image_at(&lookup, 1, 0)[3] = 0.0f; /* not found */
    for (int i = 2; i < 4; i++) exact[i].hit = false, image_at(&lookup, i, 0)[3] = 0.0f;
    for (int i = 4; i < 6; i++) exact[i].unknown = true, image_at(&lookup, i, 0)[0] = 0.9f;
    HitErrors errors = hit_errors(&lookup, exact, v2(256, 128));
    near(errors.wrong_percent, 100 * 2.0 / 6);
    near(errors.p99, 0);
    image_destroy(&lookup);
}

static void test_nothing_hit(void **state) {
    (void)state;
    Image lookup = image_create(3, 1, 4);
    Sample exact[3] = {{.hit = false}};
    HitErrors errors = hit_errors(&lookup, exact, v2(256, 128));
    near(errors.wrong_percent, 0);
    near(errors.p99, 0);
    image_destroy(&lookup);
}

/* Of 200 hits with errors of 0.01, 0.02, ... 2 texels, 198 are at most 1.98. */
static void test_p99(void **state) {
    (void)state;
    Image lookup;
    Sample exact[200];
    fill(&lookup, exact, 200);
    for (int i = 0; i < 200; i++) image_at(&lookup, i, 0)[0] += 0.01f * (float)(200 - i) / 256;
    HitErrors errors = hit_errors(&lookup, exact, v2(256, 128));
    near(errors.p99, 1.98);
    image_destroy(&lookup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),       cmocka_unit_test(test_texels), cmocka_unit_test(test_misses),
        cmocka_unit_test(test_nothing_hit), cmocka_unit_test(test_p99),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("hits", tests, NULL, NULL);
}
