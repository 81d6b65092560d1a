#include "shown.h"

#include "fail.h"
#include "ramp.h"
#include "vq.h"

#include <stdlib.h>
#include <string.h>

enum {
    SIDE_MOST = 16384,
    BOOK_ACROSS = 128,
    LEAVES_ACROSS = 4096,
    LEAF_WIDE = 16
}; /* as in vq.glsl, ramp.glsl */

static void check_size(const Encoded *encoded, int64_t width, int64_t height) {
    const Field *field = &encoded->field;
    if (width > SIDE_MOST || height > SIDE_MOST)
        fail("%s: of a light field of %dx%dx%dx%d it does not fit in a texture", encoded->codec->name,
             field->u, field->v, field->s, field->t);
}

/* A picture of blocks: a plane's rows. */
static Texture picture(const Encoded *encoded, int plane, int side, TexturePacking packing) {
    Blocks blocks = encoded->blocks;
    int64_t width = (int64_t)blocks.u * blocks.s * side, height = (int64_t)blocks.v * blocks.t * side;
    check_size(encoded, width, height);
    return texture_packed((int)width, (int)height, packing, encoded->planes[plane].data,
                          encoded->planes[plane].bytes);
}

/* The codebook: each code 4 x 4 texels, row by row of BOOK_ACROSS codes. */
static Texture book_texture(const Plane *book) {
    size_t count = book->bytes / PATCH_BYTES, line = (size_t)BOOK_ACROSS * PATCH_SIDE * 3;
    int rows = (int)((count + BOOK_ACROSS - 1) / BOOK_ACROSS);
    uint8_t *texels = allocate((size_t)rows * PATCH_SIDE, line);
    for (size_t i = 0; i < count; i++)
        for (size_t v = 0; v < PATCH_SIDE; v++)
            memcpy(texels + (i / BOOK_ACROSS * PATCH_SIDE + v) * line + i % BOOK_ACROSS * PATCH_SIDE * 3,
                   book->data + i * PATCH_BYTES + v * PATCH_SIDE * 3, PATCH_SIDE * 3);
    Texture texture =
        texture_empty(BOOK_ACROSS * PATCH_SIDE, rows * PATCH_SIDE, TEXTURE_SRGBA8, TEXTURE_NEAREST);
    texture_write_part(&texture, TEXTURE_SRGB8, 0, 0, texture.width, texture.height, texels);
    free(texels);
    return texture;
}

/* Leaves are three words, and four here: a texture of three is slower to read. */
static Texture leaves_texture(const Plane *leaves) {
    size_t count = leaves->bytes / RAMP_LEAF_BYTES, rows = (count + LEAVES_ACROSS - 1) / LEAVES_ACROSS;
    if (rows > SIDE_MOST) fail("%zu leaves do not fit in a texture", count);
    uint8_t *wide = allocate(count, LEAF_WIDE);
    for (size_t i = 0; i < count; i++)
        memcpy(wide + LEAF_WIDE * i, leaves->data + RAMP_LEAF_BYTES * i, RAMP_LEAF_BYTES);
    Texture texture = texture_packed(LEAVES_ACROSS, (int)rows, PACKED_U32X4, wide, LEAF_WIDE * count);
    free(wide);
    return texture;
}

/* Each entry with those of the next blocks along s, along t, and along both: what four texels need is one
 * fetch. */
static Texture table_texture(const Encoded *encoded) {
    Blocks blocks = encoded->blocks;
    int64_t width = (int64_t)blocks.u * blocks.s, height = (int64_t)blocks.v * blocks.t;
    check_size(encoded, width, height);
    const uint32_t *entries = (const uint32_t *)encoded->planes[0].data;
    uint32_t *fours = allocate((size_t)height, (size_t)width * 4 * sizeof *fours), *to = fours;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, to += 4)
            for (int k = 0; k < 4; k++) {
                int s = k & 1 && x % blocks.s < blocks.s - 1, t = k & 2 && y % blocks.t < blocks.t - 1;
                to[k] = entries[(y + t) * width + x + s];
            }
    Texture texture = texture_packed((int)width, (int)height, PACKED_U32X4, fours,
                                     (size_t)height * (size_t)width * 4 * sizeof *fours);
    free(fours);
    return texture;
}

Shown shown_create(const Encoded *encoded) {
    const Codec *codec = encoded->codec;
    Shown shown = {.blocks = encoded->blocks};
    if (codec == &codec_vq) {
        shown.names[0] = "book", shown.names[1] = "codes";
        shown.textures[0] = book_texture(&encoded->planes[0]);
        shown.textures[1] =
            picture(encoded, 1, 1, vq_code_bytes(encoded->knob) == 1 ? PACKED_U8 : PACKED_U16);
    } else if (codec == &codec_ramp) {
        shown.names[0] = "table", shown.names[1] = "leaves";
        shown.textures[0] = table_texture(encoded);
        shown.textures[1] = leaves_texture(&encoded->planes[1]);
    } else {
        shown.names[0] = "blocks";
        shown.textures[0] = picture(encoded, 0, PATCH_SIDE, codec == &codec_bc1 ? PACKED_BC1 : PACKED_BC7);
    }
    return shown;
}

void shown_destroy(Shown *shown) {
    for (int i = 0; i < PLANES_MAX && shown->names[i]; i++) texture_destroy(&shown->textures[i]);
    *shown = (Shown){0};
}

void shown_bind(const Shown *shown, Program *program) {
    for (int i = 0; i < PLANES_MAX && shown->names[i]; i++)
        program_texture(program, shown->names[i], &shown->textures[i]);
    program_vector(program, "across", shown->blocks.u, shown->blocks.v, shown->blocks.s, shown->blocks.t);
}
