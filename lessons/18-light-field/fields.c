#include "fields.h"

#include "clock.h"
#include "fail.h"
#include "synthesis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = COARSE }; /* of v that are made at a time: one of the coarse depths */

/* ---- The picture of the model ---- */

/* The texel of a block that looks along the normal most nearly. */
static void add_plain(Image *plain, const Field *field, int v, const uint8_t *block_row) {
    size_t middle = ((size_t)(field->t / 2) * (size_t)field->s + (size_t)(field->s / 2)) * FIELD_TEXEL;
    for (int u = 0; u < field->u; u++)
        for (int k = 0; k < 3; k++)
            image_at(plain, u, v)[k] =
                (float)srgb_decode(block_row[field_block(field) * (size_t)u + middle + (size_t)k] / 255.0);
}

/* ---- Coarse depths ---- */

/* Sums of depths and what they are sums of, a cell of COARSE^4 texels each: laid out as in the texture. */
typedef struct {
    int columns, rows, across, up; /* of blocks, and of cells in one */
    float *sum, *count;
} Depths;

static Depths depths_create(const Field *field) {
    Depths depths = {field->u, field->v, (field->s + COARSE - 1) / COARSE, (field->t + COARSE - 1) / COARSE,
                     NULL,     NULL};
    size_t cells = (size_t)(depths.columns * depths.across) * (size_t)(depths.rows * depths.up);
    depths.sum = allocate(2 * cells, sizeof(float));
    depths.count = depths.sum + cells;
    return depths;
}

static size_t depths_at(const Depths *depths, int u, int v, int s, int t) {
    return (size_t)(v * depths->up + t) * (size_t)(depths->columns * depths->across) +
           (size_t)(u * depths->across + s);
}

static void add_depths(Depths *depths, const Field *field, int v, const float *row) {
    for (int u = 0; u < field->u; u++)
        for (int t = 0; t < field->t; t++)
            for (int s = 0; s < field->s; s++) {
                float depth = *row++;
                if (!isfinite(depth)) continue;
                size_t at = depths_at(depths, u, v, s / COARSE, t / COARSE);
                depths->sum[at] += depth;
                depths->count[at] += 1.0f;
            }
}

/* The cell's own mean, or, where its rays meet nothing, that of the cells around it in s and t: a tap of a
 * neighbour may land where its own ray did not. Elsewhere any depth serves, for all around is black. */
static float depth_of(const Depths *depths, int u, int v, int s, int t, double otherwise) {
    for (int reach = 0; reach <= 1; reach++) {
        double sum = 0.0, count = 0.0;
        for (int y = t - reach; y <= t + reach; y++)
            for (int x = s - reach; x <= s + reach; x++) {
                if (x < 0 || y < 0 || x >= depths->across || y >= depths->up) continue;
                sum += depths->sum[depths_at(depths, u, v, x, y)];
                count += depths->count[depths_at(depths, u, v, x, y)];
            }
        if (count > 0.0) return (float)(sum / count);
    }
    return (float)otherwise;
}

static void finish_depths(Made *made, Depths *depths) {
    size_t cells = (size_t)(depths->columns * depths->across) * (size_t)(depths->rows * depths->up);
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < cells; i++) sum += depths->sum[i], count += depths->count[i];
    made->mean_depth = count > 0.0 ? sum / count : 0.0;
    Image image = image_create(depths->columns * depths->across, depths->rows * depths->up, 1);
    for (int v = 0; v < depths->rows; v++)
        for (int u = 0; u < depths->columns; u++)
            for (int t = 0; t < depths->up; t++)
                for (int s = 0; s < depths->across; s++)
                    image.pixels[depths_at(depths, u, v, s, t)] =
                        depth_of(depths, u, v, s, t, made->mean_depth);
    made->depths = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    image_destroy(&image);
    free(depths->sum);
}

/* ---- Making ---- */

static void say_progress(const Recipe *recipe, int done, double start, double *said) {
    double now = clock_seconds();
    if (now - *said < 2.0) return;
    *said = now;
    const Field *field = &recipe->field;
    fprintf(stderr, "light field %s %dx%dx%dx%d: %d of %d rows, about %.0f s left\n", recipe->scene->name,
            field->u, field->v, field->s, field->t, done, field->v, (now - start) / done * (field->v - done));
}

/* Rows that are in a file. Their depths are not, so those are made, of one ray a texel. */
static void read_rows(const FieldFile *file, const char *path, int first, int count, uint8_t *rows) {
    for (int i = 0; i < count; i++) {
        int index = field_file_find(file, FIELD_ROWS, (uint32_t)(first + i));
        field_file_demand(field_file_section(file, index, rows + field_row(&file->header.field) * (size_t)i),
                          path);
    }
}

Made field_make(const Recipe *recipe, const FieldFile *file, const char *path) {
    const Field *field = &recipe->field;
    Made made = {.recipe = *recipe, .texture = field_texture_create(field)};
    Synthesis *synthesis =
        synthesis_create(field, recipe->scene, file ? 1 : recipe->samples, recipe->through);
    size_t row = field_row(field), row_texels = row / FIELD_TEXEL;
    uint8_t *rows = allocate(ROWS, row);
    float *row_depths = recipe->flat ? NULL : allocate(ROWS * row_texels, sizeof(float));
    Image plain = image_create(field->u, field->v, 3);
    Depths depths = {0};
    if (row_depths) depths = depths_create(field);
    if (field_bytes(field) <= FIELD_KEPT) made.texels = allocate(field_bytes(field), 1);
    double start = clock_seconds(), said = start;
    for (int v = 0; v < field->v; v += ROWS) {
        int count = field->v - v < ROWS ? field->v - v : ROWS;
        double begun = clock_seconds();
        if (!file || row_depths) synthesis_rows(synthesis, v, count, rows, row_depths);
        if (file) read_rows(file, path, v, count, rows);
        made.seconds += clock_seconds() - begun;
        field_texture_write(&made.texture, v, count, rows);
        if (made.texels) memcpy(made.texels + row * (size_t)v, rows, row * (size_t)count);
        for (int i = 0; i < count; i++) {
            add_plain(&plain, field, v + i, rows + row * (size_t)i);
            if (row_depths) add_depths(&depths, field, v + i, row_depths + row_texels * (size_t)i);
        }
        say_progress(recipe, v + count, start, &said);
    }
    made.plain = texture_create(&plain, 1, TEXTURE_SRGB8, TEXTURE_LINEAR);
    texture_mipmap(&made.plain);
    if (row_depths) finish_depths(&made, &depths);
    image_destroy(&plain);
    free(row_depths);
    free(rows);
    synthesis_destroy(synthesis);
    return made;
}

void field_unmake(Made *made) {
    field_texture_destroy(&made->texture);
    texture_destroy(&made->plain);
    if (made->depths.id) texture_destroy(&made->depths);
    free(made->texels);
    *made = (Made){0};
}
