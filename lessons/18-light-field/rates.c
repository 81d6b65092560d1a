#include "rates.h"

#include "brute.h"
#include "clock.h"
#include "fail.h"
#include "synthesis.h"

#include <stdlib.h>
#include <string.h>

/* Who takes part: ours, brute force, and Embree by geometry and way. */
enum { OURS, BRUTE, EMBREE, RACERS = EMBREE + 2 * EMBREE_WAYS };

typedef struct {
    const Field *field;
    const Synthesis *synthesis;
    const Brute *brute;
    const EmbreeField *embree[2];
    bool coherent[RACERS];
} Race;

static double rays_per_second(const Race *race, int racer, bool coherent, uint8_t *texels) {
    const int rows = race->field->v, i = racer - EMBREE;
    double before = clock_seconds();
    if (racer == OURS)
        synthesis_rows(race->synthesis, 0, rows, texels, NULL);
    else if (racer == BRUTE)
        brute_rows(race->brute, 0, rows, texels);
    else
        embree_field_rows(race->embree[i / EMBREE_WAYS], (EmbreeWay)(i % EMBREE_WAYS), coherent, 0, rows,
                          texels);
    return (double)(field_bytes(race->field) / FIELD_TEXEL) / (clock_seconds() - before);
}

static double share_different(const Field *field, const uint8_t *a, const uint8_t *b) {
    size_t count = field_bytes(field) / FIELD_TEXEL, different = 0;
    for (size_t i = 0; i < count; i++, a += FIELD_TEXEL, b += FIELD_TEXEL) {
        if (memcmp(a, b, FIELD_TEXEL) == 0) continue;
        different += abs(a[0] - b[0]) > 1 || abs(a[1] - b[1]) > 1 || abs(a[2] - b[2]) > 1;
    }
    return (double)different / (double)count;
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count) {
    qsort(values, (size_t)count, sizeof *values, by_size);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/* The first of all runs: memory is touched for the first time, Embree's better flag is chosen, and what was
 * made is compared. */
static void warm_up(Race *race, uint8_t *ours, uint8_t *theirs, Rates *rates) {
    memset(theirs, 0xff, field_bytes(race->field));
    rays_per_second(race, OURS, false, ours);
    for (int racer = BRUTE; racer < RACERS; racer++) {
        memset(theirs, 0xff, field_bytes(race->field)); /* who writes nothing is found out */
        double plain = rays_per_second(race, racer, false, theirs);
        double different = share_different(race->field, ours, theirs);
        if (racer == BRUTE) {
            rates->brute_different = different;
            continue;
        }
        race->coherent[racer] = rays_per_second(race, racer, true, theirs) > plain;
        double *most = &rates->embree_different[(racer - EMBREE) / EMBREE_WAYS];
        *most = fmax(*most, fmax(different, share_different(race->field, ours, theirs)));
    }
}

Rates rates_measure(const Field *field, const LightScene *scene, int rounds) {
    Rates rates = {0};
    Synthesis *synthesis = synthesis_create(field, scene, 1, false);
    Brute *brute = brute_create(field, scene);
    EmbreeField *user = embree_field_create(field, scene, false, NULL),
                *meshes = embree_field_create(field, scene, true, &rates.triangles);
    Race race = {field, synthesis, brute, {user, meshes}, {false}};
    uint8_t *ours = allocate(field_bytes(field), 1), *theirs = allocate(field_bytes(field), 1);
    warm_up(&race, ours, theirs, &rates);

    double *runs = allocate((size_t)rounds * (RACERS + 2), sizeof(double)); /* [racer][round] */
    double *to_brute = runs + rounds * RACERS, *to_embree = to_brute + rounds;
    for (int round = 0; round < rounds; round++) {
        double best = 0.0;
        for (int racer = 0; racer < RACERS; racer++) {
            double rate = rays_per_second(&race, racer, race.coherent[racer], theirs);
            runs[racer * rounds + round] = rate;
            if (racer >= EMBREE) best = fmax(best, rate);
        }
        to_brute[round] = runs[OURS * rounds + round] / runs[BRUTE * rounds + round];
        to_embree[round] = runs[OURS * rounds + round] / best;
    }
    rates.brute_ratio = median(to_brute, rounds), rates.embree_ratio = median(to_embree, rounds);
    rates.rays_per_second = median(runs + OURS * rounds, rounds);
    rates.brute_rays_per_second = median(runs + BRUTE * rounds, rounds);
    for (int i = 0; i < 2 * EMBREE_WAYS; i++) {
        rates.embree_rays_per_second[i / EMBREE_WAYS][i % EMBREE_WAYS] =
            median(runs + (EMBREE + i) * rounds, rounds);
        rates.embree_coherent[i / EMBREE_WAYS][i % EMBREE_WAYS] = race.coherent[EMBREE + i];
    }
    free(runs), free(ours), free(theirs);
    embree_field_destroy(user), embree_field_destroy(meshes);
    brute_destroy(brute), synthesis_destroy(synthesis);
    return rates;
}
