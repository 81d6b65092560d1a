#include "codec.h"

#include "fail.h"
#include "image.h"
#include "parallel.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static const Codec *const codecs[] = {&codec_bc1, &codec_bc7, &codec_vq, &codec_ramp};
enum { CODECS = sizeof codecs / sizeof *codecs };

const Codec *codec_named(const char *name) {
    for (int i = 0; i < CODECS; i++)
        if (strcmp(codecs[i]->name, name) == 0) return codecs[i];
    return NULL;
}

const Codec *codec_numbered(uint32_t number) {
    for (int i = 0; i < CODECS; i++)
        if (codecs[i]->number == number) return codecs[i];
    return NULL;
}

Blocks codec_blocks(const Codec *codec, const Field *field) {
    return (Blocks){blocks_along(field->u, codec->block.u), blocks_along(field->v, codec->block.v),
                    blocks_along(field->s, codec->block.s), blocks_along(field->t, codec->block.t)};
}

/* ---- Encoded fields ---- */

Encoded encoded_create(const Codec *codec, const Field *field, int knob) {
    Encoded encoded = {.codec = codec, .field = *field, .blocks = codec_blocks(codec, field), .knob = knob};
    memcpy(encoded.planes, codec->planes, sizeof encoded.planes);
    return encoded;
}

void encoded_destroy(Encoded *encoded) {
    for (int i = 0; i < PLANES_MAX; i++) free(encoded->planes[i].data);
    *encoded = (Encoded){0};
}

uint8_t *plane_extend(Plane *plane, size_t bytes) {
    if (bytes > plane->room - plane->bytes) {
        size_t room = plane->bytes + bytes + plane->bytes / 2;
        uint8_t *data = realloc(plane->data, room);
        if (!data) fail("out of memory: %zu bytes of an encoded light field", room);
        plane->data = data, plane->room = room;
    }
    uint8_t *end = plane->data + plane->bytes;
    memset(end, 0, bytes);
    plane->bytes += bytes;
    return end;
}

Encoded encoded_make(const Codec *codec, const Field *field, int knob, const FieldSource *source) {
    Encoded encoded = encoded_create(codec, field, knob);
    if (codec->begin) codec->begin(&encoded, source);
    uint8_t *texels = allocate((size_t)codec->block.v, field_row(field));
    for (int band = 0; band < codec_bands(codec, field); band++) {
        int first = band * codec->block.v, rows = field->v - first;
        if (rows > codec->block.v) rows = codec->block.v;
        source->rows(source->data, first, rows, texels);
        codec->encode(&encoded, band, rows, texels);
    }
    free(texels);
    return encoded;
}

void field_texels_rows(const void *data, int first, int rows, uint8_t *texels) {
    const FieldTexels *whole = data;
    size_t row = field_row(whole->field);
    memcpy(texels, whole->texels + row * (size_t)first, row * (size_t)rows);
}

void patch_read(const Field *field, int rows, const uint8_t *texels, int u0, int s, int t,
                uint8_t patch[PATCH_BYTES]) {
    for (int v = 0; v < PATCH_SIDE; v++)
        for (int u = 0; u < PATCH_SIDE; u++) {
            int row = v < rows ? v : rows - 1, column = u0 + u < field->u ? u0 + u : field->u - 1;
            size_t block = (size_t)row * (size_t)field->u + (size_t)column;
            size_t at = (block * (size_t)field->t + (size_t)t) * (size_t)field->s + (size_t)s;
            memcpy(patch + FIELD_TEXEL * (v * PATCH_SIDE + u), texels + FIELD_TEXEL * at, FIELD_TEXEL);
        }
}

bool patch_black(const uint8_t patch[PATCH_BYTES]) {
    for (int i = 0; i < PATCH_BYTES; i++)
        if (patch[i]) return false;
    return true;
}

/* ---- sRGB ---- */

enum { CODE_STEPS = 4096 };
static float code_steps[CODE_STEPS + 2]; /* of the squares of i / CODE_STEPS */
static float light_steps[256], root_steps[256];
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void make_steps(void) {
    for (int i = 0; i <= CODE_STEPS + 1; i++) {
        double root = (double)i / CODE_STEPS;
        code_steps[i] = (float)(255.0 * srgb_encode(root * root));
    }
    for (int i = 0; i < 256; i++) {
        light_steps[i] = (float)srgb_decode(i / 255.0);
        root_steps[i] = sqrtf(light_steps[i]);
    }
}

