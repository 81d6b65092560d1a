/* A light field on the GPU, and what lessons about light fields share in drawing one. The context must be
 * current. */
#ifndef TEXEL_FIELD_DRAW_H
#define TEXEL_FIELD_DRAW_H

#include "lesson.h"
#include "light_field.h"
#include "light_scene.h"

enum { FIELD_PAGES = 4 };

/* All texels, SRGB8_ALPHA8, without borders: the block of (u, v) lies at column u, row v of a table of
 * blocks, its texel (s, t) at (s, t) within it. A texture holds 16384 texels a side here, and about 1 GiB: a
 * larger field lies in up to four, each of so many columns and rows of blocks. */
typedef struct {
    Field field;
    int columns, rows; /* of blocks in a page */
    int across, count; /* pages side by side, and all of them */
    Texture pages[FIELD_PAGES];
} FieldTexture;

/* Ends the program with a line that names the size where a field does not fit. What it holds is not defined.
 * field_texture_write writes rows of v, as synthesis_rows makes them. */
FieldTexture field_texture_create(const Field *field);
void field_texture_write(const FieldTexture *texture, int first, int rows, const uint8_t *texels);
void field_texture_destroy(FieldTexture *texture);
size_t field_texture_bytes(const FieldTexture *texture); /* on the GPU, four a texel */

/* For a shader that includes pages.inc or pages-4.inc: its textures. */
void field_texture_bind(Program *program, const FieldTexture *texture);

/* For a shader that includes field.inc: the pixel's ray and the field's parametrization. */
void field_uniforms(const Frame *frame, const Field *field);

/* The truth of a light field: what an eye sees of the scene itself where it looks through the model, and
 * nothing where it looks past. u, v and depth are the model's. */
Sample field_truth(const Field *field, const LightScene *scene, Ray ray);

#endif
