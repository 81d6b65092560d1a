#include "compare.h"

#include "fail.h"
#include "parallel.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* What one row adds to the sums. Rows are worked on in any order but summed in theirs, so that the result
 * does not depend on the number of cores. */
typedef struct {
    double square, encoded_square, max_abs;
    const Image *bad; /* the image that has a value that is not finite, */
    int bad_column;   /* and where in this row */
} Row;

typedef struct {
    const Image *test, *reference;
    int channels;
    Row *rows;
} Comparison;

/* The same function as srgb_encode, in floats: twice as fast, and 1e-7 does not show in decibels. */
static float encode_clipped(float x) {
    if (!(x > 0)) return 0;
    if (x >= 1) return 1;
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
}

static void compare_row(void *context, int y) {
    Comparison *c = context;
    Row row = {0};
    for (int x = 0; x < c->test->width; x++) {
        const float *test = image_at(c->test, x, y), *reference = image_at(c->reference, x, y);
        for (int i = 0; i < c->channels; i++) {
            if (!row.bad && !(isfinite(test[i]) && isfinite(reference[i]))) {
                row.bad = isfinite(test[i]) ? c->reference : c->test;
                row.bad_column = x;
            }
            double error = (double)test[i] - reference[i];
            double encoded_error = encode_clipped(test[i]) - encode_clipped(reference[i]);
            row.square += error * error;
            row.encoded_square += encoded_error * encoded_error;
            row.max_abs = fmax(row.max_abs, fabs(error));
        }
    }
    c->rows[y] = row;
}

/* The sums over all rows, or the place of the first value that is not finite. */
static const char *sum_rows(const Comparison *c, Difference *difference) {
    static _Thread_local char reason[96];
    double square = 0, encoded_square = 0, max_abs = 0;
    for (int y = 0; y < c->test->height; y++) {
        const Row *row = &c->rows[y];
        if (row->bad) {
            snprintf(reason, sizeof reason, "the %s is not finite at column %d, row %d from the bottom",
                     row->bad == c->test ? "test" : "reference", row->bad_column, y);
            return reason;
        }
        square += row->square;
        encoded_square += row->encoded_square;
        max_abs = fmax(max_abs, row->max_abs);
    }
    double count = (double)c->test->width * c->test->height * c->channels;
    difference->rmse = sqrt(square / count);
    difference->max_abs = max_abs;
    difference->psnr_db = encoded_square > 0 ? fmin(100, -10 * log10(encoded_square / count)) : 100;
    return NULL;
}

const char *compare_seen(const Image *test, const Image *reference, const Seen *seen, Difference *difference,
                         Image *map) {
    static _Thread_local char reason[96];
    if (test->width != reference->width || test->height != reference->height) {
        snprintf(reason, sizeof reason, "another size: %dx%d pixels against the reference's %dx%d",
                 test->width, test->height, reference->width, reference->height);
        return reason;
    }
    int channels = test->channels < 3 ? 1 : 3;
    if (channels != (reference->channels < 3 ? 1 : 3)) {
        snprintf(reason, sizeof reason, "another number of channels: %d against the reference's %d",
                 test->channels, reference->channels);
        return reason;
    }

    Comparison c = {.test = test, .reference = reference, .channels = channels};
    c.rows = allocate(test->height, sizeof *c.rows);
    parallel_for(test->height, compare_row, &c);
    Difference result = {0};
    const char *refused = sum_rows(&c, &result);
    if (!refused && map) {
        Seen seen_test = seen_create(test);
        result.flip = flip(&seen_test, seen, map);
        seen_destroy(&seen_test);
    }
    if (!refused) *difference = result;
    free(c.rows);
    return refused;
}

const char *compare(const Image *test, const Image *reference, Difference *difference, Image *map) {
    Difference result;
    const char *refused =
        compare_seen(test, reference, NULL, &result, NULL); /* before anything is looked at */
    if (!refused && map) {
        Seen seen = seen_create(reference);
        refused = compare_seen(test, reference, &seen, &result, map);
        seen_destroy(&seen);
    }
    if (!refused) *difference = result;
    return refused;
}

/* Black, violet, orange, white, in sRGB; in between, straight lines. Red and green never fall, and where blue
 * does they outweigh it: more error is always lighter, even in a grey print. */
Image compare_heat(const Image *map) {
    static const double stops[][3] = {{0, 0, 0}, {0.42, 0.08, 0.58}, {0.97, 0.55, 0.18}, {1, 1, 1}};
    enum { LAST = sizeof stops / sizeof stops[0] - 1 };
    Image heat = image_create(map->width, map->height, 3);
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            double place = fmin(fmax(image_at(map, x, y)[0], 0), 1) * LAST;
            int i = place < LAST ? (int)place : LAST - 1;
            for (int c = 0; c < 3; c++)
                image_at(&heat, x, y)[c] =
                    (float)srgb_decode(stops[i][c] + (stops[i + 1][c] - stops[i][c]) * (place - i));
        }
    return heat;
}