/* Between steps of the root the curve is all but straight: off by less than 1e-4 of a code. */
float code_of_root(float root) {
    pthread_once(&once, make_steps);
    float at = (root < 0.0f ? 0.0f : root > 1.0f ? 1.0f : root) * CODE_STEPS;
    int step = (int)at;
    return code_steps[step] + (code_steps[step + 1] - code_steps[step]) * (at - (float)step);
}

float code_of(float light) { return code_of_root(sqrtf(light)); }

float light_of(uint8_t code) {
    pthread_once(&once, make_steps);
    return light_steps[code];
}

float root_of(uint8_t code) {
    pthread_once(&once, make_steps);
    return root_steps[code];
}

/* ---- Error ---- */

/* One row of v of a field whose texels are marked: 1 where an object is met. A texel's neighbourhood is a
 * box, so it is spread along one axis after another. */
static void spread(uint8_t *marks, size_t count, size_t step, int length, bool around) {
    uint8_t *line = allocate((size_t)length, 1);
    for (size_t outer = 0; outer < count; outer += step * (size_t)length)
        for (size_t inner = 0; inner < step; inner++) {
            uint8_t *at = marks + outer + inner;
            for (int i = 0; i < length; i++) line[i] = at[(size_t)i * step];
            for (int i = 0; i < length; i++) {
                int before = i > 0    ? i - 1
                             : around ? length - 1
                                      : i,
                    after = i + 1 < length ? i + 1
                            : around       ? 0
                                           : i;
                at[(size_t)i * step] = line[before] | line[i] | line[after];
            }
        }
    free(line);
}

typedef struct {
    const Encoded *encoded;
    int first, rows;
    const uint8_t *texels;
    uint8_t *marks;
    EncodedError *of_row;
} ErrorJob;

static void mark_row(void *context, int row) {
    ErrorJob *job = context;
    const Field *field = &job->encoded->field;
    size_t count = (size_t)field->u * field->s * field->t;
    uint8_t *marks = job->marks + count * (size_t)row;
    const uint8_t *texels = job->texels + field_row(field) * (size_t)row;
    for (size_t i = 0; i < count; i++)
        marks[i] = (texels[3 * i] | texels[3 * i + 1] | texels[3 * i + 2]) != 0;
    spread(marks, count, 1, field->s, false);
    spread(marks, count, (size_t)field->s, field->t, false);
    spread(marks, count, (size_t)field->s * field->t, field->u, true);
}

static void sum_row(void *context, int row) {
    ErrorJob *job = context;
    const Field *field = &job->encoded->field;
    size_t count = (size_t)field->u * field->s * field->t, i = 0;
    const uint8_t *marks = job->marks + count * (size_t)row,
                  *texels = job->texels + field_row(field) * (size_t)row;
    const uint8_t *below = row > 0 ? marks - count : marks,
                  *above = row + 1 < job->rows ? marks + count : marks;
    EncodedError *error = &job->of_row[row];
    for (int u = 0; u < field->u; u++)
        for (int t = 0; t < field->t; t++)
            for (int s = 0; s < field->s; s++, i++) {
                float light[3];
                double sum = 0.0;
                const uint8_t *texel = texels + FIELD_TEXEL * i;
                job->encoded->codec->decode(job->encoded, (const int[4]){u, job->first + row, s, t}, light);
                bool black = light[0] + light[1] + light[2] == 0.0f && !(texel[0] | texel[1] | texel[2]);
                for (int k = 0; k < 3 && !black; k++) {
                    double off = (double)code_of(light[k]) - texel[k];
                    sum += off * off;
                }
                error->squares += sum;
                if (!(marks[i] | below[i] | above[i])) continue;
                error->near_squares += sum;
                error->near_texels++;
            }
    error->texels = count;
}

EncodedError error_sum(EncodedError a, EncodedError b) {
    return (EncodedError){a.squares + b.squares, a.near_squares + b.near_squares, a.texels + b.texels,
                          a.near_texels + b.near_texels};
}

EncodedError encoded_error(const Encoded *encoded, int first, int rows, const uint8_t *texels) {
    const Field *field = &encoded->field;
    ErrorJob job = {encoded,
                    first,
                    rows,
                    texels,
                    allocate(field_row(field) / FIELD_TEXEL, (size_t)rows),
                    allocate((size_t)rows, sizeof(EncodedError))};
    EncodedError error = {0};
    parallel_for(rows, mark_row, &job);
    parallel_for(rows, sum_row, &job);
    for (int row = 0; row < rows; row++) error = error_sum(error, job.of_row[row]);
    free(job.marks), free(job.of_row);
    return error;
}

double squares_psnr_db(double squares, size_t texels) {
    return squares > 0.0 ? fmin(100.0, 10.0 * log10(255.0 * 255.0 * 3.0 * (double)texels / squares)) : 100.0;
}
