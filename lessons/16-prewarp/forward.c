#include "forward.h"

#include "depth_buffer.h"
#include "fill.h"
#include "splat.h"

#include <string.h>

/* ---- Texels one by one ---- */

void forward_count(const LandedRow *row, const Destination *destination, WarpCounts *counts) {
    if (!counts) return;
    float right = (float)destination->width - 0.5f, top = (float)destination->height - 0.5f;
    for (int i = 0; i < row->count; i++) {
        bool behind = !(row->w[i] > (float)LANDING_W_MIN);
        bool inside = row->x[i] >= -0.5f && row->x[i] < right && row->y[i] >= -0.5f && row->y[i] < top;
        counts->behind += behind;
        counts->outside += !behind && !inside;
    }
}

void forward_texels(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                    const Destination *destination, PaintTexels *paint, void *painter, WarpCounts *counts) {
    Sheets sheets = sheets_plain(source->width, source->height);
    if (visibility == VISIBILITY_OCCLUSION_ORDER) {
        Vec2 epipole = sheets_epipole(factors);
        sheets = sheets_toward(v2(epipole.x * source->width, epipole.y * source->height), source->width,
                               source->height);
    }
    Landing landing = landing_create(source, factors, destination);
    LandedRow row = landed_row_create(source->width);
    for (int i = 0; i < 2; i++) {
        for (int j = sheets.rows[i].first; j != sheets.rows[i].end; j += sheets.rows[i].step) {
            landing_row(&landing, source, j, &row);
            forward_count(&row, destination, counts);
            paint(painter, &row, sheets.columns[0]);
            paint(painter, &row, sheets.columns[1]);
        }
    }
    landed_row_destroy(&row);
}

/* The nearest destination texel takes the texel, whatever it held. */
static void put_last(void *painter, const LandedRow *row, Run columns) {
    const Destination *destination = painter;
    float right = (float)destination->width - 0.5f, top = (float)destination->height - 0.5f;
    for (int i = columns.first; i != columns.end; i += columns.step) {
        float x = row->x[i], y = row->y[i];
        if (!(x >= -0.5f && x < right && y >= -0.5f && y < top)) continue;
        size_t at = (size_t)(int)(y + 0.5f) * destination->width + (size_t)(int)(x + 0.5f);
        destination->texels[at] = row->texels[i];
        if (!destination->lookup) continue;
        float *lookup = destination->lookup + 3 * at;
        lookup[0] = row->u[i], lookup[1] = row->v, lookup[2] = (float)row->levels[i] / 65535;
    }
}

/* ---- The whole warp ---- */

static void clear(Destination *destination) {
    size_t count = (size_t)destination->width * destination->height;
    memset(destination->texels, 0, count * sizeof *destination->texels);
    if (destination->lookup) memset(destination->lookup, 0, count * 3 * sizeof *destination->lookup);
}

void warp_forward(const Source *source, const PrewarpFactors *factors, Visibility visibility, Filling filling,
                  Destination *destination, WarpCounts *counts) {
    if (counts) *counts = (WarpCounts){.behind = factors->possible ? 0 : source->width * source->height};
    if (factors->possible && filling == FILLING_LINEAR) {
        fill_cells(source, factors, visibility, destination, counts);
        return;
    }
    clear(destination);
    if (!factors->possible) return;
    if (filling == FILLING_SPLAT)
        splat_texels(source, factors, visibility, destination, counts);
    else if (visibility == VISIBILITY_DEPTH_BUFFER)
        depth_buffer_texels(source, factors, destination, counts);
    else
        forward_texels(source, factors, visibility, destination, put_last, destination, counts);
}
