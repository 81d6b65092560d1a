/* Synthesis, which is fast, held against the light along each ray in doubles; the rays here are made from the
 * formulas of Gonçalves and Zuffo (Eq. 3 to 5) by themselves. Then the places of samples, and that neither
 * threads nor the width of vectors change what is made. */
#define _GNU_SOURCE /* sched_setaffinity */
#include "image.h"
#include "synthesis.h"

/* The same source once more under other names, with vectors of four, as machines without AVX2 run it. */
#define LANES 4
#define synthesis_create narrow_create
#define synthesis_destroy narrow_destroy
#define synthesis_places narrow_places
#define synthesis_rows narrow_rows
#define synthesis_block narrow_block
#define synthesis_texel narrow_texel
#include "synthesis.c"
#undef synthesis_create
#undef synthesis_destroy
#undef synthesis_places
#undef synthesis_rows
#undef synthesis_block
#undef synthesis_texel

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>

#include "random.h" /* behind cmocka.h */

/* ---- A texel by the paper ---- */

static double angle(FieldAngles angles, double x) {
    if (angles == ANGLES_SINE) return asin(2 * x - 1);
    if (angles == ANGLES_STEREOGRAPHIC) return 2 * atan(2 * x - 1);
    return radians(180 * x - 90);
}

/* Eq. 3 solved for P, Eq. 4, and Eq. 5 solved for d; the ray that comes back along d. */
static Ray ray_of(const Field *field, bool through, double u, double v, double s, double t) {
    double theta = radians(360 * u - 180), phi = radians(180 * v - 90);
    if (field->model == FIELD_CYLINDER) phi = 0;
    Vec3 normal = v3(cos(phi) * sin(theta), sin(phi), cos(phi) * cos(theta));
    Vec3 p = vec3_scale(normal, field->radius);
    if (field->model == FIELD_CYLINDER) p.y = field->height * (v - 0.5);
    if (field->model == FIELD_ROOM) normal = vec3_scale(normal, -1);
    Vec3 e_x = vec3_normalize(vec3_cross(v3(0, 1, 0), normal)), e_y = vec3_cross(normal, e_x);
    double alpha = angle(field->angles, s), beta = angle(field->angles, t);
    Vec3 level = vec3_add(vec3_scale(e_x, sin(alpha)), vec3_scale(normal, cos(alpha)));
    Vec3 d = vec3_add(vec3_scale(level, cos(beta)), vec3_scale(e_y, sin(beta)));
    return (Ray){through ? vec3_add(p, vec3_scale(d, 100)) : p, vec3_scale(d, -1)};
}

/* The light along a ray, and whether rays beside it, by what floats may be wrong, see about the same. */
static Vec3 light_back(const LightScene *scene, Ray ray, bool *stable, double *depth) {
    SolidHit hit;
    bool met;
    Vec3 light = light_along(scene, ray, &hit, &met);
    *depth = met ? hit.depth : INFINITY;
    for (int i = 0; i < 6; i++) {
        Vec3 aside = vec3_scale(v3(i % 3 == 0, i % 3 == 1, i % 3 == 2), i < 3 ? 1e-5 : -1e-5);
        Ray other = {vec3_add(ray.origin, aside), ray.direction};
        Vec3 change = vec3_sub(light_along(scene, other, &hit, &met), light);
        bool other_depth = met ? fabs(hit.depth - *depth) > 1e-3 : *depth < INFINITY;
        if (vec3_length(change) > 5e-4 || other_depth) *stable = false;
    }
    return light;
}

typedef struct {
    Field field;
    const LightScene *scene;
    int samples;
    bool through;
} Case;

/* The mean of a texel's samples; depth: of those that met anything. */
static Vec3 texel_light(const Case *one, const CellPlace *places, int u, int v, int s, int t, bool *stable,
                        double *depth) {
    const Field *field = &one->field;
    Vec3 total = {0, 0, 0};
    double depths = 0;
    int met = 0;
    *stable = true;
    for (int k = 0; k < one->samples; k++) {
        CellPlace place = places[k];
        Ray ray = ray_of(field, one->through, (u + place.u) / field->u, (v + place.v) / field->v,
                         (s + place.s) / field->s, (t + place.t) / field->t);
        double sample_depth;
        total = vec3_add(total, light_back(one->scene, ray, stable, &sample_depth));
        if (sample_depth < INFINITY) depths += sample_depth - (one->through ? 100 : 0), met++;
    }
    *depth = met ? depths / met : INFINITY;
    return vec3_scale(total, 1.0 / one->samples);
}

