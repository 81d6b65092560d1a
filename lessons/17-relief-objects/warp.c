/* Forward, surface by surface, into a grid of samples on each face that the eye looks through.
 *
 * Everything of the object is in the box, so behind the plane of every face that an eye outside is in front
 * of: nothing lies behind the eye or needs clipping, W is 1 or more. And each line of sight enters the box
 * through one face, so what overflows one face lands on its neighbour, and nowhere twice. For an eye inside,
 * lines of sight leave the box through one face: the same holds, but that what is beside or behind the eye
 * has a W of 0 or less, and is not drawn.
 *
 * What lands on the same sample is told apart by its depth. Sheets painted in the order of their occlusion
 * need no depths, but the reliefs of six faces hide parts of one another in no order of faces. */
#include "warp.h"

#include "fail.h"
#include "grid.h"
#include "parallel.h"

#include <stdlib.h>

enum { BANDS = 2 }; /* of a destination, each a piece of work of its own */

static const float W_LEAST =
    1e-3f; /* what is nearer to an eye inside, in terms of the face behind it, is not drawn */

/* From one face to another: u and v over 0..1 there are U / W and V / W, depth is how far the point is behind
 * the target's plane in depths of the box; each linear in (u, v, d, 1). */
typedef struct {
    float u[4], v[4], w[4], depth[4];
} Map;

typedef struct {
    Warp *warp;
    const Box *box;
    Parts parts;
    bool inside; /* the eye: it sees the faces' textures mirrored, and what is deeper behind them first */
    Map maps[FACES][FACES];
    const Tile **tiles[FACES]; /* those that may face the eye */
    int tile_counts[FACES];
} Job;

/* Four points where they land. */
typedef struct {
    Floats x, y, depth;
} LandedLanes;

/* A row of a tile's texels that landed, with some more for the last cells' lanes. */
typedef struct {
    float x[ROW + LANES], y[ROW + LANES], depth[ROW + LANES];
} LandedRow;

/* ---- Where texels land ---- */

/* Where four points land on a face of so many samples a side; no numbers for what is not in front of the eye.
 */
static inline LandedLanes land(const Map *map, float size, Floats u, Floats v, Floats d) {
    Floats w = map->w[0] * u + map->w[1] * v + map->w[2] * d + map->w[3];
    Floats scale = PICK(w > W_LEAST, size / w, ALL(NAN));
    return (LandedLanes){(map->u[0] * u + map->u[1] * v + map->u[2] * d + map->u[3]) * scale,
                         (map->v[0] * u + map->v[1] * v + map->v[2] * d + map->v[3]) * scale,
                         map->depth[0] * u + map->depth[1] * v + map->depth[2] * d + map->depth[3]};
}

static void land_row(const Map *map, float size, const Face *face, int column, int row, LandedRow *landed) {
    const float *d = face->d + (size_t)row * face->width + column;
    Floats v = ALL(((float)row + 0.5f) / (float)face->height);
    for (int i = 0; i < ROW; i += LANES) {
        Floats u = ((float)(column + i) + (Floats){0.5f, 1.5f, 2.5f, 3.5f}) / (float)face->width;
        LandedLanes at = land(map, size, u, v, FLOATS_AT(d + i));
        memcpy(landed->x + i, &at.x, sizeof at.x);
        memcpy(landed->y + i, &at.y, sizeof at.y);
        memcpy(landed->depth + i, &at.depth, sizeof at.depth);
    }
}

static inline Landed landed_at(const LandedRow *row, int i) {
    return (Landed){row->x[i], row->y[i], row->depth[i]};
}

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

/* ---- Drawing tiles ---- */

/* Four extents. */
typedef struct {
    Ints x0, x1, y0, y1;
} ExtentLanes;

static inline ExtentLanes extent_between(const Grid *grid, Floats left, Floats right, Floats bottom,
                                         Floats top) {
    return (ExtentLanes){sample_from(left, 0, grid->width), sample_from(right, 0, grid->width),
                         sample_from(bottom, grid->first, grid->end),
                         sample_from(top, grid->first, grid->end)};
}

static inline Extent extent_at(const ExtentLanes *lanes, int i) {
    return (Extent){lanes->x0[i], lanes->x1[i], lanes->y0[i], lanes->y1[i]};
}

static inline bool is_empty(Extent extent) { return extent.x0 >= extent.x1 || extent.y0 >= extent.y1; }

/* For each cell between two rows the samples that it may cover: none for those that face away, and none for
 * many others, for most cells are about one sample large. */
