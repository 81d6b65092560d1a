#include "block.h"

#include "codec.h"
#include "parallel.h"

#include <math.h>
#include <string.h>

enum { TEXELS = 16, PLACES_MOST = 16, TURNS = 3 };

/* ---- What both have in common: places on a line between two colours, in codes ---- */

typedef struct {
    double end[2][3];
} Line;

/* The texel whose colour is farthest from another colour. */
static int farthest(const uint8_t patch[PATCH_BYTES], const double colour[3]) {
    int best = 0;
    double most = -1.0;
    for (int i = 0; i < TEXELS; i++) {
        double far = 0.0;
        for (int k = 0; k < 3; k++) far += (patch[3 * i + k] - colour[k]) * (patch[3 * i + k] - colour[k]);
        if (far > most) most = far, best = i;
    }
    return best;
}

/* Between the colour farthest from the mean, and the one farthest from that. */
static Line line_through(const uint8_t patch[PATCH_BYTES]) {
    double mean[3] = {0};
    Line line;
    for (int i = 0; i < TEXELS; i++)
        for (int k = 0; k < 3; k++) mean[k] += patch[3 * i + k] / (double)TEXELS;
    int a = farthest(patch, mean);
    for (int k = 0; k < 3; k++) line.end[0][k] = patch[3 * a + k];
    int b = farthest(patch, line.end[0]);
    for (int k = 0; k < 3; k++) line.end[1][k] = patch[3 * b + k];
    return line;
}

/* For each texel the nearest colour of a palette; the sum of the squared distances. */
static int choose(const uint8_t patch[PATCH_BYTES], uint8_t palette[][3], int count, uint8_t chosen[TEXELS]) {
    int sum = 0;
    for (int i = 0; i < TEXELS; i++) {
        int least = 1 << 30;
        for (int n = 0; n < count; n++) {
            int r = patch[3 * i] - palette[n][0], g = patch[3 * i + 1] - palette[n][1],
                b = patch[3 * i + 2] - palette[n][2];
            int far = r * r + g * g + b * b;
            if (far < least) least = far, chosen[i] = (uint8_t)n;
        }
        sum += least;
    }
    return sum;
}

/* The ends that are best for the places chosen: share[n] is how much of the second end colour n has, negative
 * for a colour that is not on the line. What the places do not determine stays as it is. */
static void fit_line(const uint8_t patch[PATCH_BYTES], const uint8_t chosen[TEXELS], const double *share,
                     Line *line) {
    double aa = 1e-3, ab = 0.0, bb = 1e-3, right[2][3];
    for (int k = 0; k < 3; k++)
        for (int e = 0; e < 2; e++) right[e][k] = 1e-3 * line->end[e][k];
    for (int i = 0; i < TEXELS; i++) {
        double b = share[chosen[i]], a = 1.0 - b;
        if (b < 0.0) continue;
        aa += a * a, ab += a * b, bb += b * b;
        for (int k = 0; k < 3; k++) right[0][k] += a * patch[3 * i + k], right[1][k] += b * patch[3 * i + k];
    }
    double determinant = aa * bb - ab * ab;
    for (int k = 0; k < 3; k++) {
        double a = (right[0][k] * bb - right[1][k] * ab) / determinant;
        double b = (right[1][k] * aa - right[0][k] * ab) / determinant;
        line->end[0][k] = fmin(fmax(a, 0.0), 255.0), line->end[1][k] = fmin(fmax(b, 0.0), 255.0);
    }
}

/* ---- bc1 ---- */

static const int bc1_bits[3] = {5, 6, 5}, bc1_shift[3] = {11, 5, 0};

static int widened(int value, int bits) { return value << (8 - bits) | value >> (2 * bits - 8); }

static void bc1_palette(const int colours[2], uint8_t palette[4][3]) {
    for (int k = 0; k < 3; k++) {
        int end[2];
        for (int e = 0; e < 2; e++)
            end[e] = widened(colours[e] >> bc1_shift[k] & ((1 << bc1_bits[k]) - 1), bc1_bits[k]);
        palette[0][k] = (uint8_t)end[0], palette[1][k] = (uint8_t)end[1];
        if (colours[0] > colours[1]) {
            palette[2][k] = (uint8_t)((2 * end[0] + end[1]) / 3);
            palette[3][k] = (uint8_t)((end[0] + 2 * end[1]) / 3);
        } else {
            palette[2][k] = (uint8_t)((end[0] + end[1]) / 2);
            palette[3][k] = 0;
        }
    }
}

static int bc1_colour(const double colour[3]) {
    int packed = 0;
    for (int k = 0; k < 3; k++)
        packed |= (int)lrint(colour[k] / 255.0 * ((1 << bc1_bits[k]) - 1)) << bc1_shift[k];
    return packed;
}

typedef struct {
    int colours[2], error;
    uint8_t chosen[TEXELS];
} Bc1;

static void bc1_try(const uint8_t patch[PATCH_BYTES], int first, int second, bool four, Bc1 *best) {
    uint8_t palette[4][3];
    Bc1 tried = {.colours = {first, second}};
    if ((first > second) != four)
        tried.colours[0] = second, tried.colours[1] = first; /* the order says which */
    if (four && first == second) return;
    bc1_palette(tried.colours, palette);
    tried.error = choose(patch, palette, 4, tried.chosen);
    if (tried.error < best->error) *best = tried;
}

