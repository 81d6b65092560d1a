#include "pace.h"

#include "clock.h"
#include "fail.h"

#include <stdlib.h>

enum { RANDOM_VIEWS = 16, ROUNDS_MIN = 3 };
static const double SECONDS = 0.1;      /* after which no more rounds than that are begun, */
static const double SLOW_SECONDS = 0.5; /* and none more than the first */

static double now_ns(void) { return 1e9 * clock_seconds(); }

static bool another_round(int done, double start) {
    double seconds = 1e-9 * (now_ns() - start);
    return done < 1 || (done < ROUNDS_MIN && seconds < SLOW_SECONDS) || seconds < SECONDS;
}

double pace_warp(const Prewarp *prewarp, Way way, Eye eye) {
    Destination destination =
        destination_create(prewarp->source.width, prewarp->source.height, v2(0, 0), v2(1, 1), false);
    double start = now_ns(), fastest = INFINITY;
    for (int round = -1; another_round(round, start); round++) {
        double begun = now_ns();
        scene_warp(prewarp, way, eye, &destination);
        if (round >= 0) fastest = fmin(fastest, now_ns() - begun); /* the first one warms up */
    }
    destination_destroy(&destination);
    return fastest;
}

/* The fraction part of i times an irrational number: spread evenly, and the same in every run. */
static double spread(int i, double irrational) { return i * irrational - floor(i * irrational); }

Eye pace_eye(int i) {
    double cosine = 1 - (1 - cos(radians(75))) * spread(i + 1, 0.41421356237309503);
    double around = 2 * PI * spread(i + 1, 0.61803398874989485), sine = sqrt(1 - cosine * cosine);
    Vec3 toward = v3(sine * cos(around), sine * sin(around), cosine);
    return (Eye){vec3_scale(toward, 1 + 2 * spread(i + 1, 0.73205080756887729)), 1};
}

uint32_t *pace_table(const Source *source, Eye eye) {
    PrewarpFactors k = prewarp_factors(&source->plane, eye);
    int width = source->width, height = source->height;
    uint32_t count = (uint32_t)width * (uint32_t)height, *table = allocate(count, sizeof *table);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            size_t i = (size_t)y * width + x;
            double d = source->scale * (source->levels[i] / 65535.0 - source->base), w = 1 + k.k3 * d;
            double column = floor(((x + 0.5) / width + k.k1 * d) / w * width);
            double row = floor(((y + 0.5) / height + k.k2 * d) / w * height);
            bool inside = w > 0 && column >= 0 && column < width && row >= 0 && row < height;
            table[i] = inside ? (uint32_t)row * (uint32_t)width + (uint32_t)column : count;
        }
    return table;
}

/* Not inlined, so that what is timed is a loop over memory. */
__attribute__((noinline)) static void scatter(const Source *source, const uint32_t *table, Texel *out) {
    size_t count = (size_t)source->width * source->height;
    for (size_t i = 0; i < count; i++) out[table[i]] = source->texels[i];
}

Pace pace_random(const Prewarp *prewarp, Way way) {
    const Source *source = &prewarp->source;
    Destination destination = destination_create(source->width, source->height, v2(0, 0), v2(1, 1), false);
    Texel *scattered = allocate((size_t)source->width * source->height + 1, sizeof *scattered);
    uint32_t *tables[RANDOM_VIEWS];
    for (int i = 0; i < RANDOM_VIEWS; i++) tables[i] = pace_table(source, pace_eye(i));
    double warp_ns[RANDOM_VIEWS], scatter_ns[RANDOM_VIEWS], start = now_ns();
    for (int i = 0; i < RANDOM_VIEWS; i++) warp_ns[i] = scatter_ns[i] = INFINITY;
    for (int round = 0; another_round(round, start); round++)
        for (int i = 0; i < RANDOM_VIEWS; i++) {
            double begun = now_ns();
            scene_warp(prewarp, way, pace_eye(i), &destination);
            warp_ns[i] = fmin(warp_ns[i], now_ns() - begun);
            scatter(source, tables[i], scattered); /* once for the caches, which the warp has filled */
            double warmed = now_ns();
            scatter(source, tables[i], scattered);
            scatter_ns[i] = fmin(scatter_ns[i], now_ns() - warmed);
        }
    Pace pace = {0};
    for (int i = 0; i < RANDOM_VIEWS; i++) {
        pace.warp_ns += warp_ns[i] / RANDOM_VIEWS;
        pace.scatter_ns += scatter_ns[i] / RANDOM_VIEWS;
    }
    for (int i = 0; i < RANDOM_VIEWS; i++) free(tables[i]);
    free(scattered);
    destination_destroy(&destination);
    return pace;
}
