#include "vq.h"

#include "codec.h"
#include "fail.h"
#include "lanes.h"
#include "parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLE_MOST = 1 << 15, SAMPLE_BANDS = 8, MOVES = 3, LAST_MOVES = 6 };

typedef uint8_t Vector[PATCH_BYTES];

/* ---- The nearest code ---- */

/* Codes in the order of their sums, for vectors whose sums are far apart are far apart themselves: by Cauchy
 * and Schwarz |a - b|^2 >= (sum a - sum b)^2 / 48. So the search begins at the vector's own sum, goes both
 * ways, and ends early. */
typedef struct {
    int count;
    float *codes; /* PATCH_BYTES each, in that order */
    float *sums;
    int *numbers; /* which code each is */
} Ordered;

typedef struct {
    float sum;
    int number;
} Key;

static int by_sum(const void *a, const void *b) {
    const Key *x = a, *y = b;
    if (x->sum != y->sum) return x->sum < y->sum ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

static Ordered ordered_create(const float *codes, int count) {
    size_t n = (size_t)count;
    Ordered ordered = {count, allocate(n * PATCH_BYTES, sizeof(float)), allocate(n, sizeof(float)),
                       allocate(n, sizeof(int))};
    Key *keys = allocate(n, sizeof *keys);
    for (int i = 0; i < count; i++) {
        keys[i].number = i;
        for (int k = 0; k < PATCH_BYTES; k++) keys[i].sum += codes[(size_t)i * PATCH_BYTES + (size_t)k];
    }
    qsort(keys, n, sizeof *keys, by_sum);
    for (int i = 0; i < count; i++) {
        ordered.sums[i] = keys[i].sum, ordered.numbers[i] = keys[i].number;
        memcpy(ordered.codes + (size_t)i * PATCH_BYTES, codes + (size_t)keys[i].number * PATCH_BYTES,
               PATCH_BYTES * sizeof(float));
    }
    free(keys);
    return ordered;
}

static void ordered_destroy(Ordered *ordered) {
    free(ordered->codes), free(ordered->sums), free(ordered->numbers);
}

INLINE float distance(const float *vector, const float *code) {
    Floats total = ALL(0.0f), a, b;
    for (int i = 0; i < PATCH_BYTES; i += LANES) {
        LOAD(a, vector + i);
        LOAD(b, code + i);
        total += (a - b) * (a - b);
    }
    float sum = 0.0f;
    for (int lane = 0; lane < LANES; lane++) sum += total[lane];
    return sum;
}

/* Of equally near codes the one with the least number. */
WIDE static int nearest(const Ordered *ordered, const float *vector, float *least) {
    float sum = 0.0f;
    for (int k = 0; k < PATCH_BYTES; k++) sum += vector[k];
    int low = 0, high = ordered->count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (ordered->sums[middle] < sum)
            low = middle + 1;
        else
            high = middle;
    }
    int best = -1, down = low - 1, up = low;
    *least = INFINITY;
    for (;;) {
        float below = down >= 0 ? sum - ordered->sums[down] : INFINITY;
        float above = up < ordered->count ? ordered->sums[up] - sum : INFINITY;
        float aside = below < above ? below : above;
        if (aside == INFINITY || aside * aside > *least * PATCH_BYTES * 1.0001f) break;
        int at = below < above ? down-- : up++;
        float far = distance(vector, ordered->codes + (size_t)at * PATCH_BYTES);
        if (far < *least || (far == *least && ordered->numbers[at] < best))
            *least = far, best = ordered->numbers[at];
    }
    return best;
}

/* ---- The sample ---- */

typedef struct {
    int count, room; /* room: a power of two of slots */
    Vector *vectors;
    uint32_t *times;
    int *slots; /* + 1; 0: free */
} Sample;

static uint64_t vector_hash(const Vector vector) { return field_checksum(1, vector, PATCH_BYTES); }