#define BALL(angles, u, v, s, t)                                                                             \
    { FIELD_SPHERE, angles, 3.5, 0, u, v, s, t }
static const Case cases[] = {
    {BALL(ANGLES_LINEAR, 64, 32, 32, 32), &light_composed, 1, false},
    {BALL(ANGLES_LINEAR, 10, 9, 33, 29), &light_composed, 7, false},
    {BALL(ANGLES_LINEAR, 8, 8, 8, 8), &light_composed, 49, false},
    {BALL(ANGLES_SINE, 62, 31, 31, 17), &light_composed, 1, false},
    {BALL(ANGLES_STEREOGRAPHIC, 64, 33, 17, 41), &light_composed, 3, false},
    {BALL(ANGLES_LINEAR, 1024, 512, 12, 100), &light_composed, 1, false},
    {BALL(ANGLES_LINEAR, 64, 32, 31, 32), &light_effects, 1, false},
    {BALL(ANGLES_STEREOGRAPHIC, 30, 15, 9, 23), &light_effects, 7, false},
    {BALL(ANGLES_LINEAR, 128, 64, 32, 32), &light_aliasing, 1, false},
    {BALL(ANGLES_SINE, 40, 20, 19, 20), &light_aliasing, 7, false},
    {BALL(ANGLES_LINEAR, 64, 32, 32, 30), &light_placements, 1, true},
    {BALL(ANGLES_LINEAR, 20, 10, 21, 22), &light_placements, 5, true},
    {{FIELD_CYLINDER, ANGLES_LINEAR, 3.5, 6, 48, 24, 32, 32}, &light_composed, 1, false},
    {{FIELD_CYLINDER, ANGLES_STEREOGRAPHIC, 3.5, 6, 18, 11, 15, 25}, &light_effects, 7, false},
    {{FIELD_ROOM, ANGLES_LINEAR, 3.5, 0, 48, 24, 32, 32}, &light_around, 1, false},
    {{FIELD_ROOM, ANGLES_SINE, 3.5, 0, 22, 12, 27, 14}, &light_around, 7, false},
};
enum { CASES = sizeof cases / sizeof *cases, TEXELS = 3000 };

/* An index, often the first or the last. */
static int index_below(int count) {
    double x = random_in(-0.1, 1.1);
    return x < 0 ? 0 : x >= 1 ? count - 1 : (int)(x * count);
}

/* Texels are drawn until enough of them see anything, and as many that do not are checked. */
static void texels_hold_the_light_of_their_rays(void **state) {
    (void)state;
    for (int i = 0; i < CASES; i++) {
        const Case *one = &cases[i];
        const Field *field = &one->field;
        Synthesis *synthesis = synthesis_create(field, one->scene, one->samples, one->through);
        CellPlace *places = calloc((size_t)one->samples, sizeof *places);
        synthesis_places(one->samples, places);
        int wanted = TEXELS / one->samples + 100, seen = 0, unseen = 0, unstable = 0;
        for (long n = 0; seen < wanted; n++) {
            assert_true(n < 2000000);
            int u = index_below(field->u), v = index_below(field->v), s = index_below(field->s),
                t = index_below(field->t);
            bool stable;
            double depth;
            Vec3 light = texel_light(one, places, u, v, s, t, &stable, &depth);
            if (depth == INFINITY && unseen++ > wanted) continue;
            seen += depth < INFINITY;
            if (!stable) {
                unstable++;
                continue;
            }
            float made[3];
            synthesis_texel(synthesis, u, v, s, t, made);
            const double expected[3] = {light.x, light.y, light.z};
            for (int k = 0; k < 3; k++)
                if (!(fabs(made[k] - expected[k]) <= 5e-4))
                    fail_msg("case %d, texel %d %d %d %d, channel %d: %.9g, not %.9g", i, u, v, s, t, k,
                             made[k], expected[k]);
        }
        assert_true(unstable < wanted / 4);
        free(places);
        synthesis_destroy(synthesis);
    }
}

/* Rays that floats tell little of: one along a cylinder's axis, beside it, to the ball behind; and, of a box,
 * a side that the light passes along, where rounding must not begin a highlight. */
