/* The codecs against fields that are known: what is decoded is held against what was encoded, in C and by
 * OpenGL; nothing is read across a block's border, no two axes are mistaken for each other, and files are
 * what was in memory. */
#define _GNU_SOURCE /* mkdtemp */
#include "block.h"
#include "codec.h"
#include "context.h"
#include "draw.h"
#include "fail.h"
#include "files.h"
#include "image.h"
#include "ramp.h"
#include "shown.h"
#include "synthesis.h"
#include "vq.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../tests/random.h"

static const Codec *const codecs[] = {&codec_bc1, &codec_bc7, &codec_vq, &codec_ramp};
enum { CODECS = 4 };
static const int knobs[CODECS] = {4, 8, 10, 4};

/* ---- Fields ---- */

typedef void (*Content)(int u, int v, int s, int t, uint8_t texel[3]);

static Field field_of(int u, int v, int s, int t) {
    return (Field){.model = FIELD_SPHERE, .radius = 3.5, .u = u, .v = v, .s = s, .t = t};
}

static size_t texel_at(const Field *field, const int at[4]) {
    return 3 * ((((size_t)at[1] * (size_t)field->u + (size_t)at[0]) * (size_t)field->t + (size_t)at[3]) *
                    (size_t)field->s +
                (size_t)at[2]);
}

static bool next_place(const Field *field, int at[4]) {
    const int count[4] = {field->u, field->v, field->s, field->t};
    for (int k = 0; k < 4; at[k++] = 0)
        if (++at[k] < count[k]) return true;
    return false;
}

static uint8_t *field_fill(const Field *field, Content content) {
    uint8_t *texels = allocate((size_t)field->v, field_row(field));
    int at[4] = {0};
    do content(at[0], at[1], at[2], at[3], texels + texel_at(field, at));
    while (next_place(field, at));
    return texels;
}

static void black(int u, int v, int s, int t, uint8_t texel[3]) {
    (void)u, (void)v, (void)s, (void)t;
    memset(texel, 0, 3);
}

static void one_colour(int u, int v, int s, int t, uint8_t texel[3]) {
    (void)u, (void)v, (void)s, (void)t;
    texel[0] = 200, texel[1] = 100, texel[2] = 50;
}

static void noise(int u, int v, int s, int t, uint8_t texel[3]) {
    (void)u, (void)v, (void)s, (void)t;
    for (int k = 0; k < 3; k++) texel[k] = (uint8_t)random_in(0, 256);
}

/* A colour of its own for each block of 8 x 8 x 2 x 2, none alike along any axis. */
static void patches(int u, int v, int s, int t, uint8_t texel[3]) {
    texel[0] = (uint8_t)(40 + 50 * (u / 8) + 10 * (v / 8));
    texel[1] = (uint8_t)(30 + 40 * (s / 2));
    texel[2] = (uint8_t)(20 + 35 * (t / 2));
}

/* Red, but for one blue texel in the corner of each block on this side of all borders. */
static void corners(int u, int v, int s, int t, uint8_t texel[3]) {
    bool corner = u % 8 == 7 && v % 8 == 7 && s % 2 == 1 && t % 2 == 1;
    texel[0] = corner ? 0 : 255, texel[1] = 0, texel[2] = corner ? 255 : 0;
}

/* One ramp over all of the field, steeper along one axis than along another. */
static void plane(int u, int v, int s, int t, uint8_t texel[3]) {
    double share = 0.15 + 0.005 * u + 0.011 * v + 0.021 * s + 0.031 * t;
    texel[0] = texel[1] = srgb_byte((float)(share * share));
    texel[2] = 60;
}

static Encoded encode(const Codec *codec, int knob, const Field *field, const uint8_t *texels) {
    FieldTexels whole = {field, texels};
    FieldSource source = {field_texels_rows, &whole};
    return encoded_make(codec, field, knob, &source);
}

static double worst(const Encoded *encoded, const uint8_t *texels) {
    double most = 0.0;
    int at[4] = {0};
    do {
        float light[3];
        encoded->codec->decode(encoded, at, light);
        for (int k = 0; k < 3; k++) {
            double off =
                fabs(255.0 * srgb_encode(light[k]) - texels[texel_at(&encoded->field, at) + (size_t)k]);
            most = off > most || isnan(off) ? off : most;
        }
    } while (next_place(&encoded->field, at));
    return most;
}

/* ---- What comes back ---- */

