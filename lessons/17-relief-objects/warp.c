/* Forward, surface by surface, into a grid of samples on each face that faces the eye.
 *
 * Everything of the object is in the box, so behind the plane of every face that the eye is in front of:
 * nothing lies behind the eye or needs clipping, W is 1 or more. And each line of sight enters the box
 * through one face, so what overflows one face lands on its neighbour, and nowhere twice.
 *
 * A sample is one word: how far behind the face's plane in its upper half, which texel in its lower one. The
 * least word wins. That is the depth buffer, and it makes the order of faces, tiles and triangles
 * all the same; so no sheet has to be sorted, and cores need not wait for one another. */
#include "warp.h"

#include "fail.h"
#include "image.h"
#include "parallel.h"

#include <stdlib.h>
#include <string.h>

enum { BANDS = 4 }; /* of a destination, each a piece of work of its own */

static const uint64_t EMPTY = UINT64_MAX;

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
    int width, first, end; /* samples in a row; rows */
    uint64_t *words;       /* of row 0 of the destination */
} Band;

/* A point where it lands: in samples, and its depth as an integer would have it. */
typedef struct {
    float x, y, depth;
} Landed;

static const float DEPTHS = 0x1p30f;

/* ---- Triangles ---- */

/* The samples from low to high, of which the first is at 0.5. The casts cut off toward 0. */
static int sample_from(float low) {
    float place = low - 0.5f;
    if (!(place > 0.0f)) return 0;
    int below = place < 1e6f ? (int)place : 1000000;
    return below + (place > (float)below);
}

static int sample_to(float high, int end) {
    float place = high - 0.5f;
    if (!(place >= 0.0f)) return 0;
    return place < (float)(end - 1) ? (int)place + 1 : end;
}

static inline float least(float a, float b, float c) {
    float ab = a < b ? a : b;
    return ab < c ? ab : c;
}

static inline float greatest(float a, float b, float c) {
    float ab = a > b ? a : b;
    return ab > c ? ab : c;
}

/* A triangle's samples, each with the texel of the corner that it is nearest to by its weights. Clockwise is
 * what faces away. A little more than the triangle is drawn, so that rounding leaves no gaps. */