static void extend_cells(const Grid *grid, const LandedRow *here, const LandedRow *above,
                         Extent extents[ROW]) {
    for (int i = 0; i < ROW; i += LANES) {
        Floats x00 = FLOATS_AT(here->x + i), x10 = FLOATS_AT(here->x + i + 1);
        Floats y00 = FLOATS_AT(here->y + i), y10 = FLOATS_AT(here->y + i + 1);
        Floats x01 = FLOATS_AT(above->x + i), x11 = FLOATS_AT(above->x + i + 1);
        Floats y01 = FLOATS_AT(above->y + i), y11 = FLOATS_AT(above->y + i + 1);
        ExtentLanes lanes = extent_between(
            grid, LEAST(LEAST(x00, x10), LEAST(x01, x11)), GREATEST(GREATEST(x00, x10), GREATEST(x01, x11)),
            LEAST(LEAST(y00, y10), LEAST(y01, y11)), GREATEST(GREATEST(y00, y10), GREATEST(y01, y11)));
        Floats x = (x11 - x00) * grid->side, y = (y11 - y00) * grid->side; /* of what both triangles share */
        Ints faces_eye = ((x10 - x00) * y > (y10 - y00) * x) | (x * (y01 - y00) > y * (x01 - x00));
        lanes.x1 = PICK_INTS(faces_eye, lanes.x1, lanes.x0);
        for (int k = 0; k < LANES; k++) extents[i + k] = extent_at(&lanes, k);
    }
}

static void draw_cells(const Grid *grid, const Map *map, const Face *face, const Tile *tile) {
    LandedRow rows[2] = {0};
    Extent extents[ROW];
    float size = (float)grid->width;
    land_row(map, size, face, tile->column, tile->row, &rows[tile->row & 1]);
    for (int y = tile->row; y < tile->row + tile->rows; y++) {
        const LandedRow *here = &rows[y & 1], *above = &rows[(y + 1) & 1];
        land_row(map, size, face, tile->column, y + 1, &rows[(y + 1) & 1]);
        extend_cells(grid, here, above, extents);
        const uint8_t *cells = face->cells + (size_t)y * (face->width - 1) + tile->column;
        uint32_t first = face->first + (uint32_t)(y * face->width + tile->column);
        for (int i = 0; i < tile->columns; i++) {
            if (!cells[i] || is_empty(extents[i])) continue;
            uint32_t t00 = first + (uint32_t)i, t01 = t00 + (uint32_t)face->width;
            Landed p00 = landed_at(here, i), p10 = landed_at(here, i + 1);
            Landed p01 = landed_at(above, i), p11 = landed_at(above, i + 1);
            grid_triangle(grid, extents[i], p00, p10, p11, (uint32_t[]){t00, t00 + 1, t01 + 1});
            grid_triangle(grid, extents[i], p00, p11, p01, (uint32_t[]){t00, t01 + 1, t01});
        }
    }
}

/* Corner k of up to four rims. */
static LandedLanes land_corners(const Map *map, float size, const Rim *rims, int count, int k) {
    Floats u = {0}, v = {0}, d = {0};
    for (int i = 0; i < count; i++) {
        u[i] = rims[i].corners[k].u;
        v[i] = rims[i].corners[k].v;
        d[i] = rims[i].corners[k].d;
    }
    return land(map, size, u, v, d);
}

static void draw_rims(const Grid *grid, const Map *map, const Face *face, const Tile *tile) {
    for (int first = 0; first < tile->rim_count; first += LANES) {
        const Rim *rims = &face->rims[tile->first_rim + first];
        int count = tile->rim_count - first < LANES ? tile->rim_count - first : LANES;
        LandedLanes at[3];
        for (int k = 0; k < 3; k++) at[k] = land_corners(map, (float)grid->width, rims, count, k);
        ExtentLanes lanes = extent_between(
            grid, LEAST(at[0].x, LEAST(at[1].x, at[2].x)), GREATEST(at[0].x, GREATEST(at[1].x, at[2].x)),
            LEAST(at[0].y, LEAST(at[1].y, at[2].y)), GREATEST(at[0].y, GREATEST(at[1].y, at[2].y)));
        for (int i = 0; i < count; i++) {
            if (is_empty(extent_at(&lanes, i))) continue;
            Landed corners[3];
            for (int k = 0; k < 3; k++) corners[k] = (Landed){at[k].x[i], at[k].y[i], at[k].depth[i]};
            uint32_t texel = rims[i].texel;
            grid_triangle(grid, extent_at(&lanes, i), corners[0], corners[1], corners[2],
                          (uint32_t[]){texel, texel, texel});
        }
    }
}

