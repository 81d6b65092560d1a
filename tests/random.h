/* What several tests need: numbers that look random and are the same in every run, and doubles compared.
 * Included behind cmocka.h. */
#ifndef TESTS_RANDOM_H
#define TESTS_RANDOM_H

#include "vec.h"

#include <stdint.h>

static uint64_t seed = 1;

static inline double random_in(double low, double high) {
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17; /* xorshift */
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

static inline Vec3 random_vector(double low, double high) {
    double x = random_in(low, high), y = random_in(low, high);
    return v3(x, y, random_in(low, high));
}

static inline Vec3 random_direction(void) {
    for (;;) {
        Vec3 v = random_vector(-1, 1);
        if (vec3_dot(v, v) < 1 && vec3_dot(v, v) > 0.01) return vec3_normalize(v);
    }
}

static inline void near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound))
        fail_msg("got %.17g, expected %.17g within %g", value, expected, bound);
}

#endif