/* Lines through the colours, then a step up or down of any channel of either colour, as long as it helps. */
void bc1_encode(const uint8_t patch[PATCH_BYTES], uint8_t block[BC1_BYTES]) {
    static const double shares[2][4] = {{0, 1, 0.5, -1}, {0, 1, 1 / 3.0, 2 / 3.0}};
    Bc1 best = {.error = 1 << 30};
    for (int four = 0; four < 2; four++) {
        Line line = line_through(patch);
        for (int turn = 0; turn < TURNS; turn++) {
            Bc1 found = {.error = 1 << 30};
            bc1_try(patch, bc1_colour(line.end[0]), bc1_colour(line.end[1]), four, &found);
            if (found.error == 1 << 30) break;
            if (found.error < best.error) best = found;
            fit_line(patch, found.chosen, shares[four], &line);
        }
    }
    for (int before = best.error + 1; best.error < before && best.error > 0;) {
        before = best.error;
        Bc1 from = best;
        bool four = from.colours[0] > from.colours[1];
        for (int e = 0; e < 2; e++)
            for (int k = 0; k < 3; k++)
                for (int step = -1; step <= 1; step += 2) {
                    int most = (1 << bc1_bits[k]) - 1,
                        value = (from.colours[e] >> bc1_shift[k] & most) + step;
                    if (value < 0 || value > most) continue;
                    int moved = from.colours[e] + step * (1 << bc1_shift[k]);
                    bc1_try(patch, e ? from.colours[0] : moved, e ? moved : from.colours[1], four, &best);
                }
    }
    memset(block, 0, BC1_BYTES);
    for (int e = 0; e < 2; e++)
        block[2 * e] = (uint8_t)best.colours[e], block[2 * e + 1] = (uint8_t)(best.colours[e] >> 8);
    for (int i = 0; i < TEXELS; i++) block[4 + i / 4] |= (uint8_t)(best.chosen[i] << 2 * (i % 4));
}

void bc1_decode(const uint8_t block[BC1_BYTES], int texel, uint8_t colour[3]) {
    uint8_t palette[4][3];
    const int colours[2] = {block[0] | block[1] << 8, block[2] | block[3] << 8};
    bc1_palette(colours, palette);
    memcpy(colour, palette[block[4 + texel / 4] >> 2 * (texel % 4) & 3], 3);
}

/* ---- bc7, mode 6 ---- */

static const int bc7_weights[PLACES_MOST] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

typedef struct {
    int end[2][3], low[2], error; /* seven bits a channel, and the bit below them */
    uint8_t chosen[TEXELS];
} Bc7;

static void bc7_colour(const Bc7 *bc7, int place, uint8_t colour[3]) {
    int weight = bc7_weights[place];
    for (int k = 0; k < 3; k++) {
        int a = bc7->end[0][k] << 1 | bc7->low[0], b = bc7->end[1][k] << 1 | bc7->low[1];
        colour[k] = (uint8_t)(((64 - weight) * a + weight * b + 32) >> 6);
    }
}

static void bits_put(uint8_t *bytes, int *at, int count, int value) {
    for (int i = 0; i < count; i++, (*at)++) bytes[*at / 8] |= (uint8_t)((value >> i & 1) << *at % 8);
}

static int bits_get(const uint8_t *bytes, int *at, int count) {
    int value = 0;
    for (int i = 0; i < count; i++, (*at)++) value |= (bytes[*at / 8] >> *at % 8 & 1) << i;
    return value;
}

void bc7_encode(const uint8_t patch[PATCH_BYTES], uint8_t block[BC7_BYTES]) {
    double shares[PLACES_MOST];
    for (int n = 0; n < PLACES_MOST; n++) shares[n] = bc7_weights[n] / 64.0;
    Bc7 best = {.error = 1 << 30};
    for (int low = 0; low < 4; low++) {
        Line line = line_through(patch);
        for (int turn = 0; turn < TURNS; turn++) {
            uint8_t palette[PLACES_MOST][3];
            Bc7 tried = {.low = {low & 1, low >> 1}};
            for (int e = 0; e < 2; e++)
                for (int k = 0; k < 3; k++) {
                    long value = lrint((line.end[e][k] - tried.low[e]) / 2.0);
                    tried.end[e][k] = (int)(value < 0 ? 0 : value > 127 ? 127 : value);
                }
            for (int n = 0; n < PLACES_MOST; n++) bc7_colour(&tried, n, palette[n]);
            tried.error = choose(patch, palette, PLACES_MOST, tried.chosen);
            if (tried.error < best.error) best = tried;
            fit_line(patch, tried.chosen, shares, &line);
        }
    }
    int first = best.chosen[0] >= PLACES_MOST / 2,
        at = 0; /* which end goes first, so that the top bit is 0 */
    memset(block, 0, BC7_BYTES);
    bits_put(block, &at, 7, 1 << 6); /* the mode */
    for (int k = 0; k < 3; k++)
        for (int e = 0; e < 2; e++) bits_put(block, &at, 7, best.end[e ^ first][k]);
    for (int e = 0; e < 2; e++) bits_put(block, &at, 7, 127); /* alpha */
    for (int e = 0; e < 2; e++) bits_put(block, &at, 1, best.low[e ^ first]);
    for (int i = 0; i < TEXELS; i++)
        bits_put(block, &at, i ? 4 : 3, first ? PLACES_MOST - 1 - best.chosen[i] : best.chosen[i]);
}