/* ---- All of it ---- */

static void draw_tiles(const Job *job, const Grid *grid, int target, float v0, float v1) {
    for (int s = 0; s < FACES; s++) {
        const Map *map = &job->maps[target][s];
        for (int t = 0; t < job->tile_counts[s]; t++) {
            const Tile *tile = job->tiles[s][t];
            if (!lands_in(map, tile, v0, v1)) continue;
            draw_cells(grid, map, &job->box->faces[s], tile);
            if (job->parts.rims) draw_rims(grid, map, &job->box->faces[s], tile);
        }
    }
}

/* One band of one destination: nobody else writes there. */
static void fill_band(void *context, int i) {
    const Job *job = context;
    const Warp *warp = job->warp;
    const Destination *destination = &warp->destinations[i / BANDS];
    int size = warp->size, samples = warp->samples, width = size * samples, stride = width + LANES;
    int first = size * (i % BANDS) / BANDS, end = size * (i % BANDS + 1) / BANDS;
    size_t before = (size_t)(i / BANDS) * width * stride;
    Grid grid = {.width = width,
                 .stride = stride,
                 .first = first * samples,
                 .end = end * samples,
                 .side = job->inside ? -1.0f : 1.0f,
                 .depths = warp->depths + before,
                 .texels = warp->texels + before};
    grid_clear(&grid);
    draw_tiles(job, &grid, i / BANDS, (float)first / (float)size, (float)end / (float)size);
    for (int row = first; row < end; row++) {
        size_t texel = (size_t)row * size;
        grid_resolve(&grid, samples, row, job->box->texels, destination->colour + 4 * texel,
                     destination->normal + 4 * texel);
    }
}

/* The depth is that behind the target's plane, over that of the box; from inside, its opposite. */
static Map map_between(const Box *box, int source, int target, Eye eye, bool inside) {
    const Plane *from = &box->faces[source].plane, *to = &box->faces[target].plane;
    const Plane *far = &box->faces[(target + OPPOSITE) % FACES].plane;
    PrewarpMap exact = prewarp_map(from, to, eye);
    double deep = vec3_dot(to->f, vec3_sub(to->origin, far->origin)) * (inside ? -1.0 : 1.0);
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

static void choose_tiles(Job *job, Eye eye) {
    for (int s = 0; s < FACES; s++) {
        const Face *face = &job->box->faces[s];
        job->tiles[s] = allocate((size_t)face->tile_count + 1, sizeof *job->tiles[s]);
        if (!(job->parts.sources & 1u << s)) continue;
        for (int t = 0; t < face->tile_count; t++)
            if (!tile_faces_away(&face->tiles[t], eye))
                job->tiles[s][job->tile_counts[s]++] = &face->tiles[t];
    }
}

void warp_box(Warp *warp, const Box *box, Eye eye, Parts parts) {
    Seen seen = box_faces_seen(box, eye);
    Job job = {.warp = warp, .box = box, .parts = parts, .inside = seen.inside};
    warp->count = seen.count;
    for (int t = 0; t < seen.count; t++) {
        warp->destinations[t].face = seen.faces[t];
        for (int s = 0; s < FACES; s++) job.maps[t][s] = map_between(box, s, seen.faces[t], eye, seen.inside);
    }
    choose_tiles(&job, eye);
    parallel_for(seen.count * BANDS, fill_band, &job);
    for (int s = 0; s < FACES; s++) free(job.tiles[s]);
}

Warp warp_create(int size, int samples) {
    Warp warp = {.size = size, .samples = samples};
    size_t texels = (size_t)size * size, width = (size_t)size * samples;
    for (int i = 0; i < FACES; i++) {
        warp.destinations[i].colour = allocate(texels, 4 * sizeof(uint16_t));
        warp.destinations[i].normal = allocate(texels, 4 * sizeof(uint16_t));
    }
    warp.depths = allocate(width * (width + LANES) * FACES, sizeof *warp.depths);
    warp.texels = allocate(width * (width + LANES) * FACES, sizeof *warp.texels);
    return warp;
}

void warp_destroy(Warp *warp) {
    for (int i = 0; i < FACES; i++) {
        free(warp->destinations[i].colour);
        free(warp->destinations[i].normal);
    }
    free(warp->depths);
    free(warp->texels);
    *warp = (Warp){0};
}
