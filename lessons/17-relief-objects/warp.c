/* Forward, surface by surface, into a grid of samples on each face that faces the eye.
 *
 * Everything of the object is in the box, so behind the plane of every face that the eye is in front of:
 * nothing lies behind the eye or needs clipping, W is 1 or more. And each line of sight enters the box
 * through one face, so what overflows one face lands on its neighbour, and nowhere twice.
 *
 * Each sample keeps the nearest surface that landed on it: a depth buffer. Sheets painted in the order of
 * their occlusion would do without, but the reliefs of six faces hide parts of one another in no order of
 * faces. */
#include "warp.h"

#include "fail.h"
#include "parallel.h"

#include <stdlib.h>
#include <string.h>

enum {
    BANDS = 2, /* of a destination, each a piece of work of its own */
    LANES = 4  /* samples that are looked at together, so that the compiler makes vectors of them */
};

static const float FAR = 2.0f; /* deeper than the box */

/* From one face to another: u and v over 0..1 there are U / W and V / W, depth is how far the point is behind
 * the target's plane in depths of the box; each linear in (u, v, d, 1). */
typedef struct {
    float u[4], v[4], w[4], depth[4];
} Map;

typedef struct {
    Warp *warp;
    const Box *box;
    Map maps[DESTINATIONS][FACES];
    const Tile **tiles[FACES]; /* those that may face the eye */
    int tile_counts[FACES];
} Job;

/* A band of a destination. */
typedef struct {
    int width, stride, first, end; /* samples in a row, with those that only fill the last lanes; rows */
    float *depths;                 /* of the whole destination, row 0 first */
    uint32_t *texels;
} Band;

/* Four numbers at once: the compiler makes one instruction of each operation, and a comparison gives all bits
 * or none. (In plain loops it finds such vectors only where there is nothing to choose.) */
typedef float Floats __attribute__((vector_size(4 * LANES)));
typedef int32_t Ints __attribute__((vector_size(4 * LANES)));

static inline Ints choose(Ints mask, Ints yes, Ints no) { return (yes & mask) | (no & ~mask); }
static inline Floats choose_floats(Ints mask, Floats yes, Floats no) {
    return (Floats)choose(mask, (Ints)yes, (Ints)no);
}
static inline Floats least(Floats a, Floats b) { return choose_floats(a < b, a, b); }
static inline Floats greatest(Floats a, Floats b) { return choose_floats(a > b, a, b); }

static inline Floats load(const float *from) {
    Floats floats;
    memcpy(&floats, from, sizeof floats);
    return floats;
}

/* Points where they land: in samples, and their depth. */
typedef struct {
    float x, y, depth;
} Landed;

typedef struct {
    Floats x, y, depth;
} LandedLanes;

/* A row of a tile's texels that landed, and a few more, for the last cells' lanes. */
typedef struct {
    float x[ROW + LANES], y[ROW + LANES], depth[ROW + LANES];
} LandedRow;

/* ---- Triangles ---- */

/* The samples from x0 to before x1, y0 to before y1. */
typedef struct {
    int x0, x1, y0, y1;
} Samples;

/* The first sample of a band from a place on; the samples are at 0.5, 1.5 and so on. What is no number, or
 * far away, stays within low..high. */
static inline Ints sample_from(Floats place, int low, int high) {
    Floats from = least(greatest(place - 0.5f, (Floats){0} + (float)low), (Floats){0} + (float)high);
    Ints below = __builtin_convertvector(from, Ints);
    return below - (Ints)(__builtin_convertvector(below, Floats) < from); /* true is -1 */
}

/* The samples of four lanes take a depth and a texel where they are told to and it is nearer than what they
 * have. */
static inline void take(float *depths, uint32_t *winners, Ints told, Floats depth, Ints texel) {
    Floats old_depth = load(depths);
    Ints old_texel;
    memcpy(&old_texel, winners, sizeof old_texel);
    Ints nearer = told & (Ints)(depth < old_depth);
    old_depth = choose_floats(nearer, depth, old_depth);
    old_texel = choose(nearer, texel, old_texel);
    memcpy(depths, &old_depth, sizeof old_depth);
    memcpy(winners, &old_texel, sizeof old_texel);
}

/* A triangle's samples among those of a box around it, each with the texel of the corner that it is nearest
 * to by its weights. Clockwise is what faces away. A little more than the triangle is drawn, so that rounding
 * leaves no gaps. Most triangles are a few samples large: four lanes at a time cost less than a branch for
 * each, and where they reach beyond the box they are outside of the triangle. */