/* Distinct vectors; of more than SAMPLE_MOST those with the least hashes, which is as good as by lot. */
static void sample_add(Sample *sample, const Vector vector) {
    size_t mask = (size_t)sample->room - 1, slot = (size_t)vector_hash(vector) & mask;
    for (; sample->slots[slot]; slot = (slot + 1) & mask) {
        int at = sample->slots[slot] - 1;
        if (memcmp(sample->vectors[at], vector, PATCH_BYTES) != 0) continue;
        sample->times[at]++;
        return;
    }
    if (sample->count == sample->room / 2) return; /* enough */
    sample->slots[slot] = sample->count + 1;
    memcpy(sample->vectors[sample->count], vector, PATCH_BYTES);
    sample->times[sample->count++] = 1;
}

typedef struct {
    uint64_t hash;
    int at;
} Lot;

static int by_hash(const void *a, const void *b) {
    const Lot *x = a, *y = b;
    if (x->hash != y->hash) return x->hash < y->hash ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

static void sample_thin(Sample *sample) {
    if (sample->count <= SAMPLE_MOST) return;
    Lot *lots = allocate((size_t)sample->count, sizeof *lots);
    for (int i = 0; i < sample->count; i++)
        lots[i] = (Lot){vector_hash(sample->vectors[i]) * 0x9e3779b97f4a7c15u, i};
    qsort(lots, (size_t)sample->count, sizeof *lots, by_hash);
    Vector *kept = allocate(SAMPLE_MOST, sizeof *kept);
    uint32_t *times = allocate(SAMPLE_MOST, sizeof *times);
    for (int i = 0; i < SAMPLE_MOST; i++) {
        memcpy(kept[i], sample->vectors[lots[i].at], PATCH_BYTES);
        times[i] = sample->times[lots[i].at];
    }
    free(sample->vectors), free(sample->times), free(lots);
    sample->vectors = kept, sample->times = times, sample->count = SAMPLE_MOST;
}

static Sample sample_take(const Encoded *encoded, const FieldSource *source) {
    const Field *field = &encoded->field;
    Sample sample = {.room = 1 << 20};
    sample.slots = allocate((size_t)sample.room, sizeof(int));
    sample.vectors = allocate((size_t)sample.room / 2, PATCH_BYTES);
    sample.times = allocate((size_t)sample.room / 2, sizeof(uint32_t));
    uint8_t *texels = allocate(PATCH_SIDE, field_row(field));
    int bands = codec_bands(&codec_vq, field), taken = bands < SAMPLE_BANDS ? bands : SAMPLE_BANDS;
    for (int i = 0; i < taken; i++) {
        int band = (2 * i + 1) * bands / (2 * taken), first = band * PATCH_SIDE, rows = field->v - first;
        if (rows > PATCH_SIDE) rows = PATCH_SIDE;
        source->rows(source->data, first, rows, texels);
        for (int u = 0; u < field->u; u += PATCH_SIDE)
            for (int t = 0; t < field->t; t++)
                for (int s = 0; s < field->s; s++) {
                    Vector vector;
                    patch_read(field, rows, texels, u, s, t, vector);
                    if (!patch_black(vector)) sample_add(&sample, vector);
                }
    }
    free(texels), free(sample.slots);
    sample_thin(&sample);
    return sample;
}

/* ---- Training ---- */

typedef struct {
    const Sample *sample;
    Ordered ordered;
    int *code;      /* of each vector */
    float *squares; /* its distance to it */
} Matching;

enum { MATCH_RUN = 256 };

static void match_run(void *context, int run) {
    Matching *matching = context;
    int end = (run + 1) * MATCH_RUN;
    for (int i = run * MATCH_RUN; i < end && i < matching->sample->count; i++) {
        float vector[PATCH_BYTES];
        for (int k = 0; k < PATCH_BYTES; k++) vector[k] = matching->sample->vectors[i][k];
        matching->code[i] = nearest(&matching->ordered, vector, &matching->squares[i]);
    }
}

/* Gives each vector its nearest code; the mean error is squared codes a texel, of the blocks sampled. */
static double match_all(Matching *matching, const float *codes, int count) {
    matching->ordered = ordered_create(codes, count);
    parallel_for((matching->sample->count + MATCH_RUN - 1) / MATCH_RUN, match_run, matching);
    ordered_destroy(&matching->ordered);
    double sum = 0.0, blocks = 0.0;
    for (int i = 0; i < matching->sample->count; i++) {
        sum += (double)matching->squares[i] * matching->sample->times[i];
        blocks += matching->sample->times[i];
    }
    return blocks > 0.0 ? sum / (blocks * PATCH_SIDE * PATCH_SIDE) : 0.0;
}

/* Each code but black to the mean of its vectors; one that has none stays. */
static void move_codes(const Matching *matching, float *codes, int count) {
    double *sums = allocate((size_t)count * PATCH_BYTES, sizeof(double)),
           *times = allocate((size_t)count, sizeof(double));
    for (int i = 0; i < matching->sample->count; i++) {
        double weight = matching->sample->times[i];
        double *sum = sums + (size_t)matching->code[i] * PATCH_BYTES;
        for (int k = 0; k < PATCH_BYTES; k++) sum[k] += weight * matching->sample->vectors[i][k];
        times[matching->code[i]] += weight;
    }
    for (int c = 1; c < count; c++)
        for (int k = 0; k < PATCH_BYTES && times[c] > 0.0; k++)
            codes[(size_t)c * PATCH_BYTES + (size_t)k] =
                (float)(sums[(size_t)c * PATCH_BYTES + (size_t)k] / times[c]);
    free(sums), free(times);
}

typedef struct {
    double error;
    int code, farthest;
} Split;

static int by_error(const void *a, const void *b) {
    const Split *x = a, *y = b;
    if (x->error != y->error) return x->error > y->error ? -1 : 1;
    return (x->code > y->code) - (x->code < y->code);
}

/* A new code at the farthest vector of each of the codes with the largest errors, until there are `most`, or
 * twice as many; how many there are then. */
static int split_codes(const Matching *matching, float *codes, int count, int most) {
    const Sample *sample = matching->sample;
    Split *splits = allocate((size_t)count, sizeof *splits);
    for (int c = 0; c < count; c++) splits[c] = (Split){0.0, c, -1};
    for (int i = 0; i < sample->count; i++) {
        Split *split = &splits[matching->code[i]];
        split->error += (double)matching->squares[i] * sample->times[i];
        if (split->farthest < 0 || matching->squares[i] > matching->squares[split->farthest])
            split->farthest = i;
    }
    qsort(splits, (size_t)count, sizeof *splits, by_error);
    int added = 0;
    for (; added < count && count + added < most && splits[added].error > 0.0; added++)
        for (int k = 0; k < PATCH_BYTES; k++)
            codes[(size_t)(count + added) * PATCH_BYTES + (size_t)k] =
                sample->vectors[splits[added].farthest][k];
    free(splits);
    return count + added;
}

static void vq_begin(Encoded *encoded, const FieldSource *source) {
    int most = 1 << encoded->knob, count = 2;
    Sample sample = sample_take(encoded, source);
    Matching matching = {.sample = &sample,
                         .code = allocate((size_t)sample.count + 1, sizeof(int)),
                         .squares = allocate((size_t)sample.count + 1, sizeof(float))};
    float *codes = allocate((size_t)most * PATCH_BYTES, sizeof(float));
    match_all(&matching, codes, 1);
    for (int i = 0; i < sample.count; i++) matching.code[i] = 1;
    move_codes(&matching, codes, 2);
    for (;;) {
        match_all(&matching, codes, count);
        bool last = count == most;
        for (int move = 0; move < (last ? LAST_MOVES : MOVES); move++) {
            move_codes(&matching, codes, count);
            double error = match_all(&matching, codes, count);
            if (move == 0 && encoded->rounds < VQ_ROUNDS_MOST) encoded->rounds++;
            encoded->mean_error[encoded->rounds - 1] = error;
        }
        int more = last ? count : split_codes(&matching, codes, count, most);
        if (more == count) break;
        count = more;
    }
    uint8_t *book = plane_extend(&encoded->planes[0], (size_t)count * PATCH_BYTES);
    for (size_t i = 0; i < (size_t)count * PATCH_BYTES; i++) book[i] = (uint8_t)lrintf(codes[i]);
    free(codes), free(matching.code), free(matching.squares), free(sample.vectors), free(sample.times);
}

/* ---- Bands ---- */

typedef struct {
    const Encoded *encoded;
    const uint8_t *texels;
    int rows;
    Blocks blocks;
    Ordered ordered;
    uint8_t *codes; /* of the band */
} BandJob;

static void encode_column(void *context, int u) {
    BandJob *job = context;
    int bytes = vq_code_bytes(job->encoded->knob), last = 0;
    Vector before = {0};
    for (int t = 0; t < job->blocks.t; t++)
        for (int s = 0; s < job->blocks.s; s++) {
            Vector vector;
            patch_read(&job->encoded->field, job->rows, job->texels, u * PATCH_SIDE, s, t, vector);
            if (memcmp(vector, before, PATCH_BYTES) != 0) { /* most are black, like the one before */
                float floats[PATCH_BYTES], least;
                for (int k = 0; k < PATCH_BYTES; k++) floats[k] = vector[k];
                last = nearest(&job->ordered, floats, &least);
                memcpy(before, vector, PATCH_BYTES);
            }
            uint8_t *to = job->codes + (size_t)bytes * block_number(&job->blocks, u, 0, s, t);
            for (int i = 0; i < bytes; i++) to[i] = (uint8_t)(last >> 8 * i);
        }
}

static void vq_encode(Encoded *encoded, int band, int rows, const uint8_t *texels) {
    (void)band;
    const Plane *book = &encoded->planes[0];
    int count = (int)(book->bytes / PATCH_BYTES);
    float *codes = allocate((size_t)count * PATCH_BYTES, sizeof(float));
    for (size_t i = 0; i < book->bytes; i++) codes[i] = book->data[i];
    Blocks blocks = encoded->blocks;
    size_t bytes =
        (size_t)vq_code_bytes(encoded->knob) * (size_t)blocks.u * (size_t)blocks.s * (size_t)blocks.t;
    BandJob job = {encoded,
                   texels,
                   rows,
                   blocks,
                   ordered_create(codes, count),
                   plane_extend(&encoded->planes[1], bytes)};
    parallel_for(blocks.u, encode_column, &job);
    ordered_destroy(&job.ordered);
    free(codes);
}

/* ---- Decoding ---- */

static uint32_t code_at(const Encoded *encoded, size_t number) {
    int bytes = vq_code_bytes(encoded->knob);
    const uint8_t *from = plane_at(&encoded->planes[1], (size_t)bytes * number);
    return from[0] | (bytes > 1 ? (uint32_t)from[1] << 8 : 0);
}

static void vq_decode(const Encoded *encoded, const int at[4], float *light) {
    Blocks blocks = encoded->blocks;
    uint32_t code =
        code_at(encoded, block_number(&blocks, at[0] / PATCH_SIDE, at[1] / PATCH_SIDE, at[2], at[3]));
    const uint8_t *texel = encoded->planes[0].data + (size_t)code * PATCH_BYTES +
                           3 * (at[1] % PATCH_SIDE * PATCH_SIDE + at[0] % PATCH_SIDE);
    for (int k = 0; k < 3; k++) light[k] = light_of(texel[k]);
}

static int64_t vq_size(const Encoded *encoded, int plane, int band) {
    (void)band;
    Blocks blocks = encoded->blocks;
    return plane ? (int64_t)vq_code_bytes(encoded->knob) * blocks.u * blocks.s * blocks.t : -1;
}

static bool vq_refers(const Encoded *encoded) {
    const Plane *book = &encoded->planes[0], *codes = &encoded->planes[1];
    size_t count = book->bytes / PATCH_BYTES, bytes = (size_t)vq_code_bytes(encoded->knob),
           begin = codes->before / bytes;
    if (book->bytes % PATCH_BYTES || count < 1 || count > (size_t)1 << encoded->knob) return false;
    for (size_t i = 0; i < codes->bytes / bytes; i++)
        if (code_at(encoded, begin + i) >= count) return false;
    return true;
}

const Codec codec_vq = {
    .name = "vq",
    .number = 3,
    .block = {PATCH_SIDE, PATCH_SIDE, 1, 1},
    .knobs = {1, 16},
    .planes = {{.tag = FIELD_TAG('C', 'O', 'D', 'E'), .whole = true}, {.tag = FIELD_TAG('I', 'N', 'D', 'X')}},
    .begin = vq_begin,
    .encode = vq_encode,
    .decode = vq_decode,
    .size = vq_size,
    .refers = vq_refers};
