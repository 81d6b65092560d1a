#include "landing.h"

#include "fail.h"
#include "lanes.h"

#include <stdlib.h>
#include <string.h>

/* ---- Room for a row ---- */

LandedRow landed_row_create(int count) {
    size_t entries = (size_t)count + 2 + LANES;
    char *memory = allocate(entries, sizeof(Texel) + 4 * sizeof(float) + sizeof(uint16_t));
    LandedRow row = {.count = count, .texels = (Texel *)memory + 1, .memory = memory};
    float *floats = (float *)(memory + entries * sizeof(Texel)) + 1;
    row.u = floats;
    row.x = floats + entries;
    row.y = floats + 2 * entries;
    row.w = floats + 3 * entries;
    row.levels = (uint16_t *)(floats - 1 + 4 * entries) + 1;
    for (int i = 0; i < count; i++) row.u[i] = (float)((i + 0.5) / count);
    row.u[-1] = 0;
    row.u[count] = 1;
    return row;
}

void landed_row_destroy(LandedRow *row) {
    free(row->memory);
    *row = (LandedRow){0};
}

/* ---- Where it lands ---- */

Landing landing_create(const Source *source, const PrewarpFactors *factors, const Destination *destination) {
    Vec2 low = destination->low, high = destination->high;
    double per_u = destination->width / (high.x - low.x), per_v = destination->height / (high.y - low.y);
    double first_u = low.x + 0.5 / per_u, first_v = low.y + 0.5 / per_v;     /* of the centre of texel 0, 0 */
    double d_0 = -source->scale * source->base, d_l = source->scale / 65535; /* d = d_0 + d_l l */
    /* x = per_u ((u + k1 d) / (1 + k3 d) - first_u), over one denominator. */
    double x_d = per_u * (factors->k1 - first_u * factors->k3);
    double y_d = per_v * (factors->k2 - first_v * factors->k3);
    return (Landing){.w_0 = (float)(1 + factors->k3 * d_0),
                     .w_l = (float)(factors->k3 * d_l),
                     .x_u = (float)per_u,
                     .x_0 = (float)(x_d * d_0 - per_u * first_u),
                     .x_l = (float)(x_d * d_l),
                     .y_v = (float)per_v,
                     .y_0 = (float)(y_d * d_0 - per_v * first_v),
                     .y_l = (float)(y_d * d_l)};
}

static Texel texel_mean(Texel a, Texel b) {
    for (int i = 0; i < 4; i++) {
        a.colour[i] = (uint8_t)((a.colour[i] + b.colour[i] + 1) / 2);
        a.normal[i] = (uint8_t)((a.normal[i] + b.normal[i] + 1) / 2);
    }
    return a;
}

#define AWAY 0x1p20f /* where no destination reaches */

static uint16_t level_mean(uint16_t a, uint16_t b) { return (uint16_t)((a + b + 1) / 2); }

/* Index -1 and the one after the last are halfway between the last row and the first. */
static bool is_edge(const Source *source, int index) { return index < 0 || index >= source->height; }

static size_t row_start(const Source *source, int index) {
    return (size_t)source->width * (is_edge(source, index) ? source->height - 1 : index);
}

static void fetch_levels(const Source *source, int index, LandedRow *row) {
    int count = source->width;
    memcpy(row->levels, source->levels + row_start(source, index), count * sizeof *row->levels);
    for (int i = 0; is_edge(source, index) && i < count; i++)
        row->levels[i] = level_mean(row->levels[i], source->levels[i]);
    row->levels[-1] = row->levels[count] = level_mean(row->levels[0], row->levels[count - 1]);
}

static void fetch_texels(const Source *source, int index, LandedRow *row) {
    int count = source->width;
    memcpy(row->texels, source->texels + row_start(source, index), count * sizeof *row->texels);
    for (int i = 0; is_edge(source, index) && i < count; i++)
        row->texels[i] = texel_mean(row->texels[i], source->texels[i]);
    row->texels[-1] = row->texels[count] = texel_mean(row->texels[0], row->texels[count - 1]);
}

WIDE static void land(const Landing *landing, const LandedRow *row) {
    const Landing k = *landing;
    const Floats nowhere = ALL(LANDING_NOWHERE);
    const float y_row = k.y_v * row->v + k.y_0;
    for (int i = -1; i <= row->count; i += LANES) {
        Shorts levels;
        Floats u;
        LOAD(levels, row->levels + i), LOAD(u, row->u + i);
        Floats l = FLOATS_OF(levels), w = k.w_0 + k.w_l * l, r = 1.0f / w;
        Floats x = (k.x_u * u + k.x_0 + k.x_l * l) * r, y = (y_row + k.y_l * l) * r;
        Ints somewhere = (w > (float)LANDING_W_MIN) & (x < AWAY) & (x > -AWAY) & (y < AWAY) & (y > -AWAY);
        x = PICK(somewhere, x, nowhere), y = PICK(somewhere, y, nowhere);
        STORE(x, row->x + i), STORE(y, row->y + i), STORE(w, row->w + i);
    }
}

void landing_place(const Landing *landing, const Source *source, int index, LandedRow *row) {
    row->row = index;
    row->v = index < 0 ? 0 : index >= source->height ? 1 : (float)((index + 0.5) / source->height);
    fetch_levels(source, index, row);
    land(landing, row);
}

void landing_row(const Landing *landing, const Source *source, int index, LandedRow *row) {
    landing_place(landing, source, index, row);
    fetch_texels(source, index, row);
}
