/* All who are raced make the same light field; and more rays a texel come nearer to very many. */
#include "rates.h"
#include "sampling.h"
#include "vec.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdint.h>

static const Field small = {FIELD_SPHERE, ANGLES_LINEAR, 3.5, 0, 32, 16, 33, 30};

static void all_make_the_same(void **state) {
    (void)state;
    Rates rates = rates_measure(&small, &light_composed, 1);
    assert_true(rates.brute_different <= 2e-5);
    assert_true(rates.embree_different[0] <= 2e-5);
    assert_true(rates.embree_different[1] <= 2e-4); /* silhouettes, which triangles cut */
    assert_true(rates.triangles > 30000);
    double best = 0;
    for (int i = 0; i < 2 * EMBREE_WAYS; i++) {
        double rate = rates.embree_rays_per_second[i / EMBREE_WAYS][i % EMBREE_WAYS];
        assert_true(rate > 0);
        best = rate > best ? rate : best;
    }
    /* of one round, the median of ratios is the ratio */
    assert_true(fabs(rates.embree_ratio * best / rates.rays_per_second - 1) < 1e-9);
    assert_true(fabs(rates.brute_ratio * rates.brute_rays_per_second / rates.rays_per_second - 1) < 1e-9);
}

static void more_rays_come_nearer(void **state) {
    (void)state;
    const int few[] = {1, 7, 49};
    double before = 1;
    for (int i = 0; i < 3; i++) {
        SamplingNoise noise = sampling_noise(&small, &light_composed, false, few[i], 343, 5000);
        assert_true(noise.texels >= 5000 && noise.seeing > 100 && noise.seeing < noise.texels / 2);
        assert_true(noise.linear > 0 && noise.linear < 0.7 * before);
        assert_true(noise.linear_seeing > noise.linear && noise.codes_seeing > noise.codes);
        before = noise.linear;
    }
    SamplingNoise same = sampling_noise(&small, &light_composed, false, 49, 49, 1000);
    assert_true(same.linear == 0 && same.codes == 0 && same.seeing > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_make_the_same),
        cmocka_unit_test(more_rays_come_nearer),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("rates", tests, NULL, NULL);
}