static const Field sizes[] = {{.u = 8, .v = 8, .s = 8, .t = 8},
                              {.u = 18, .v = 9, .s = 9, .t = 11},
                              {.u = 10, .v = 15, .s = 13, .t = 8},
                              {.u = 34, .v = 8, .s = 8, .t = 9}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static void check_worst(Content content, const double bounds[CODECS]) {
    for (int size = 0; size < SIZES; size++)
        for (int c = 0; c < CODECS; c++) {
            Field field = field_of(sizes[size].u, sizes[size].v, sizes[size].s, sizes[size].t);
            seed = 7;
            uint8_t *texels = field_fill(&field, content);
            Encoded encoded = encode(codecs[c], knobs[c], &field, texels);
            assert_true(encoded.codec->refers(&encoded));
            double most = worst(&encoded, texels);
            if (!(most <= bounds[c]))
                fail_msg("%s: off by %g codes, not %g", codecs[c]->name, most, bounds[c]);
            encoded_destroy(&encoded);
            free(texels);
        }
}

static void black_stays_black(void **state) {
    (void)state;
    check_worst(black, (const double[]){0, 0, 0, 0});
}

/* bc1 has 5 bits of red, and is within half a step; a root of 1/127 is up to 2.5 codes. */
static void one_colour_stays(void **state) {
    (void)state;
    check_worst(one_colour, (const double[]){3, 1.01, 0.01, 1.3});
}

static void noise_is_bounded(void **state) {
    (void)state;
    check_worst(noise, (const double[]){255, 255, 255, 255});
}

/* Blocks of one colour each: who reads one across a border, or takes one axis for another, is off by 10 or
 * more. */
static void blocks_keep_their_colours(void **state) {
    (void)state;
    check_worst(patches, (const double[]){5, 1.01, 0.01, 1.3});
}

/* Two colours in a block, one of them at a corner: ramps as steep as that, and every code's order. */
static void corners_stay(void **state) {
    (void)state;
    check_worst(corners, (const double[]){0.01, 1.01, 0.01, 1});
}

static void a_plane_is_one_leaf(void **state) {
    (void)state;
    Field field = field_of(16, 8, 8, 8);
    uint8_t *texels = field_fill(&field, plane);
    Encoded encoded = encode(&codec_ramp, 8, &field, texels);
    assert_true(worst(&encoded, texels) < 2.6);
    for (size_t i = 0; i < encoded.planes[0].bytes; i += 4)
        assert_int_equal(encoded.planes[0].data[i] & 63, 0);
    encoded_destroy(&encoded);
    free(texels);
}

/* More leaves are never worse, and a lower tolerance makes more. */
static void tolerance_trades(void **state) {
    (void)state;
    Field field = field_of(64, 32, 16, 16);
    uint8_t *texels = allocate((size_t)field.v, field_row(&field));
    Synthesis *synthesis = synthesis_create(&field, &light_composed, 3, false);
    synthesis_rows(synthesis, 0, field.v, texels, NULL);
    synthesis_destroy(synthesis);
    size_t bytes = 0;
    double squares = 0.0;
    for (int knob = 1; knob <= 256; knob *= 4) {
        Encoded encoded = encode(&codec_ramp, knob, &field, texels);
        EncodedError error = encoded_error(&encoded, 0, field.v, texels);
        if (bytes) assert_true(encoded.planes[1].bytes < bytes && error.squares > squares);
        bytes = encoded.planes[1].bytes, squares = error.squares;
        encoded_destroy(&encoded);
    }
    free(texels);
}

/* Four colours that are on no line: one for each two texels along u, or along v, or for each of the four (s,
 * t). */
static const uint8_t four_colours[4][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};
static void along_u(int u, int v, int s, int t, uint8_t texel[3]) {
    (void)v, (void)s, (void)t;
    memcpy(texel, four_colours[u / 2 % 4], 3);
}
static void along_v(int u, int v, int s, int t, uint8_t texel[3]) {
    (void)u, (void)s, (void)t;
    memcpy(texel, four_colours[v / 2 % 4], 3);
}
static void along_s_and_t(int u, int v, int s, int t, uint8_t texel[3]) {
    (void)u, (void)v;
    memcpy(texel, four_colours[s % 2 + t % 2 * 2], 3);
}

/* A block is cut across the axis along which it changes, as often as is needed and no more. */
static void blocks_are_cut_where_they_change(void **state) {
    (void)state;
    const Content contents[] = {along_u, along_v, along_s_and_t};
    const int halvings[][2] = {{1, 1}, {1 << 2, 1 << 2}, {1 << 4, 1 << 5}}; /* s and t do as well */
    Field field = field_of(8, 8, 8, 8);
    for (int i = 0; i < 3; i++) {
        uint8_t *texels = field_fill(&field, contents[i]);
        Encoded encoded = encode(&codec_ramp, 8, &field, texels);
        near(worst(&encoded, texels), 0, 1);
        assert_int_equal(encoded.planes[1].bytes, 3 * RAMP_LEAF_BYTES); /* two of two colours, and black */
        for (size_t n = 0; n < encoded.planes[0].bytes; n += 4) {
            int halved = encoded.planes[0].data[n] & 63;
            assert_true(halved == halvings[i][0] || halved == halvings[i][1]);
        }
        encoded_destroy(&encoded);
        free(texels);
    }
}

/* Equal blocks of a band share their leaves. */
static void equal_blocks_share(void **state) {
    (void)state;
    Field field = field_of(32, 16, 8, 8);
    uint8_t *texels = field_fill(&field, corners);
    Field small = field_of(8, 8, 8, 8);
    uint8_t *fewer = field_fill(&small, corners);
    Encoded encoded = encode(&codec_ramp, 4, &field, texels), one = encode(&codec_ramp, 4, &small, fewer);
    size_t of_block = one.planes[1].bytes - RAMP_LEAF_BYTES;
    assert_in_range(of_block, RAMP_LEAF_BYTES, 4 * RAMP_LEAF_BYTES);
    free(fewer);
    assert_int_equal(encoded.planes[1].bytes, RAMP_LEAF_BYTES + 2 * of_block);
    encoded_destroy(&encoded), encoded_destroy(&one);
    free(texels);
}

/* ---- Vector quantization ---- */

static uint8_t *composed(const Field *field) {
    uint8_t *texels = allocate((size_t)field->v, field_row(field));
    Synthesis *synthesis = synthesis_create(field, &light_composed, 3, false);
    synthesis_rows(synthesis, 0, field->v, texels, NULL);
    synthesis_destroy(synthesis);
    return texels;
}

static void training_falls_and_repeats(void **state) {
    (void)state;
    Field field = field_of(64, 32, 16, 16);
    uint8_t *texels = composed(&field);
    Encoded one = encode(&codec_vq, 9, &field, texels), other = encode(&codec_vq, 9, &field, texels);
    assert_in_range(one.rounds, 9, 12);
    for (int i = 0; i + 1 < one.rounds; i++) assert_true(one.mean_error[i + 1] < one.mean_error[i]);
    assert_true(one.mean_error[one.rounds - 1] > 0.0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(one.planes[i].bytes, other.planes[i].bytes);
        assert_memory_equal(one.planes[i].data, other.planes[i].data, one.planes[i].bytes);
    }
    encoded_destroy(&one), encoded_destroy(&other);
    free(texels);
}

/* Each block's code is the nearest of all, by trying them all. */
static void codes_are_the_nearest(void **state) {
    (void)state;
    Field field = field_of(32, 16, 16, 16);
    uint8_t *texels = composed(&field), patch[PATCH_BYTES];
    Encoded encoded = encode(&codec_vq, 8, &field, texels);
    const Plane *book = &encoded.planes[0], *codes = &encoded.planes[1];
    Blocks blocks = codec_blocks(&codec_vq, &field);
    for (int v = 0; v < blocks.v; v++)
        for (int u = 0; u < blocks.u; u++)
            for (int t = 0; t < field.t; t++)
                for (int s = 0; s < field.s; s++) {
                    patch_read(&field, 4, texels + field_row(&field) * 4 * (size_t)v, 4 * u, s, t, patch);
                    long least = -1, chosen = -1;
                    for (size_t c = 0; c < book->bytes / PATCH_BYTES; c++) {
                        long sum = 0;
                        for (int k = 0; k < PATCH_BYTES; k++) {
                            long off = patch[k] - book->data[c * PATCH_BYTES + (size_t)k];
                            sum += off * off;
                        }
                        if (least < 0 || sum < least) least = sum;
                        if (c == codes->data[block_number(&blocks, u, v, s, t)]) chosen = sum;
                    }
                    assert_int_equal(chosen, least);
                }
    encoded_destroy(&encoded);
    free(texels);
}

/* ---- The GPU's blocks, by their specifications ---- */

static void bc1_all(const uint8_t block[BC1_BYTES], uint8_t patch[48]) {
    for (int i = 0; i < 16; i++) bc1_decode(block, i, patch + 3 * i);
}

static void bc7_all(const uint8_t block[BC7_BYTES], uint8_t patch[48]) {
    for (int i = 0; i < 16; i++) assert_true(bc7_decode(block, i, patch + 3 * i));
}

static void bc1_as_specified(void **state) {
    (void)state;
    /* Colours 31, 0, 0 and 0, 63, 31: the first is greater. A row of places 0, 1, 2, 3; then all 3. */
    const uint8_t four[BC1_BYTES] = {0x00, 0xf8, 0xff, 0x07, 0xe4, 0xff, 0x00, 0x55};
    uint8_t patch[48];
    bc1_all(four, patch);
    const uint8_t first[12] = {255, 0, 0, 0, 255, 255, 170, 85, 85, 85, 170, 170};
    for (int i = 0; i < 12; i++) near(patch[i], first[i], 1);
    assert_memory_equal(patch + 24, ((uint8_t[]){255, 0, 0, 255, 0, 0}), 6);
    assert_memory_equal(patch + 36, ((uint8_t[]){0, 255, 255, 0, 255, 255}), 6);
    const uint8_t three[BC1_BYTES] = {0xff, 0x07, 0x00, 0xf8, 0xe4, 0xff, 0x00, 0x55};
    bc1_all(three, patch);
    const uint8_t row[12] = {0, 255, 255, 255, 0, 0, 127, 127, 127, 0, 0, 0};
    for (int i = 0; i < 12; i++) near(patch[i], row[i], 1);
}

static void bc7_as_specified(void **state) {
    (void)state;
    /* Mode 6; red 0 and 127, green 127 and 0, blue 64 and 64, alpha 127 and 127; low bits 0 and 1; places 7,
     * 15, 0 ... */
    uint8_t block[BC7_BYTES] = {0};
    int at = 0;
    const struct {
        int bits, value;
    } fields[] = {{7, 64},  {7, 0}, {7, 127}, {7, 127}, {7, 0},  {7, 64}, {7, 64}, {7, 127},
                  {7, 127}, {1, 0}, {1, 1},   {3, 7},   {4, 15}, {4, 0},  {4, 8}};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        for (int bit = 0; bit < fields[i].bits; bit++, at++)
            block[at / 8] |= (uint8_t)((fields[i].value >> bit & 1) << at % 8);
    uint8_t patch[48];
    bc7_all(block, patch);
    /* weights 30, 64, 0, 34 of 64 between 0 and 255, 254 and 1, 128 and 129 */
    const uint8_t expected[12] = {120, 135, 128, 255, 1, 129, 0, 254, 128, 135, 120, 129};
    for (int i = 0; i < 12; i++) near(patch[i], expected[i], 1);
    block[0] = 0x20;
    assert_false(bc7_decode(block, 0, patch));
}

/* Blocks that were encoded once are there for the encoder to find again. */
static void blocks_encode_what_they_hold(void **state) {
    (void)state;
    seed = 3;
    double squares[2] = {0, 0};
    for (int n = 0; n < 400; n++) {
        uint8_t patch[48], again[48], bc1[BC1_BYTES], bc7[BC7_BYTES], colours[2][3];
        for (int e = 0; e < 2; e++)
            for (int k = 0; k < 3; k++) colours[e][k] = (uint8_t)random_in(0, 256);
        for (int i = 0; i < 16; i++)
            for (int k = 0; k < 3; k++) {
                int share = i % 4 * 85;
                patch[3 * i + k] = (uint8_t)((colours[0][k] * (255 - share) + colours[1][k] * share) / 255);
            }
        bc1_encode(patch, bc1), bc1_all(bc1, again);
        for (int i = 0; i < 48; i++) squares[0] += (patch[i] - again[i]) * (patch[i] - again[i]);
        bc7_encode(patch, bc7);
        bc7_all(bc7, again);
        for (int i = 0; i < 48; i++) squares[1] += (patch[i] - again[i]) * (patch[i] - again[i]);
    }
    near(sqrt(squares[0] / (400 * 48)), 0,
         1.77); /* 5 bits, rounded: 2.4; 1.81 without its steps up and down */
    near(sqrt(squares[1] / (400 * 48)), 0, 0.63); /* 0.66 if no line is fitted */
}

/* ---- Errors ---- */

static void errors_count_neighbours(void **state) {
    (void)state;
    Field field = field_of(12, 9, 8, 10);
    seed = 11;
    uint8_t *texels = field_fill(&field, black);
    for (int i = 0; i < 9; i++) {
        int at[4] = {(int)random_in(0, 12), (int)random_in(0, 9), (int)random_in(0, 8),
                     (int)random_in(0, 10)};
        if (i == 0) at[0] = 0;
        texels[texel_at(&field, at) + 1] = 200;
    }
    Encoded encoded = encode(&codec_vq, 1, &field, texels);
    EncodedError error = encoded_error(&encoded, 0, field.v, texels);
    double all = 0.0, close = 0.0;
    size_t count = 0;
    int at[4] = {0};
    do {
        int step[4];
        bool any = false;
        float light[3];
        double sum = 0.0;
        for (step[0] = -1; step[0] <= 1; step[0]++)
            for (step[1] = -1; step[1] <= 1; step[1]++)
                for (step[2] = -1; step[2] <= 1; step[2]++)
                    for (step[3] = -1; step[3] <= 1; step[3]++) {
                        int n[4] = {(at[0] + step[0] + 12) % 12, at[1] + step[1], at[2] + step[2],
                                    at[3] + step[3]};
                        if (n[1] < 0 || n[1] > 8 || n[2] < 0 || n[2] > 7 || n[3] < 0 || n[3] > 9) continue;
                        any = any || texels[texel_at(&field, n) + 1];
                    }
        codec_vq.decode(&encoded, at, light);
        for (int k = 0; k < 3; k++) {
            double off = 255.0 * srgb_encode(light[k]) - texels[texel_at(&field, at) + (size_t)k];
            sum += off * off;
        }
        all += sum;
        if (any) count++, close += sum;
    } while (next_place(&field, at));
    assert_int_equal(error.near_texels, count);
    assert_int_equal(error.texels, 12 * 9 * 8 * 10);
    assert_true(close > 0.0);
    near(error.squares, all, 1e-3 * all);
    near(error.near_squares, close, 1e-3 * close);
    near(squares_psnr_db(3.0 * 255 * 255, 100), 20.0, 1e-9);
    near(squares_psnr_db(0, 100), 100.0, 0);
    encoded_destroy(&encoded);
    free(texels);
}

static void codes_are_srgb(void **state) {
    (void)state;
    for (double light = 0.0; light <= 1.0; light += 1.0 / 4099) {
        near(code_of((float)light), 255.0 * srgb_encode(light), 2e-3);
        near(code_of_root((float)sqrt(light)), 255.0 * srgb_encode(light), 2e-3);
    }
    for (int i = 0; i < 256; i++) near(code_of(light_of((uint8_t)i)), i, 2e-3);
    for (int i = 0; i < 256; i++) near(root_of((uint8_t)i), sqrt(srgb_decode(i / 255.0)), 1e-6);
}

/* ---- By OpenGL ---- */

static char *root; /* of the tree */

/* Texel number i of a picture of WIDTH a row, u fastest, then v, s, t; step: to the one of the four that is
 * asked for */
static const char *const reading = "uniform vec4 count, across, step;\n"
                                   "layout(location = 0) out vec4 colour;\n"
                                   "vec3 texel(ivec4 at);\n"
                                   "void main() {\n"
                                   "    int i = int(gl_FragCoord.y) * 128 + int(gl_FragCoord.x);\n"
                                   "    ivec4 size = ivec4(count), at;\n"
                                   "    at.x = i % size.x, i /= size.x, at.y = i % size.y, i /= size.y, at.z "
                                   "= i % size.z, at.w = i / size.z;\n"
                                   "    colour = vec4(at.w < size.w ? texel(at) : vec3(0.0), 1.0);\n"
                                   "}\n";
static const char *const readers[CODECS] = {
    "uniform sampler2D blocks;\n#include \"blocks.glsl\"\n"
    "vec3 texel(ivec4 at) { return texelFetch(blocks, block_at(ivec2(at.xy) >> 2, ivec2(at.zw), "
    "ivec2(across.zw)) * 4 + "
    "(ivec2(at.xy) & 3), 0).rgb; }\n",
    NULL,
    "uniform usampler2D codes;\nuniform sampler2D book;\n#include \"vq.glsl\"\n"
    "vec3 texel(ivec4 at) { return vq_light(codes, book, at, ivec2(across.zw)); }\n",
    "uniform usampler2D table, leaves;\n#include \"ramp.glsl\"\n"
    "vec3 texel(ivec4 at) { return ramp_four(table, leaves, at - ivec4(step), step.zw, ivec2(across.zw)); "
    "}\n"};

/* By OpenGL the texel that is a step along s and t from the one where a shader begins, for all of which that
 * one is in the field. OSMesa decodes sRGB by a polynomial, 0.4 codes off at most, and of bc1's thirds it
 * takes the whole part. */
static void compare_shader(int c, Program *program, const Encoded *encoded, const int step[2]) {
    const Field *field = &encoded->field;
    int count = field->u * field->v * field->s * field->t, height = (count + 127) / 128;
    Target target = target_create(128, height, false);
    Picture picture = picture_create(128, height, false);
    Shown shown = shown_create(encoded);
    target_begin(&target, v3(0, 0, 0));
    program_use(program);
    shown_bind(&shown, program);
    program_vector(program, "count", field->u, field->v, field->s, field->t);
    program_vector(program, "step", 0, 0, step[0], step[1]);
    draw_everywhere();
    target_read(&target, &picture);
    int at[4] = {0}, i = 0;
    double most = 0.0;
    do {
        float light[3];
        const float *drawn = picture.colour.pixels + 3 * (size_t)i++;
        encoded->codec->decode(encoded, at, light);
        if (at[2] < step[0] || at[3] < step[1]) continue;
        for (int k = 0; k < 3; k++)
            most = fmax(most, fabs(255 * (srgb_encode(drawn[k]) - srgb_encode(light[k]))));
    } while (next_place(field, at));
    double bound = c == 0 ? 1.4 : c == 3 ? 0.02 : 0.4;
    if (!(most <= bound)) fail_msg("%s by OpenGL: %g codes off, not %g", encoded->codec->name, most, bound);
    shown_destroy(&shown);
    target_destroy(&target);
    picture_destroy(&picture);
}

static void shaders_decode_the_same(void **state) {
    (void)state;
    Context *context = context_offscreen();
    char *folder = text("%s/lessons/19-light-field-compression", root), *common = text("%s/common", root);
    for (int c = 0; c < CODECS; c++) {
        Program program = {0};
        char *shader = text("%s%s", reading, readers[c] ? readers[c] : readers[0]);
        char *log =
            program_build_text(&program, folder, common, "everywhere.vert", "reading", shader, GLSL_330);
        if (log) fail_msg("%s", log);
        for (int size = 0; size < SIZES; size++) {
            Field field = field_of(sizes[size].u, sizes[size].v, sizes[size].s, sizes[size].t);
            uint8_t *texels = size ? composed(&field) : field_fill(&field, noise);
            for (int other = 0; other < 2; other++) {
                Encoded encoded =
                    encode(codecs[c], c == 2 ? 6 + 6 * other : knobs[c] * (c == 3 && other ? 16 : 1), &field,
                           texels);
                for (int step = 0; step < (c == 3 ? 4 : 1); step++)
                    compare_shader(c, &program, &encoded, (const int[2]){step & 1, step >> 1});
                encoded_destroy(&encoded);
            }
            free(texels);
        }
        program_destroy(&program);
        free(shader);
    }
    free(folder), free(common);
    context_destroy(context);
}

/* ---- Files ---- */

static char folder[] = "/tmp/test-codec-XXXXXX";

static StreamOrder order_of(const Field *field, int c, const FieldTexels *whole) {
    FieldHeader raw = field_header(field, &light_composed, 3, false);
    return (StreamOrder){.header = encoded_header(&raw, codecs[c], knobs[c]),
                         .source = {field_texels_rows, whole},
                         .bands = codec_bands(codecs[c], field),
                         .verify = true,
                         .quiet = true};
}

static uint8_t *slurp(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = allocate(*size + 1, 1);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static void spew(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* In a file is what is in memory; bands alone decode as the whole does; and what is stopped after a band, or
 * torn at any byte, goes on to the same file. */
static void files_hold_what_memory_holds(void **state) {
    (void)state;
    Field field = field_of(34, 33, 9, 11);
    uint8_t *texels = composed(&field);
    FieldTexels whole = {&field, texels};
    char *path = text("%s/field", folder), *partial = text("%s.partial", path);
    for (int c = 0; c < CODECS; c++) {
        StreamOrder order = order_of(&field, c, &whole);
        StreamReport report = encoded_stream(path, &order);
        Encoded memory = encode(codecs[c], knobs[c], &field, texels), read;
        FieldFile file;
        assert_null(encoded_open(path, &file, &read));
        assert_int_equal(file.bytes, report.bytes);
        assert_null(encoded_read(&file, &read));
        for (int i = 0; i < PLANES_MAX; i++) {
            assert_int_equal(read.planes[i].bytes, memory.planes[i].bytes);
            if (read.planes[i].bytes)
                assert_memory_equal(read.planes[i].data, memory.planes[i].data, read.planes[i].bytes);
        }
        EncodedError error = encoded_error(&memory, 0, field.v, texels);
        near(report.error.squares, error.squares, 1e-9 * error.squares);
        assert_int_equal(report.error.texels, error.texels);
        field_file_close(&file);
        size_t size, torn_size;
        uint8_t *expected = slurp(path, &size);
        for (int cut = 0; cut < 12; cut++) {
            unlink(path);
            if (cut < 2) { /* stopped after a band */
                StreamOrder part = order;
                part.bands = 1 + cut;
                StreamReport stopped = encoded_stream(path, &part);
                assert_int_equal(stopped.done, 1 + cut);
            } else {
                spew(partial, expected, (size_t)random_in(0, (double)size));
            }
            encoded_stream(path, &order);
            uint8_t *again = slurp(path, &torn_size);
            assert_int_equal(torn_size, size);
            assert_memory_equal(again, expected, size);
            free(again);
        }
        unlink(path);
        free(expected);
        encoded_destroy(&memory), encoded_destroy(&read);
    }
    free(texels), free(path), free(partial);
}

/* Writes a file with the sections of another, one of them changed, with checksums that are right. */
static void write_changed(const char *path, const FieldFile *from, FieldHeader header, int changed,
                          uint32_t tag, const uint8_t *payload, size_t length) {
    FieldWriter writer;
    char *partial = text("%s.partial", path);
    unlink(partial);
    assert_null(field_writer_open(&writer, path, &header));
    for (int i = 0; i < from->count; i++) {
        const FieldSection *section = &from->sections[i];
        uint8_t *bytes = allocate(section->length + 1, 1);
        assert_null(field_file_section(from, i, bytes));
        if (i == changed)
            assert_null(
                field_writer_add(&writer, tag ? tag : section->tag, section->number, payload, length));
        else
            assert_null(field_writer_add(&writer, section->tag, section->number, bytes, section->length));
        free(bytes);
    }
    assert_null(field_writer_finish(&writer));
    field_writer_close(&writer);
    free(partial);
}

/* The reason for which a file is refused, or "" where it is not, after all of it was decoded. */
static const char *tried(const char *path) {
    FieldFile file;
    Encoded encoded;
    const char *refused = encoded_open(path, &file, &encoded);
    if (refused) return refused;
    refused = encoded_read(&file, &encoded);
    int at[4] = {0};
    float sum = 0.0f;
    if (!refused) do {
            float light[3];
            encoded.codec->decode(&encoded, at, light);
            sum += light[0] + light[1] + light[2];
        } while (next_place(&encoded.field, at));
    for (int band = 0; !refused && band < codec_bands(encoded.codec, &encoded.field); band++)
        refused = encoded_read_band(&file, &encoded, band);
    assert_true(isfinite(sum));
    encoded_destroy(&encoded);
    field_file_close(&file);
    return refused ? refused : "";
}

static void broken_files_are_told(void **state) {
    (void)state;
    Field field = field_of(16, 9, 8, 8);
    uint8_t *texels = composed(&field), zeros[64] = {0};
    FieldTexels whole = {&field, texels};
    char *path = text("%s/good", folder), *bad = text("%s/bad", folder);
    for (int c = 0; c < CODECS; c++) {
        StreamOrder order = order_of(&field, c, &whole);
        unlink(path);
        encoded_stream(path, &order);
        assert_string_equal(tried(path), "");
        FieldFile file;
        Encoded encoded;
        assert_null(encoded_open(path, &file, &encoded));
        FieldHeader header = file.header;
        size_t length = file.sections[0].length;
        uint8_t *payload = allocate(length + 16, 1);
        assert_null(field_file_section(&file, 0, payload));
        write_changed(bad, &file, header, -1, 0, NULL, 0);
        assert_string_equal(tried(bad), "");
        write_changed(bad, &file, header, 0, FIELD_TAG('N', 'O', 'N', 'E'), payload, length);
        assert_non_null(strstr(tried(bad), "section 0 is not what"));
        write_changed(bad, &file, header, c == 2 ? 1 : 0, 0, zeros, 3);
        assert_non_null(strstr(tried(bad), "has 3 bytes, not"));
        header.parameters[0] = 1000;
        write_changed(bad, &file, header, -1, 0, NULL, 0);
        assert_non_null(strstr(tried(bad), "with the knob 1000"));
        header = file.header, header.parameters[3]++;
        write_changed(bad, &file, header, -1, 0, NULL, 0);
        assert_non_null(strstr(tried(bad), "blocks of another size"));
        header = file.header, header.codec = 77;
        write_changed(bad, &file, header, -1, 0, NULL, 0);
        assert_non_null(strstr(tried(bad), "which this program does not know"));
        header = file.header, header.field.v = 200;
        write_changed(bad, &file, header, -1, 0, NULL, 0);
        assert_non_null(strstr(tried(bad), "sections"));
        header.field.v = 8;
        write_changed(bad, &file, header, -1, 0, NULL, 0);
        assert_non_null(strstr(tried(bad), "sections"));
        if (c == 3) { /* an entry beyond all leaves */
            memset(payload, 0xff, 4);
            write_changed(bad, &file, file.header, 0, 0, payload, length);
            assert_string_equal(tried(bad), "broken: it refers to what is not there");
            uint32_t last = (uint32_t)file.sections[1].length / RAMP_LEAF_BYTES, entry = last << 6;
            memcpy(payload, &entry, 4);
            write_changed(bad, &file, file.header, 0, 0, payload, length);
            assert_string_equal(tried(bad), "broken: it refers to what is not there");
            entry = (last - 1) << 6;
            memcpy(payload, &entry, 4);
            write_changed(bad, &file, file.header, 0, 0, payload, length);
            assert_string_equal(tried(bad), "");
            entry |= 1; /* two leaves, of which the second is not there */
            memcpy(payload, &entry, 4);
            write_changed(bad, &file, file.header, 0, 0, payload, length);
            assert_string_equal(tried(bad), "broken: it refers to what is not there");
        }
        if (c == 2) { /* a codebook with a code less, and one of half a code */
            write_changed(bad, &file, file.header, 0, 0, payload, length - 48);
            assert_string_equal(tried(bad), "broken: it refers to what is not there");
            write_changed(bad, &file, file.header, 0, 0, payload, length - 24);
            assert_string_equal(tried(bad), "broken: it refers to what is not there");
        }
        free(payload);
        field_file_close(&file);
        unlink(path), unlink(bad);
    }
    free(texels), free(path), free(bad);
}

/* Bytes changed anywhere, files cut short, and sections of noise with right checksums: refused or decoded,
 * never more. */
static void noise_in_files_is_harmless(void **state) {
    (void)state;
    Field field = field_of(8, 8, 8, 8);
    uint8_t *texels = composed(&field);
    FieldTexels whole = {&field, texels};
    char *path = text("%s/good", folder), *bad = text("%s/bad", folder);
    int refused = 0, decoded = 0;
    seed = 99;
    for (int c = 0; c < CODECS; c++) {
        StreamOrder order = order_of(&field, c, &whole);
        unlink(path);
        encoded_stream(path, &order);
        size_t size;
        uint8_t *good = slurp(path, &size);
        for (int n = 0; n < 250; n++) {
            uint8_t *bytes = allocate(size + 64, 1);
            memcpy(bytes, good, size);
            size_t length = n % 5 == 4 ? (size_t)random_in(0, (double)size + 64) : size;
            for (int k = 0; k < 1 + n % 7 && n % 5 < 4; k++)
                bytes[(size_t)random_in(0, n % 2 ? (double)size : fmin((double)size, 200))] =
                    (uint8_t)random_in(0, 256);
            spew(bad, bytes, length);
            *tried(bad) ? refused++ : decoded++;
            free(bytes);
        }
        FieldFile file;
        Encoded encoded;
        assert_null(encoded_open(path, &file, &encoded));
        for (int n = 0; n < 100; n++) {
            int changed = (int)random_in(0, file.count);
            size_t length = file.sections[changed].length;
            uint8_t *payload = allocate(length + 1, 1);
            assert_null(field_file_section(&file, changed, payload));
            for (size_t i = 0; i < length; i++)
                if (n % 3 == 0 || random_in(0, 1) < 0.02) payload[i] = (uint8_t)random_in(0, 256);
            write_changed(bad, &file, file.header, changed, 0, payload, length);
            *tried(bad) ? refused++ : decoded++;
            free(payload);
        }
        field_file_close(&file);
        free(good);
        unlink(path), unlink(bad);
    }
    assert_int_equal(refused + decoded, 1400);
    assert_true(refused > 900 && decoded > 50);
    free(texels), free(path), free(bad);
}

int main(void) {
    char program[4096] = {0}, lessons[sizeof program + 16];
    if (readlink("/proc/self/exe", program, sizeof program - 1) < 0) return 1;
    root = program;
    do { /* up to the folder that holds lessons/ */
        *strrchr(root, '/') = '\0';
        snprintf(lessons, sizeof lessons, "%s/lessons", root);
    } while (access(lessons, R_OK) != 0);
    if (!mkdtemp(folder)) return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(black_stays_black),
        cmocka_unit_test(one_colour_stays),
        cmocka_unit_test(noise_is_bounded),
        cmocka_unit_test(blocks_keep_their_colours),
        cmocka_unit_test(corners_stay),
        cmocka_unit_test(a_plane_is_one_leaf),
        cmocka_unit_test(tolerance_trades),
        cmocka_unit_test(blocks_are_cut_where_they_change),
        cmocka_unit_test(equal_blocks_share),
        cmocka_unit_test(training_falls_and_repeats),
        cmocka_unit_test(codes_are_the_nearest),
        cmocka_unit_test(bc1_as_specified),
        cmocka_unit_test(bc7_as_specified),
        cmocka_unit_test(blocks_encode_what_they_hold),
        cmocka_unit_test(errors_count_neighbours),
        cmocka_unit_test(codes_are_srgb),
        cmocka_unit_test(shaders_decode_the_same),
        cmocka_unit_test(files_hold_what_memory_holds),
        cmocka_unit_test(broken_files_are_told),
        cmocka_unit_test(noise_in_files_is_harmless),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    rmdir(folder);
    return failed;
}
