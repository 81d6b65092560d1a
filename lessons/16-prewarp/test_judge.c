/* The judge, on warps whose faults are known: by hand, or because the test made them. */
#include "forward.h"
#include "inverse.h"
#include "judge.h"
#include "overflow.h"
#include "two_pass.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound))
        fail_msg("got %.17g, expected %.17g within %g", value, expected, bound);
}

/* Heights by a formula, colours that differ from texel to texel. */
static Source relief_new(double (*height)(double u, double v), int side, double scale, double base) {
    Image colour = image_create(side, side, 3), heights = image_create(side, side, 1);
    Image normals = image_create(side, side, 3);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            *image_at(&heights, x, y) = (float)height((x + 0.5) / side, (y + 0.5) / side);
            for (int c = 0; c < 3; c++)
                image_at(&colour, x, y)[c] = (float)(x * 7 + y * 11 + c) / (20 * side);
        }
    Source source = source_create(&colour, &heights, &normals, scale, base);
    image_destroy(&colour);
    image_destroy(&heights);
    image_destroy(&normals);
    return source;
}

static double sunk(double u, double v) { return 0 * u * v; }
static double waves(double u, double v) { return 0.5 + 0.3 * sin(2 * PI * u) + 0.2 * cos(4 * PI * (u + v)); }
static double ridges(double u, double v) { return (fmod(u * 4, 1) < 0.4) ^ (fmod(v * 3, 1) < 0.3) ? 1 : 0.1; }

static Canvas polygon_of(const Source *source) { return (Canvas){source->plane, v2(0, 0), v2(1, 1)}; }

enum { SIDE = 64 };

/* A quarter of a width below the polygon, from 45 degrees to the right: all is seen a quarter farther right.
 * The last quarter of it is lost, and through the first quarter of the polygon nothing is seen; nor is
 * anything there. */
static void a_sunken_floor_by_hand(void **unused) {
    (void)unused;
    Source source = relief_new(sunk, SIDE, 0.25, 1);
    Eye eye = {{1, 0, 1}, 0};
    PrewarpFactors factors = prewarp_factors(&source.plane, eye);
    Destination destination = destination_create(SIDE, SIDE, v2(0, 0), v2(1, 1), true);
    Judge judge = judge_create(&source, eye, &destination);
    near(judge_hole_percent(&judge, &destination), 100, 0);
    near(judge_order_violation_percent(&judge, &destination), 0, 0);
    Canvas polygon = polygon_of(&source), wide = {source.plane, v2(0, 0), v2(1.25, 1)};
    near(judge_lost_texel_percent(&judge, eye, &polygon, 1), 25, 0);
    near(judge_lost_texel_percent(&judge, eye, &wide, 1), 0, 0);
    near(judge_lost_texel_percent(&judge, eye, NULL, 0), 100, 0);
    int hits = 0;
    for (int i = 0; i < SIDE * SIDE; i++) hits += judge.exact[i].hit;
    assert_int_equal(hits, SIDE * SIDE * 3 / 4);

    warp_forward(&source, &factors, VISIBILITY_DEPTH_BUFFER, FILLING_NONE, &destination, NULL);
    near(judge_hole_percent(&judge, &destination), 0, 0);
    near(judge_rmse(&judge, &destination), 0, 1e-6);
    destination.texels[SIDE * 5 + 20].colour[3] = 127; /* one that hits, and one that does not */
    destination.texels[SIDE * 5 + 10].colour[3] = 127;
    near(judge_hole_percent(&judge, &destination), 100.0 / hits, 1e-9);
    judge_destroy(&judge);
    destination_destroy(&destination);
    source_destroy(&source);
}

/* One wrong colour, off by a known amount. */
static void rmse_is_the_root_of_the_mean_square(void **unused) {
    (void)unused;
    Source source = relief_new(waves, SIDE, 0.1, 1);
    Eye eye = {{0, 0, 1}, 0};
    Destination destination = destination_create(SIDE, SIDE, v2(0, 0), v2(1, 1), true);
    Judge judge = judge_create(&source, eye, &destination);
    memcpy(destination.texels, source.texels, sizeof(Texel) * SIDE * SIDE);
    near(judge_rmse(&judge, &destination), 0, 1e-6);
    Texel *texel = &destination.texels[1234];
    double error = srgb_decode(texel->colour[1] / 255.0);
    texel->colour[1] = 0;
    near(judge_rmse(&judge, &destination), sqrt(error * error / 3 / (SIDE * SIDE)), 1e-6);
    judge_destroy(&judge);
    destination_destroy(&destination);
    source_destroy(&source);
}

/* Of texels that land on one another the lowest stays: what a warp without visibility may do. */
static void keep_the_lowest(const Judge *judge, Destination *destination) {
    const Source *source = judge->source;
    for (int i = 0; i < source->width * source->height; i++) {
        const Sighting *sighting = &judge->sightings[i];
        double x = floor(sighting->u * destination->width), y = floor(sighting->v * destination->height);
        if (!(x >= 0 && x < destination->width && y >= 0 && y < destination->height)) continue;
        size_t at = (size_t)y * destination->width + (size_t)x;
        float *lookup = &destination->lookup[3 * at];
        if (destination->texels[at].colour[3] && lookup[2] < sighting->height) continue;
        destination->texels[at] = source->texels[i];
        lookup[0] = (float)((i % source->width + 0.5) / source->width);
        lookup[1] = (float)((i / source->width + 0.5) / source->height);
        lookup[2] = (float)sighting->height;
    }
}

