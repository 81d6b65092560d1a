/* Codecs of light fields: what an encoder in C writes, so that a shader can find any texel with a few
 * fetches.
 *
 * All cut the field into small blocks of all four dimensions. A band is as many rows of v as a block has;
 * bands are encoded one after another, each from its own texels alone, so that a field that never is in
 * memory as a whole can be encoded, and the work can stop between two bands and go on later. What has been
 * encoded lies in planes, which are the shader's textures: row for row, band after band, as it is in a file.
 */
#ifndef LESSON_CODEC_H
#define LESSON_CODEC_H

#include "field_file.h"
#include "light_field.h"

#include <stddef.h>

typedef struct {
    uint32_t tag;       /* of its sections in a file: one for each band, but a codebook has one in all */
    bool whole;         /* it is made before the first band, and stays */
    size_t before;      /* bytes of bands that were encoded earlier and are here no more (in a stream) */
    size_t bytes, room; /* in use, and allocated */
    uint8_t *data;
} Plane;

enum { PLANES_MAX = 2 };

typedef struct Codec Codec;

/* Blocks along each axis; the last ones of an axis may stick out of the field. */
typedef struct {
    int u, v, s, t;
} Blocks;

typedef struct {
    const Codec *codec;
    Field field;
    Blocks blocks;
    int knob; /* as the technique's: what it means is the codec's affair */
    Plane planes[PLANES_MAX];
    double mean_error[16]; /* vector quantization: of the training, squared codes a texel, after each round */
    int rounds;
} Encoded;

/* Where an encoder gets texels: rows of v, as synthesis_rows makes them. Those who train on a sample ask for
 * some rows before the bands. */
typedef struct {
    void (*rows)(const void *data, int first, int rows, uint8_t *texels);
    const void *data;
} FieldSource;

struct Codec {
    const char *name;
    uint32_t number;          /* in files */
    Blocks block;             /* texels of a block along each axis; block.v is a band's rows */
    int knobs[2];             /* the least and the most */
    Plane planes[PLANES_MAX]; /* tags, and which is whole; ended by a tag 0 */
    /* Before the first band; NULL: nothing is to be done. */
    void (*begin)(Encoded *encoded, const FieldSource *source);
    /* Appends a band to the planes: rows of v from band * block.v on, fewer than block.v where the field
     * ends. */
    void (*encode)(Encoded *encoded, int band, int rows, const uint8_t *texels);
    /* One texel in linear light, three numbers. It must be in the planes, and they be checked. */
    void (*decode)(const Encoded *encoded, const int at[4], float *light);
    /* The bytes that a plane has for a band, or -1 where it is not for the header to say; a whole plane's. */
    int64_t (*size)(const Encoded *encoded, int plane, int band);
    /* Whether nothing in the planes refers to what is not in them. */
    bool (*refers)(const Encoded *encoded);
};

extern const Codec codec_bc1, codec_bc7, codec_vq, codec_ramp;

/* The codec of that name or number, or NULL. */
const Codec *codec_named(const char *name);
const Codec *codec_numbered(uint32_t number);

static inline int blocks_along(int texels, int block) { return (texels + block - 1) / block; }
Blocks codec_blocks(const Codec *codec, const Field *field);
static inline int codec_bands(const Codec *codec, const Field *field) {
    return blocks_along(field->v, codec->block.v);
}

/* The number of a block in its plane: row by row of a picture of codec_blocks u * s columns, v * t rows; s
 * and t go fastest. */
static inline size_t block_number(const Blocks *blocks, int u, int v, int s, int t) {
    return (((size_t)v * (size_t)blocks->t + (size_t)t) * (size_t)blocks->u + (size_t)u) * (size_t)blocks->s +
           (size_t)s;
}

/* An encoded field without anything in it; encoded_destroy frees it. The field must not be refused, and the
 * knob be one of the codec's. */
Encoded encoded_create(const Codec *codec, const Field *field, int knob);
void encoded_destroy(Encoded *encoded);

/* Encodes all of a field. */
Encoded encoded_make(const Codec *codec, const Field *field, int knob, const FieldSource *source);

/* Room for so many more bytes at a plane's end, zeroed; the address is good until the next call. */
uint8_t *plane_extend(Plane *plane, size_t bytes);

/* A patch of 4 x 4 texels along u and v, all of one (s, t), out of a band's: 48 bytes, u fastest. Where it
 * sticks out of the field, the outermost texels go on, which costs nothing more. And whether it is black. */
enum { PATCH_SIDE = 4, PATCH_BYTES = 48 };
void patch_read(const Field *field, int rows, const uint8_t *texels, int u0, int s, int t,
                uint8_t patch[PATCH_BYTES]);
bool patch_black(const uint8_t patch[PATCH_BYTES]);

/* Byte `offset` of all that a plane ever had. */
static inline const uint8_t *plane_at(const Plane *plane, size_t offset) {
    return plane->data + (offset - plane->before);
}

/* All texels of a field in memory as a source: data is the texels. */
typedef struct {
    const Field *field;
    const uint8_t *texels;
} FieldTexels;
void field_texels_rows(const void *data, int first, int rows, uint8_t *texels);

/* How far what is decoded is from the texels, of rows `first` on, that were encoded: squares of the
 * differences of sRGB codes, three a texel, over all, and over those near an object: that meet one, or have a
 * neighbour (a step along one or more of the axes; u goes around; within those rows) that does. What meets
 * none is black. */
typedef struct {
    double squares, near_squares;
    size_t texels, near_texels;
} EncodedError;
EncodedError encoded_error(const Encoded *encoded, int first, int rows, const uint8_t *texels);
EncodedError error_sum(EncodedError a, EncodedError b);
double squares_psnr_db(double squares, size_t texels); /* 100 for none */

/* sRGB codes 0..255, not rounded, of linear light 0..1, and of its root; and back. */
float code_of(float light);
float code_of_root(float root);
float light_of(uint8_t code);
float root_of(uint8_t code);

#endif
