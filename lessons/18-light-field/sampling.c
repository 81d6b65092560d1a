#include "sampling.h"

#include "fail.h"
#include "image.h"
#include "parallel.h"
#include "synthesis.h"

#include <stdlib.h>

/* The sums of one block's texels. */
typedef struct {
    double linear, codes; /* squares; what sees nothing adds nothing */
    int seeing;
} Sums;

typedef struct {
    const Field *field;
    const Synthesis *few, *many;
    Sums *sums; /* by block */
} Job;

/* A number below count, from a seed that it changes (a multiplier and increment of D. Knuth's MMIX). */
static int drawn(uint64_t *seed, int count) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (int)((*seed >> 33) % (uint64_t)count);
}

static void add_texel(Sums *sums, const float *few, const float *many) {
    bool seeing = false;
    for (int k = 0; k < 3; k++) {
        double linear = (double)few[k] - (double)many[k];
        double codes = srgb_byte(few[k]) - srgb_byte(many[k]);
        sums->linear += linear * linear, sums->codes += codes * codes;
        seeing |= few[k] > 0.0f || many[k] > 0.0f;
    }
    sums->seeing += seeing;
}

static void sum_block(void *context, int i) {
    const Job *job = context;
    const Field *field = job->field;
    size_t count = (size_t)field->s * (size_t)field->t;
    float *few = allocate(6 * count, sizeof(float)), *many = few + 3 * count;
    uint64_t seed = (uint64_t)i;
    for (int k = 0; k < 4; k++) drawn(&seed, 2); /* away from seeds that are alike */
    int u = drawn(&seed, field->u), v = drawn(&seed, field->v);
    synthesis_block(job->few, u, v, few);
    synthesis_block(job->many, u, v, many);
    for (int k = 0; k < SAMPLING_PER_BLOCK; k++) {
        size_t at = 3 * (size_t)drawn(&seed, (int)count);
        add_texel(&job->sums[i], few + at, many + at);
    }
    free(few);
}

SamplingNoise sampling_noise(const Field *field, const LightScene *scene, bool through, int few, int many,
                             int texels) {
    int blocks = (texels + SAMPLING_PER_BLOCK - 1) / SAMPLING_PER_BLOCK;
    Synthesis *by_few = synthesis_create(field, scene, few, through);
    Synthesis *by_many = synthesis_create(field, scene, many, through);
    Job job = {field, by_few, by_many, allocate((size_t)blocks, sizeof(Sums))};
    parallel_for(blocks, sum_block, &job);
    SamplingNoise noise = {.texels = blocks * SAMPLING_PER_BLOCK};
    double linear = 0.0, codes = 0.0;
    for (int i = 0; i < blocks; i++) {
        linear += job.sums[i].linear, codes += job.sums[i].codes;
        noise.seeing += job.sums[i].seeing;
    }
    double seeing = noise.seeing > 0 ? 3.0 * noise.seeing : 1.0, all = 3.0 * noise.texels;
    noise.linear = sqrt(linear / all), noise.codes = sqrt(codes / all);
    noise.linear_seeing = sqrt(linear / seeing), noise.codes_seeing = sqrt(codes / seeing);
    free(job.sums);
    synthesis_destroy(by_few), synthesis_destroy(by_many);
    return noise;
}