static void rounding_shows_nothing(void **state) {
    (void)state;
    const Field field = BALL(ANGLES_LINEAR, 64, 32, 31, 32);
    float light[3];
    for (int effects = 0; effects < 2; effects++) {
        Synthesis *synthesis = synthesis_create(&field, effects ? &light_effects : &light_composed, 1, false);
        synthesis_texel(synthesis, 23, 31, 15, 16, light);
        for (int k = 0; k < 3; k++) near(light[k], effects ? 0.06 : 0.15, 1e-6);
        synthesis_destroy(synthesis);
    }
    const Field other = BALL(ANGLES_LINEAR, 128, 64, 32, 32);
    Synthesis *synthesis = synthesis_create(&other, &light_composed, 1, false);
    synthesis_texel(synthesis, 37, 14, 13, 21, light); /* the top of the yellow box */
    const double yellow[3] = {0.15, 0.15, 0};
    for (int k = 0; k < 3; k++) near(light[k], yellow[k], 1e-6);
    synthesis_destroy(synthesis);
}

/* All bytes and depths of rows in the middle and at both ends. */
static void rows_are_texels(void **state) {
    (void)state;
    for (int i = 0; i < CASES; i++) {
        Case one = cases[i];
        Field *field = &one.field;
        if (field->u > 128) field->u = 34;
        Synthesis *synthesis = synthesis_create(field, one.scene, one.samples, one.through);
        CellPlace *places = calloc((size_t)one.samples, sizeof *places);
        synthesis_places(one.samples, places);
        size_t count = field_bytes(field) / FIELD_TEXEL;
        uint8_t *texels = malloc(field_bytes(field)), *part = malloc(2 * field_row(field));
        float *depths = malloc(count * sizeof *depths),
              *block = malloc(3 * field_block(field) * sizeof *block);
        memset(texels, 0xab, field_bytes(field));
        synthesis_rows(synthesis, 0, field->v, texels, depths);
        synthesis_rows(synthesis, field->v - 2, 2, part, NULL);
        assert_memory_equal(part, texels + (size_t)(field->v - 2) * field_row(field), 2 * field_row(field));
        int seen = 0, first_v = field->v / 2;
        for (int n = 0; n < 60000 && seen < 200; n++) {
            int u = index_below(field->u), v = index_below(field->v), s = index_below(field->s),
                t = index_below(field->t);
            bool stable;
            double depth;
            Vec3 light = texel_light(&one, places, u, v, s, t, &stable, &depth);
            seen += depth < INFINITY;
            size_t at = (((size_t)v * (size_t)field->u + (size_t)u) * (size_t)field->t + (size_t)t) *
                            (size_t)field->s +
                        (size_t)s;
            if (!stable) continue;
            const double expected[3] = {light.x, light.y, light.z};
            for (int k = 0; k < 3; k++) near(texels[3 * at + (size_t)k], 255 * srgb_encode(expected[k]), 1.6);
            assert_true((depths[at] < INFINITY) == (depth < INFINITY));
            if (depth == INFINITY) continue;
            near(depths[at], depth, 2e-3);
        }
        assert_true(seen > 20);
        synthesis_block(synthesis, 1, first_v, block);
        const uint8_t *bytes = texels + (size_t)first_v * field_row(field) + field_block(field);
        for (size_t k = 0; k < field_block(field); k++) near(bytes[k], srgb_byte(block[k]), 1);
        free(texels), free(part), free(depths), free(block), free(places);
        synthesis_destroy(synthesis);
    }
}

/* ---- Samples ---- */

static void compare_sets(int samples, bool exactly_spread) {
    CellPlace *places = calloc((size_t)samples, sizeof *places);
    synthesis_places(samples, places);
    double mean[4] = {0};
    int *bins = calloc(4 * (size_t)samples, sizeof *bins);
    for (int i = 0; i < samples; i++) {
        const double x[4] = {places[i].u, places[i].v, places[i].s, places[i].t};
        for (int k = 0; k < 4; k++) {
            assert_true(x[k] >= 0 && x[k] < 1);
            mean[k] += x[k] / samples;
            bins[k * samples + (int)(x[k] * samples)]++;
        }
    }
    for (int k = 0; k < 4; k++) near(mean[k], 0.5, samples % 2 ? 1e-12 : 0.5 / samples + 1e-12);
    for (int i = 0; exactly_spread && i < 4 * samples; i++) assert_int_equal(bins[i], 1);
    free(places), free(bins);
}

static void samples_are_spread_along_each_axis(void **state) {
    (void)state;
    const int counts[] = {1, 2, 3, 4, 5, 7, 8, 16, 49, 81, 343, 1000, 2401, SAMPLES_MOST};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) compare_sets(counts[i], true);
    CellPlace one;
    synthesis_places(1, &one);
    near(one.u, 0.5, 0), near(one.v, 0.5, 0), near(one.s, 0.5, 0), near(one.t, 0.5, 0);
}