static void violations_are_found(void **unused) {
    (void)unused;
    const Eye eyes[] = {{{2, 0, 1}, 0}, {{-1, 1.5, 0.7}, 1}, {{0.2, -1, 0.5}, 0}};
    for (int i = 0; i < 3; i++) {
        Source source = relief_new(waves, SIDE, 0.3, 1);
        PrewarpFactors factors = prewarp_factors(&source.plane, eyes[i]);
        Destination destination = destination_create(SIDE, SIDE, v2(0, 0), v2(1, 1), true);
        Judge judge = judge_create(&source, eyes[i], &destination);
        keep_the_lowest(&judge, &destination);
        assert_true(judge_order_violation_percent(&judge, &destination) > 3);
        warp_forward(&source, &factors, VISIBILITY_DEPTH_BUFFER, FILLING_NONE, &destination, NULL);
        near(judge_order_violation_percent(&judge, &destination), 0, 0);
        warp_inverse(&source, &factors, &destination);
        near(judge_order_violation_percent(&judge, &destination), 0, 0);
        near(judge_hole_percent(&judge, &destination), 0, 0);
        assert_true(judge_rmse(&judge, &destination) < 0.003);
        judge_destroy(&judge);
        destination_destroy(&destination);
        source_destroy(&source);
    }
}

/* An enlarged destination loses nothing, nor do auxiliary polygons at all edges that can overflow. */
static void all_pieces_together_lose_nothing(void **unused) {
    (void)unused;
    const Eye eyes[] = {
        {{2, 0.3, 1}, 0}, {{-1, 1.5, 0.7}, 1}, {{0, 0, 1}, 1}, {{-2, -1, 1}, 0}, {{0.1, 2, 1}, 1}};
    int losing = 0;
    for (int i = 0; i < 20; i++) {
        Eye eye = eyes[i % 5];
        Source source = relief_new(i < 10 ? waves : ridges, SIDE, 0.3, i % 4 / 2.0 - 0.5);
        PrewarpFactors factors = prewarp_factors(&source.plane, eye);
        Destination destination = overflow_destination(&source, &factors, 10, false);
        Judge judge = judge_create(&source, eye, &destination);
        Canvas whole = {source.plane, destination.low, destination.high}, pieces[1 + EDGES];
        near(judge_lost_texel_percent(&judge, eye, &whole, 1), 0, 0);
        int count = 0;
        pieces[count++] = polygon_of(&source);
        losing += judge_lost_texel_percent(&judge, eye, pieces, count) > 5;
        for (Edge edge = 0; edge < EDGES; edge++) {
            if (!overflow_can(&factors, overflow_displacements(&source), edge)) continue;
            Auxiliary auxiliary = auxiliary_create(&source, edge, false);
            pieces[count++] = (Canvas){auxiliary.plane, v2(0, 0), v2(1, 1)};
            auxiliary_destroy(&auxiliary);
        }
        near(judge_lost_texel_percent(&judge, eye, pieces, count), 0, 0);
        judge_destroy(&judge);
        destination_destroy(&destination);
        source_destroy(&source);
    }
    assert_true(losing >= 15);
}

/* What moves along columns alone loses nothing to the rows; ridges seen from a corner do; and a first pass
 * that keeps nothing loses all. */
static void the_first_pass_loses_where_it_folds(void **unused) {
    (void)unused;
    const Eye eyes[] = {{{0, 2, 1}, 0}, {{2, 2, 1}, 0}, {{-0.5, -1, 0.5}, 1}};
    float *kept = malloc(sizeof(float) * SIDE * SIDE);
    for (int i = 0; i < 3; i++) {
        Source source = relief_new(ridges, SIDE, 0.1, 1);
        PrewarpFactors factors = prewarp_factors(&source.plane, eyes[i]);
        Destination destination = destination_create(SIDE, SIDE, v2(0, 0), v2(1, 1), false);
        Judge judge = judge_create(&source, eyes[i], &destination);
        warp_two_pass(&source, &factors, &destination, kept);
        double loss = judge_first_pass_loss_percent(&judge, eyes[i], kept);
        if (i == 0)
            near(loss, 0, 0);
        else
            assert_true(loss > 1 && loss < 30);
        for (int k = 0; k < SIDE * SIDE; k++) kept[k] = NAN;
        near(judge_first_pass_loss_percent(&judge, eyes[i], kept), 100, 0);
        judge_destroy(&judge);
        destination_destroy(&destination);
        source_destroy(&source);
    }
    free(kept);
}

/* From where nothing is seen there is nothing to judge. */
static void nothing_seen_is_nothing_wrong(void **unused) {
    (void)unused;
    const Eye eyes[] = {{{0.3, 0, -1}, 1}, {{1, 0, 0}, 1}, {{0, 1, 0}, 0}, {{1, 0, -0.2}, 0}};
    for (int i = 0; i < 4; i++) {
        Source source = relief_new(waves, 8, 0.2, 1);
        Destination destination = destination_create(8, 8, v2(0, 0), v2(1, 1), true);
        Judge judge = judge_create(&source, eyes[i], &destination);
        Canvas polygon = polygon_of(&source);
        near(judge_hole_percent(&judge, &destination), 0, 0);
        near(judge_rmse(&judge, &destination), 0, 0);
        near(judge_lost_texel_percent(&judge, eyes[i], &polygon, 1), 0, 0);
        judge_destroy(&judge);
        destination_destroy(&destination);
        source_destroy(&source);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sunken_floor_by_hand),
        cmocka_unit_test(rmse_is_the_root_of_the_mean_square),
        cmocka_unit_test(violations_are_found),
        cmocka_unit_test(all_pieces_together_lose_nothing),
        cmocka_unit_test(the_first_pass_loses_where_it_folds),
        cmocka_unit_test(nothing_seen_is_nothing_wrong),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson 16, judge", tests, NULL, NULL);
}