static void draw_triangle(const Band *band, const Landed *a, const Landed *b, const Landed *c,
                          const uint32_t texels[3]) {
    static const float little = -1e-4f;
    float bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y;
    float area = bx * cy - by * cx;
    if (!(area > 0.0f)) return;
    int x0 = sample_from(least(a->x, b->x, c->x)), x1 = sample_to(greatest(a->x, b->x, c->x), band->width);
    int y0 = sample_from(least(a->y, b->y, c->y)), y1 = sample_to(greatest(a->y, b->y, c->y), band->end);
    if (y0 < band->first) y0 = band->first;
    float scale = 1.0f / area, b_depth = b->depth - a->depth, c_depth = c->depth - a->depth;
    for (int y = y0; y < y1; y++) {
        uint64_t *row = band->words + (size_t)y * band->width;
        float dy = (float)y + 0.5f - a->y;
        for (int x = x0; x < x1; x++) {
            float dx = (float)x + 0.5f - a->x;
            float b_weight = (dx * cy - dy * cx) * scale, c_weight = (bx * dy - by * dx) * scale;
            float a_weight = 1.0f - b_weight - c_weight;
            if (a_weight < little || b_weight < little || c_weight < little) continue;
            uint64_t depth = (uint64_t)(int64_t)(a->depth + b_weight * b_depth + c_weight * c_depth);
            uint32_t texel = b_weight > a_weight ? texels[c_weight > b_weight ? 2 : 1]
                                                 : texels[c_weight > a_weight ? 2 : 0];
            uint64_t word = depth << 32 | texel;
            if (word < row[x]) row[x] = word;
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

static inline Landed land(const Map *map, float size, float u, float v, float d) {
    float scale = size / (map->w[0] * u + map->w[1] * v + map->w[2] * d + map->w[3]);
    return (Landed){(map->u[0] * u + map->u[1] * v + map->u[2] * d + map->u[3]) * scale,
                    (map->v[0] * u + map->v[1] * v + map->v[2] * d + map->v[3]) * scale,
                    map->depth[0] * u + map->depth[1] * v + map->depth[2] * d + map->depth[3]};
}

static void land_row(const Map *map, float size, const Face *face, int column, int row, Landed landed[ROW]) {
    const float *d = face->d + (size_t)row * face->width + column;
    float per_texel = 1.0f / (float)face->width, v = ((float)row + 0.5f) / (float)face->height;
    for (int i = 0; i < ROW; i++)
        landed[i] = land(map, size, ((float)(column + i) + 0.5f) * per_texel, v, d[i]);
}

static void draw_cells(const Band *band, const Map *map, const Face *face, const Tile *tile) {
    Landed rows[2][ROW];
    float size = (float)band->width;
    land_row(map, size, face, tile->column, tile->row, rows[tile->row & 1]);
    for (int y = tile->row; y < tile->row + tile->rows; y++) {
        const Landed *here = rows[y & 1], *above = rows[(y + 1) & 1];
        land_row(map, size, face, tile->column, y + 1, rows[(y + 1) & 1]);
        const uint8_t *cells = face->cells + (size_t)y * (face->width - 1) + tile->column;
        uint32_t first = face->first + (uint32_t)(y * face->width + tile->column);
        for (int i = 0; i < tile->columns; i++) {
            if (!cells[i]) continue;
            uint32_t t00 = first + (uint32_t)i, t01 = t00 + (uint32_t)face->width;
            draw_triangle(band, &here[i], &here[i + 1], &above[i + 1], (uint32_t[]){t00, t00 + 1, t01 + 1});
            draw_triangle(band, &here[i], &above[i + 1], &above[i], (uint32_t[]){t00, t01 + 1, t01});
        }
    }
}

static void draw_rims(const Band *band, const Map *map, const Face *face, const Tile *tile) {
    for (int i = 0; i < tile->rim_count; i++) {
        const Rim *rim = &face->rims[tile->first_rim + i];
        Landed landed[3];
        for (int k = 0; k < 3; k++)
            landed[k] =
                land(map, (float)band->width, rim->corners[k].u, rim->corners[k].v, rim->corners[k].d);
        draw_triangle(band, &landed[0], &landed[1], &landed[2],
                      (uint32_t[]){rim->texel, rim->texel, rim->texel});
    }
}

/* ---- From samples to texels ---- */

/* sRGB's bytes as linear light in 16 bits, and back from its upper 12. */
static uint16_t linear_of[256];
static uint8_t srgb_of[4096];

static void make_tables(void) {
    for (int i = 0; i < 256; i++) linear_of[i] = (uint16_t)lround(65535.0 * srgb_decode(i / 255.0));
    for (int i = 0; i < 4096; i++) srgb_of[i] = srgb_byte((float)((i + 0.5) / 4096.0));
}

/* The mean of a texel's samples, in linear light; what is empty counts as 0. */
static void resolve_texel(const Warp *warp, const Texel *texels, const uint64_t *words, uint8_t *colour,
                          uint16_t *normal) {
    int samples = warp->samples, width = warp->size * samples, count = samples * samples, covered = 0;
    unsigned sum[6] = {0};
    for (int y = 0; y < samples; y++) {
        for (int x = 0; x < samples; x++) {
            uint64_t word = words[(size_t)y * width + x];
            if (word == EMPTY) continue;
            const Texel *texel = &texels[(uint32_t)word];
            covered++;
            for (int k = 0; k < 3; k++) {
                sum[k] += linear_of[texel->colour[k]];
                sum[3 + k] += texel->normal[k];
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        colour[k] = srgb_of[sum[k] / (unsigned)count >> 4];
        normal[k] = (uint16_t)(sum[3 + k] / (unsigned)count);
    }
    colour[3] = (uint8_t)(255 * covered / count);
    normal[3] = (uint16_t)(65535 * covered / count);
}

static void resolve_row(const Warp *warp, const Texel *texels, const Destination *destination, int row) {
    const uint64_t *words = warp->words + (size_t)(destination - warp->destinations) * warp->size *
                                              warp->samples * warp->size * warp->samples;
    for (int x = 0; x < warp->size; x++) {
        size_t texel = (size_t)row * warp->size + x;
        size_t sample = ((size_t)row * warp->size * warp->samples + x) * warp->samples;
        resolve_texel(warp, texels, words + sample, destination->colour + 4 * texel,
                      destination->normal + 4 * texel);
    }
}

/* ---- All of it ---- */

/* One band of one destination: nobody else writes there. */
static void fill_band(void *context, int i) {
    const Job *job = context;
    const Warp *warp = job->warp;
    int target = i / BANDS, first = warp->size * (i % BANDS) / BANDS,
        end = warp->size * (i % BANDS + 1) / BANDS;
    int width = warp->size * warp->samples;
    Band band = {width, first * warp->samples, end * warp->samples,
                 warp->words + (size_t)target * width * width};
    memset(band.words + (size_t)band.first * width, 0xff, sizeof(uint64_t) * width * (band.end - band.first));
    for (int s = 0; s < FACES; s++) {
        const Face *face = &job->box->faces[s];
        const Map *map = &job->maps[target][s];
        for (int t = 0; t < job->tile_counts[s]; t++) {
            const Tile *tile = job->tiles[s][t];
            if (!lands_in(map, tile, (float)first / warp->size, (float)end / warp->size)) continue;
            draw_cells(&band, map, face, tile);
            draw_rims(&band, map, face, tile);
        }
    }
    for (int row = first; row < end; row++)
        resolve_row(warp, job->box->texels, &warp->destinations[target], row);
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
        map.depth[i] = DEPTHS * (float)(-vec3_dot(to->f, parts[i]) / deep);
    }
    map.depth[3] += DEPTHS / 16.0f; /* so that rounding leaves none below 0 */
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
    size_t texels = (size_t)size * size;
    for (int i = 0; i < DESTINATIONS; i++) {
        warp.destinations[i].colour = allocate(texels, 4);
        warp.destinations[i].normal = allocate(texels, 4 * sizeof(uint16_t));
    }
    warp.words = allocate(texels * samples * samples * DESTINATIONS, sizeof *warp.words);
    make_tables();
    return warp;
}

void warp_destroy(Warp *warp) {
    for (int i = 0; i < DESTINATIONS; i++) {
        free(warp->destinations[i].colour);
        free(warp->destinations[i].normal);
    }
    free(warp->words);
    *warp = (Warp){0};
}