bool bc7_decode(const uint8_t block[BC7_BYTES], int texel, uint8_t colour[3]) {
    Bc7 bc7;
    int at = 0;
    if (bits_get(block, &at, 7) != 1 << 6) return false;
    for (int k = 0; k < 3; k++)
        for (int e = 0; e < 2; e++) bc7.end[e][k] = bits_get(block, &at, 7);
    at += 14;
    for (int e = 0; e < 2; e++) bc7.low[e] = bits_get(block, &at, 1);
    at += texel ? 4 * texel - 1 : 0;
    bc7_colour(&bc7, bits_get(block, &at, texel ? 4 : 3), colour);
    return true;
}

/* ---- Bands ---- */

typedef struct {
    const Encoded *encoded;
    const uint8_t *texels;
    int rows;
    Blocks blocks;
    uint8_t *to;
} BandJob;

static int bytes_of(const Codec *codec) { return codec == &codec_bc1 ? BC1_BYTES : BC7_BYTES; }

static void encode_column(void *context, int u) {
    BandJob *job = context;
    const Codec *codec = job->encoded->codec;
    uint8_t patch[PATCH_BYTES], black[BC7_BYTES];
    memset(patch, 0, sizeof patch);
    codec == &codec_bc1 ? bc1_encode(patch, black) : bc7_encode(patch, black);
    for (int t = 0; t < job->blocks.t; t++)
        for (int s = 0; s < job->blocks.s; s++) {
            uint8_t *to = job->to + (size_t)bytes_of(codec) * block_number(&job->blocks, u, 0, s, t);
            patch_read(&job->encoded->field, job->rows, job->texels, u * PATCH_SIDE, s, t, patch);
            if (patch_black(patch))
                memcpy(to, black, (size_t)bytes_of(codec));
            else if (codec == &codec_bc1)
                bc1_encode(patch, to);
            else
                bc7_encode(patch, to);
        }
}

static void block_encode(Encoded *encoded, int band, int rows, const uint8_t *texels) {
    (void)band;
    Blocks blocks = encoded->blocks;
    size_t bytes = (size_t)bytes_of(encoded->codec) * (size_t)blocks.u * (size_t)blocks.s * (size_t)blocks.t;
    BandJob job = {encoded, texels, rows, blocks, plane_extend(&encoded->planes[0], bytes)};
    parallel_for(blocks.u, encode_column, &job);
}

static void block_decode(const Encoded *encoded, const int at[4], float *light) {
    Blocks blocks = encoded->blocks;
    size_t number = block_number(&blocks, at[0] / PATCH_SIDE, at[1] / PATCH_SIDE, at[2], at[3]);
    const uint8_t *block = plane_at(&encoded->planes[0], (size_t)bytes_of(encoded->codec) * number);
    int texel = at[1] % PATCH_SIDE * PATCH_SIDE + at[0] % PATCH_SIDE;
    uint8_t colour[3] = {0};
    if (encoded->codec == &codec_bc1)
        bc1_decode(block, texel, colour);
    else
        bc7_decode(block, texel, colour);
    for (int k = 0; k < 3; k++) light[k] = light_of(colour[k]);
}

static int64_t block_size(const Encoded *encoded, int plane, int band) {
    (void)plane, (void)band;
    Blocks blocks = encoded->blocks;
    return (int64_t)bytes_of(encoded->codec) * blocks.u * blocks.s * blocks.t;
}

static bool bc1_refers(const Encoded *encoded) {
    (void)encoded; /* any bits are a block */
    return true;
}

static bool bc7_refers(const Encoded *encoded) {
    const Plane *plane = &encoded->planes[0];
    for (size_t i = 0; i < plane->bytes; i += BC7_BYTES)
        if ((plane->data[i] & 127) != 1 << 6) return false;
    return true;
}

const Codec codec_bc1 = {.name = "bc1",
                         .number = 1,
                         .block = {PATCH_SIDE, PATCH_SIDE, 1, 1},
                         .knobs = {4, 4},
                         .planes = {{.tag = FIELD_TAG('B', 'L', 'C', 'K')}},
                         .encode = block_encode,
                         .decode = block_decode,
                         .size = block_size,
                         .refers = bc1_refers};
const Codec codec_bc7 = {.name = "bc7",
                         .number = 2,
                         .block = {PATCH_SIDE, PATCH_SIDE, 1, 1},
                         .knobs = {8, 8},
                         .planes = {{.tag = FIELD_TAG('B', 'L', 'C', 'K')}},
                         .encode = block_encode,
                         .decode = block_decode,
                         .size = block_size,
                         .refers = bc7_refers};