/* The centred discrepancy (F. Hickernell 1998), in its L2 form: how far the share of samples in boxes at the
 * corners of the cell is from the boxes' volumes. */
static double discrepancy(int count, const CellPlace *places) {
    double sum = pow(13.0 / 12.0, 4);
    for (int i = 0; i < count; i++) {
        const double x[4] = {places[i].u, places[i].v, places[i].s, places[i].t};
        double one = 1;
        for (int k = 0; k < 4; k++) {
            double a = fabs(x[k] - 0.5);
            one *= 1 + 0.5 * a - 0.5 * a * a;
        }
        sum -= 2 * one / count;
        for (int j = 0; j < count; j++) {
            const double y[4] = {places[j].u, places[j].v, places[j].s, places[j].t};
            double both = 1;
            for (int k = 0; k < 4; k++)
                both *= 1 + 0.5 * fabs(x[k] - 0.5) + 0.5 * fabs(y[k] - 0.5) - 0.5 * fabs(x[k] - y[k]);
            sum += both / ((double)count * count);
        }
    }
    return sqrt(sum);
}

static void samples_fill_the_cell_better_than_random_ones(void **state) {
    (void)state;
    const int counts[] = {7, 16, 49, 343};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        int count = counts[i];
        CellPlace *places = calloc((size_t)count, sizeof *places),
                  *random = calloc((size_t)count, sizeof *random);
        synthesis_places(count, places);
        double ours = discrepancy(count, places), theirs = 0;
        for (int k = 0; k < 20; k++) {
            for (int j = 0; j < count; j++)
                random[j] = (CellPlace){random_in(0, 1), random_in(0, 1), random_in(0, 1), random_in(0, 1)};
            theirs += discrepancy(count, random) / 20;
        }
        if (!(ours < theirs * 0.7))
            fail_msg("%d samples: discrepancy %g, random ones %g", count, ours, theirs);
        free(places), free(random);
    }
}

/* ---- Threads, and the width of vectors: the same source with four lanes, as machines without AVX2 run it
 * ---- */

static void nothing_depends_on_threads(void **state) {
    (void)state;
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int i = 0; CPU_COUNT(&one) == 0; i++)
        if (CPU_ISSET(i, &all)) CPU_SET(i, &one);
    for (int i = 0; i < CASES; i++) {
        Field field = cases[i].field;
        if (field.u > 128) field.u = 128, field.v = 64;
        Synthesis *synthesis = synthesis_create(&field, cases[i].scene, cases[i].samples, cases[i].through);
        uint8_t *many = malloc(field_bytes(&field)), *single = malloc(field_bytes(&field));
        memset(many, 1, field_bytes(&field)), memset(single, 2, field_bytes(&field));
        synthesis_rows(synthesis, 0, field.v, many, NULL);
        assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
        synthesis_rows(synthesis, 0, field.v, single, NULL);
        assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
        assert_memory_equal(many, single, field_bytes(&field));
        free(many), free(single);
        synthesis_destroy(synthesis);
    }
}

static void nothing_depends_on_lanes(void **state) {
    (void)state;
    for (int i = 0; i < CASES; i++) {
        Field field = cases[i].field;
        if (field.u > 128) field.u = 128, field.v = 64;
        const Case *from = &cases[i];
        Synthesis *wide = synthesis_create(&field, from->scene, from->samples, from->through);
        struct Synthesis *narrow = narrow_create(&field, from->scene, from->samples, from->through);
        size_t bytes = field_bytes(&field), different = 0;
        uint8_t *a = malloc(bytes), *b = malloc(bytes);
        synthesis_rows(wide, 0, field.v, a, NULL);
        narrow_rows(narrow, 0, field.v, b, NULL);
        for (size_t k = 0; k < bytes; k++) different += abs(a[k] - b[k]) > 1;
        if (different) fail_msg("case %d: %zu of %zu bytes differ", i, different, bytes);
        free(a), free(b);
        synthesis_destroy(wide), narrow_destroy(narrow);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_hold_the_light_of_their_rays),
        cmocka_unit_test(rounding_shows_nothing),
        cmocka_unit_test(rows_are_texels),
        cmocka_unit_test(samples_are_spread_along_each_axis),
        cmocka_unit_test(samples_fill_the_cell_better_than_random_ones),
        cmocka_unit_test(nothing_depends_on_threads),
        cmocka_unit_test(nothing_depends_on_lanes),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("synthesis", tests, NULL, NULL);
}