static void draw_triangle(const Band *band, Samples box, Landed a, Landed b, Landed c,
                          const uint32_t texels[3]) {
    static const float little = -1e-4f;
    float bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    float area = bx * cy - by * cx;
    if (!(area > 0.0f)) return;
    float scale = 1.0f / area, b_step = cy * scale, c_step = -by * scale;
    Ints own[3];
    for (int k = 0; k < 3; k++) own[k] = (Ints){0} + (int32_t)texels[k];
    for (int y = box.y0; y < box.y1; y++) {
        float dx = (float)box.x0 + 0.5f - a.x, dy = (float)y + 0.5f - a.y;
        Floats b_weight = (dx * cy - dy * cx) * scale + b_step * (Floats){0, 1, 2, 3};
        Floats c_weight = (bx * dy - by * dx) * scale + c_step * (Floats){0, 1, 2, 3};
        size_t sample = (size_t)y * band->stride + box.x0;
        for (int x = box.x0; x < box.x1; x += LANES, sample += LANES) {
            Floats a_weight = 1.0f - b_weight - c_weight;
            Floats depth = a.depth + b_weight * (b.depth - a.depth) + c_weight * (c.depth - a.depth);
            Ints inside = (a_weight > little) & (b_weight > little) & (c_weight > little);
            Ints texel = choose((a_weight > b_weight) & (a_weight > c_weight), own[0],
                                choose(b_weight > c_weight, own[1], own[2]));
            take(band->depths + sample, band->texels + sample, inside, depth, texel);
            b_weight += LANES * b_step;
            c_weight += LANES * c_step;
        }
    }
}

/* ---- Tiles ---- */

/* Whether a tile can land in the part v0..v1 of a face: not when all corners of its bounds are beyond one of
 * the four sides. */
static bool lands_in(const Map *map, const Tile *tile, float v0, float v1) {
    int beyond[4] = {0};
    for (int i = 0; i < 8; i++) {
        float u = i & 1 ? tile->high.u : tile->low.u, v = i & 2 ? tile->high.v : tile->low.v;
        float d = i & 4 ? tile->high.d : tile->low.d;
        float U = map->u[0] * u + map->u[1] * v + map->u[2] * d + map->u[3];
        float V = map->v[0] * u + map->v[1] * v + map->v[2] * d + map->v[3];
        float W = map->w[0] * u + map->w[1] * v + map->w[2] * d + map->w[3];
        beyond[0] += U < 0.0f;
        beyond[1] += U > W;
        beyond[2] += V < v0 * W;
        beyond[3] += V > v1 * W;
    }
    return beyond[0] < 8 && beyond[1] < 8 && beyond[2] < 8 && beyond[3] < 8;
}

static inline LandedLanes land(const Map *map, float size, Floats u, Floats v, Floats d) {
    Floats scale = size / (map->w[0] * u + map->w[1] * v + map->w[2] * d + map->w[3]);
    return (LandedLanes){(map->u[0] * u + map->u[1] * v + map->u[2] * d + map->u[3]) * scale,
                         (map->v[0] * u + map->v[1] * v + map->v[2] * d + map->v[3]) * scale,
                         map->depth[0] * u + map->depth[1] * v + map->depth[2] * d + map->depth[3]};
}

static void land_row(const Map *map, float size, const Face *face, int column, int row, LandedRow *landed) {
    const float *d = face->d + (size_t)row * face->width + column;
    Floats v = (Floats){0} + ((float)row + 0.5f) / (float)face->height;
    for (int i = 0; i < ROW; i += LANES) {
        Floats u = ((float)(column + i) + (Floats){0.5f, 1.5f, 2.5f, 3.5f}) / (float)face->width;
        LandedLanes at = land(map, size, u, v, load(d + i));
        memcpy(landed->x + i, &at.x, sizeof at.x);
        memcpy(landed->y + i, &at.y, sizeof at.y);
        memcpy(landed->depth + i, &at.depth, sizeof at.depth);
    }
}

/* For each cell between two rows the samples that it may cover, of which many cells have none: most are about
 * one sample large. None for those that face away, too. */
static void box_cells(const Band *band, const LandedRow *here, const LandedRow *above, Samples boxes[ROW]) {
    for (int i = 0; i < ROW; i += LANES) {
        Floats x00 = load(here->x + i), x10 = load(here->x + i + 1), x01 = load(above->x + i),
               x11 = load(above->x + i + 1);
        Floats y00 = load(here->y + i), y10 = load(here->y + i + 1), y01 = load(above->y + i),
               y11 = load(above->y + i + 1);
        Ints x0 = sample_from(least(least(x00, x10), least(x01, x11)), 0, band->width);
        Ints x1 = sample_from(greatest(greatest(x00, x10), greatest(x01, x11)), 0, band->width);
        Ints y0 = sample_from(least(least(y00, y10), least(y01, y11)), band->first, band->end);
        Ints y1 = sample_from(greatest(greatest(y00, y10), greatest(y01, y11)), band->first, band->end);
        Floats x = x11 - x00, y = y11 - y00;
        Ints toward = ((x10 - x00) * y > (y10 - y00) * x) | (x * (y01 - y00) > y * (x01 - x00));
        x1 = choose(toward, x1, x0);
        for (int k = 0; k < LANES; k++) boxes[i + k] = (Samples){x0[k], x1[k], y0[k], y1[k]};
    }
}

