#include "splat.h"

#include "depth_buffer.h"
#include "fail.h"
#include "light.h"

#include <stdlib.h>
#include <string.h>

/* Red, green, blue and the normal, all times alpha; and alpha. */
enum { ALPHA = 6, CHANNELS };
typedef struct {
    float value[CHANNELS];
} Cover;

typedef struct {
    const PrewarpFactors *factors;
    Visibility visibility;
    Destination *destination;
    const Light *light;
    Cover *covers;     /* one a destination texel */
    uint16_t *nearest; /* the level of the spot of which most is seen there, for the depth buffer */
    float pitch; /* destination texels from one texel of a level relief to the next, where 1 + k3 d is 1 */
} Painter;

/* One spot: what it shows everywhere at full alpha. */
typedef struct {
    float x, y, radius; /* in destination texels; where alpha reaches 0 */
    Cover opaque;
    float lookup[3];
    uint16_t level;
} Spot;

static Spot spot_of(const Painter *painter, const LandedRow *row, int i) {
    const Texel *texel = &row->texels[i];
    Spot spot = {.x = row->x[i], .y = row->y[i], .radius = SPLAT_RADIUS * painter->pitch / row->w[i]};
    for (int c = 0; c < 3; c++) {
        spot.opaque.value[c] = painter->light->decoded[texel->colour[c]];
        spot.opaque.value[3 + c] = texel->normal[c];
    }
    spot.opaque.value[ALPHA] = 1.0f;
    spot.lookup[0] = row->u[i], spot.lookup[1] = row->v, spot.lookup[2] = (float)row->levels[i] / 65535;
    spot.level = row->levels[i];
    return spot;
}

/* Lays `part` of a spot over or under what a destination texel shows. */
static void lay(const Painter *painter, size_t at, const Spot *spot, float part) {
    float *shown = painter->covers[at].value, before = shown[ALPHA];
    bool over = painter->visibility == VISIBILITY_OCCLUSION_ORDER || before == 0.0f ||
                is_nearer(painter->factors, spot->level, painter->nearest[at]);
    float of_shown = over ? 1.0f - part : 1.0f, of_spot = over ? part : (1.0f - before) * part;
    for (int c = 0; c < CHANNELS; c++) shown[c] = of_shown * shown[c] + of_spot * spot->opaque.value[c];
    if (of_spot < of_shown * before) return; /* less of it is seen than of what was there */
    painter->nearest[at] = spot->level;
    if (painter->destination->lookup)
        memcpy(&painter->destination->lookup[3 * at], spot->lookup, sizeof spot->lookup);
}

static int ceil_int(float x) { return (int)ceilf(x); }

static void lay_everywhere(const Painter *painter, const Spot *spot) {
    const Destination *destination = painter->destination;
    int left = ceil_int(fmaxf(spot->x - spot->radius, 0)),
        bottom = ceil_int(fmaxf(spot->y - spot->radius, 0));
    float right = fminf(spot->x + spot->radius, (float)destination->width - 1);
    float top = fminf(spot->y + spot->radius, (float)destination->height - 1);
    const float ramp = SPLAT_RADIUS / (SPLAT_RADIUS - SPLAT_OPAQUE); /* alpha falls by this a radius */
    for (int y = bottom; (float)y <= top; y++)
        for (int x = left; (float)x <= right; x++) {
            float dx = (float)x - spot->x, dy = (float)y - spot->y;
            float alpha = fminf(ramp * (1.0f - sqrtf(dx * dx + dy * dy) / spot->radius), 1.0f);
            if (alpha > 0.0f) lay(painter, (size_t)y * destination->width + x, spot, alpha);
        }
}

static void put_spots(void *context, const LandedRow *row, Run columns) {
    const Painter *painter = context;
    for (int i = columns.first; i != columns.end; i += columns.step) {
        if (row->x[i] == LANDING_NOWHERE) continue;
        Spot spot = spot_of(painter, row, i);
        lay_everywhere(painter, &spot);
    }
}

/* Divides by alpha, and stores. */
static void store(const Painter *painter, size_t at) {
    const float *shown = painter->covers[at].value;
    Texel *texel = &painter->destination->texels[at];
    texel->colour[3] = (uint8_t)(255.0f * fminf(shown[ALPHA], 1.0f) + 0.5f);
    if (texel->colour[3] == 0) return;
    for (int c = 0; c < 3; c++) {
        texel->colour[c] = light_encode(painter->light, fminf(shown[c] / shown[ALPHA], 1.0f));
        texel->normal[c] = (uint8_t)(fminf(shown[3 + c] / shown[ALPHA], 255.0f) + 0.5f);
    }
}

void splat_texels(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                  Destination *destination, WarpCounts *counts) {
    size_t count = (size_t)destination->width * destination->height;
    double pitch_x = destination->width / (destination->high.x - destination->low.x) / source->width;
    double pitch_y = destination->height / (destination->high.y - destination->low.y) / source->height;
    Painter painter = {factors,
                       visibility,
                       destination,
                       light_tables(),
                       allocate(count, sizeof *painter.covers),
                       allocate(count, sizeof *painter.nearest),
                       (float)fmax(pitch_x, pitch_y)};
    forward_texels(source, factors, visibility, destination, put_spots, &painter, counts);
    for (size_t i = 0; i < count; i++) store(&painter, i);
    free(painter.covers);
    free(painter.nearest);
}