static inline Landed landed_at(const LandedRow *row, int i) {
    return (Landed){row->x[i], row->y[i], row->depth[i]};
}

static void draw_cells(const Band *band, const Map *map, const Face *face, const Tile *tile) {
    LandedRow rows[2] = {0};
    Samples boxes[ROW];
    float size = (float)band->width;
    land_row(map, size, face, tile->column, tile->row, &rows[tile->row & 1]);
    for (int y = tile->row; y < tile->row + tile->rows; y++) {
        const LandedRow *here = &rows[y & 1], *above = &rows[(y + 1) & 1];
        land_row(map, size, face, tile->column, y + 1, &rows[(y + 1) & 1]);
        box_cells(band, here, above, boxes);
        const uint8_t *cells = face->cells + (size_t)y * (face->width - 1) + tile->column;
        uint32_t first = face->first + (uint32_t)(y * face->width + tile->column);
        for (int i = 0; i < tile->columns; i++) {
            if (!cells[i] || boxes[i].x0 >= boxes[i].x1 || boxes[i].y0 >= boxes[i].y1) continue;
            uint32_t t00 = first + (uint32_t)i, t01 = t00 + (uint32_t)face->width;
            Landed p00 = landed_at(here, i), p10 = landed_at(here, i + 1);
            Landed p01 = landed_at(above, i), p11 = landed_at(above, i + 1);
            draw_triangle(band, boxes[i], p00, p10, p11, (uint32_t[]){t00, t00 + 1, t01 + 1});
            draw_triangle(band, boxes[i], p00, p11, p01, (uint32_t[]){t00, t01 + 1, t01});
        }
    }
}

/* Four rims at a time. */
static void draw_rims(const Band *band, const Map *map, const Face *face, const Tile *tile) {
    for (int first = 0; first < tile->rim_count; first += LANES) {
        const Rim *rims = &face->rims[tile->first_rim + first];
        int count = tile->rim_count - first < LANES ? tile->rim_count - first : LANES;
        LandedLanes at[3];
        for (int k = 0; k < 3; k++) {
            Floats u = {0}, v = {0}, d = {0};
            for (int i = 0; i < count; i++) {
                u[i] = rims[i].corners[k].u;
                v[i] = rims[i].corners[k].v;
                d[i] = rims[i].corners[k].d;
            }
            at[k] = land(map, (float)band->width, u, v, d);
        }
        Ints x0 = sample_from(least(at[0].x, least(at[1].x, at[2].x)), 0, band->width);
        Ints x1 = sample_from(greatest(at[0].x, greatest(at[1].x, at[2].x)), 0, band->width);
        Ints y0 = sample_from(least(at[0].y, least(at[1].y, at[2].y)), band->first, band->end);
        Ints y1 = sample_from(greatest(at[0].y, greatest(at[1].y, at[2].y)), band->first, band->end);
        for (int i = 0; i < count; i++) {
            if (x0[i] >= x1[i] || y0[i] >= y1[i]) continue;
            Landed corners[3];
            for (int k = 0; k < 3; k++) corners[k] = (Landed){at[k].x[i], at[k].y[i], at[k].depth[i]};
            uint32_t texel = rims[i].texel;
            draw_triangle(band, (Samples){x0[i], x1[i], y0[i], y1[i]}, corners[0], corners[1], corners[2],
                          (uint32_t[]){texel, texel, texel});
        }
    }
}

/* ---- From samples to texels ---- */

/* The mean of a texel's samples, where nothing counts as 0. */
static void resolve_texel(const Texel *texels, const uint32_t *winners, int stride, int samples,
                          Texel *mean) {
    uint32_t sum[8] = {0};
    int shift = samples == 4 ? 4 : samples == 2 ? 2 : 0; /* a division by the number of samples */
    for (int y = 0; y < samples; y++)
        for (int x = 0; x < samples; x++)
            for (int k = 0; k < 8; k++) sum[k] += texels[winners[y * stride + x]].values[k];
    for (int k = 0; k < 8; k++) mean->values[k] = (uint16_t)(sum[k] >> shift);
}

static void resolve_row(const Warp *warp, const Texel *texels, const Band *band,
                        const Destination *destination, int row) {
    const uint32_t *winners = band->texels + (size_t)row * warp->samples * band->stride;
    uint16_t *colour = destination->colour + 4 * (size_t)row * warp->size;
    uint16_t *normal = destination->normal + 4 * (size_t)row * warp->size;
    for (int x = 0; x < warp->size; x++) {
        Texel mean;
        resolve_texel(texels, winners + x * warp->samples, band->stride, warp->samples, &mean);
        memcpy(colour + 4 * x, mean.values, 4 * sizeof *colour);
        memcpy(normal + 4 * x, mean.values + 4, 4 * sizeof *normal);
    }
}

/* ---- All of it ---- */

static void clear_band(const Band *band) {
    size_t from = (size_t)band->first * band->stride,
           count = (size_t)(band->end - band->first) * band->stride;
    for (size_t i = 0; i < count; i++) band->depths[from + i] = FAR;
    memset(band->texels + from, 0, count * sizeof *band->texels);
}

/* One band of one destination: nobody else writes there. */
static void fill_band(void *context, int i) {
    const Job *job = context;
    const Warp *warp = job->warp;
    int target = i / BANDS, first = warp->size * (i % BANDS) / BANDS,
        end = warp->size * (i % BANDS + 1) / BANDS;
    int width = warp->size * warp->samples, stride = width + LANES;
    size_t before = (size_t)target * width * stride;
    Band band = {width,
                 stride,
                 first * warp->samples,
                 end * warp->samples,
                 warp->depths + before,
                 warp->winners + before};
    clear_band(&band);
    for (int s = 0; s < FACES; s++) {
        const Face *face = &job->box->faces[s];
        const Map *map = &job->maps[target][s];
        for (int t = 0; t < job->tile_counts[s]; t++) {
            const Tile *tile = job->tiles[s][t];
            if (!lands_in(map, tile, (float)first / (float)warp->size, (float)end / (float)warp->size))
                continue;
            draw_cells(&band, map, face, tile);
            draw_rims(&band, map, face, tile);
        }
    }
    for (int row = first; row < end; row++)
        resolve_row(warp, job->box->texels, &band, &warp->destinations[target], row);
}

/* How deep the box is behind a face, and from which texel of the source a point is how deep. */
static Map map_between(const Box *box, int source, int target, Eye eye) {
    const Plane *from = &box->faces[source].plane, *to = &box->faces[target].plane;
    PrewarpMap exact = prewarp_map(from, to, eye);
    double deep = vec3_dot(to->f, vec3_sub(to->origin, box->faces[(target + OPPOSITE) % FACES].plane.origin));
    const Vec3 parts[] = {from->a, from->b, from->f, vec3_sub(from->origin, to->origin)};
    Map map;
    for (int i = 0; i < 4; i++) {
        map.u[i] = (float)exact.u[i];
        map.v[i] = (float)exact.v[i];
        map.w[i] = (float)exact.w[i];
        map.depth[i] = (float)(-vec3_dot(to->f, parts[i]) / deep);
    }
    return map;
}

static void choose_tiles(Job *job, Eye eye, unsigned sources) {
    for (int s = 0; s < FACES; s++) {
        const Face *face = &job->box->faces[s];
        job->tiles[s] = allocate((size_t)face->tile_count + 1, sizeof *job->tiles[s]);
        if (!(sources & 1u << s)) continue;
        for (int t = 0; t < face->tile_count; t++)
            if (!tile_faces_away(&face->tiles[t], eye))
                job->tiles[s][job->tile_counts[s]++] = &face->tiles[t];
    }
}

bool warp_box(Warp *warp, const Box *box, Eye eye, unsigned sources) {
    int targets[FACES];
    warp->count = box_faces_toward(box, eye, targets);
    if (!warp->count) return false;
    Job job = {.warp = warp, .box = box};
    for (int t = 0; t < warp->count; t++) {
        warp->destinations[t].face = targets[t];
        for (int s = 0; s < FACES; s++) job.maps[t][s] = map_between(box, s, targets[t], eye);
    }
    choose_tiles(&job, eye, sources);
    parallel_for(warp->count * BANDS, fill_band, &job);
    for (int s = 0; s < FACES; s++) free(job.tiles[s]);
    return true;
}

Warp warp_create(int size, int samples) {
    Warp warp = {.size = size, .samples = samples};
    size_t texels = (size_t)size * size, width = (size_t)size * samples;
    for (int i = 0; i < DESTINATIONS; i++) {
        warp.destinations[i].colour = allocate(texels, 4 * sizeof(uint16_t));
        warp.destinations[i].normal = allocate(texels, 4 * sizeof(uint16_t));
    }
    warp.depths = allocate(width * (width + LANES) * DESTINATIONS, sizeof *warp.depths);
    warp.winners = allocate(width * (width + LANES) * DESTINATIONS, sizeof *warp.winners);
    return warp;
}

void warp_destroy(Warp *warp) {
    for (int i = 0; i < DESTINATIONS; i++) {
        free(warp->destinations[i].colour);
        free(warp->destinations[i].normal);
    }
    free(warp->depths);
    free(warp->winners);
    *warp = (Warp){0};
}
