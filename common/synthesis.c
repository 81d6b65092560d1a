#include "synthesis.h"

#include "fail.h"
#include "image.h"
#include "parallel.h"
#include "solid_lanes.h"

#include <limits.h>
#include <stdlib.h>

enum { BYTES_TABLE = 65536, BLOCKS_AT_ONCE = 16 };

/* The directions of one sample of every texel, d = (cos beta sin alpha, sin beta, cos beta cos alpha) in the
 * local frame: columns along s, rows along t. Columns go on to a multiple of LANES. */
typedef struct {
    CellPlace place;
    float *sin_alpha, *cos_alpha, *sin_beta, *cos_beta;
} Grid;

struct Synthesis {
    const Field *field;
    const LightScene *scene;
    bool through;
    int samples, stride; /* stride: columns of a row in memory */
    Grid *grids;
    Vec3 axes[LIGHT_SOLIDS][3]; /* the solids' own, in the world */
    float reach[LIGHT_SOLIDS];  /* from their centres to their farthest points */
    uint8_t bytes[BYTES_TABLE]; /* sRGB of linear light i / 65535 */
};

/* ---- Samples ---- */

static long common_divisor(long a, long b) { return b ? common_divisor(b, a % b) : a; }

/* The powers of a modulo the samples, made odd: then the set is symmetric (see synthesis.h). */
static void generator(int samples, long a, long g[4]) {
    g[0] = 1;
    for (int k = 1; k < 4; k++) g[k] = g[k - 1] % samples * a % samples;
    for (int k = 0; k < 4; k++)
        if (g[k] % 2 == 0) g[k] += samples;
}

/* The square of the least distance of two samples, the cell repeated without end; in units of 1 / samples. */
static long least_distance(int samples, const long g[4]) {
    long least = LONG_MAX;
    for (long i = 1; i <= samples / 2; i++) {
        long sum = 0;
        for (int k = 0; k < 4; k++) {
            long x = i * g[k] % samples;
            if (x > samples / 2) x = samples - x;
            sum += x * x;
        }
        if (sum < least) least = sum;
    }
    return least;
}

void synthesis_places(int samples, CellPlace *places) {
    long best[4] = {1, 1, 1, 1}, farthest = -1;
    for (long a = 1; a < samples; a++) {
        long g[4];
        if (common_divisor(samples, a) != 1) continue;
        generator(samples, a, g);
        long distance = least_distance(samples, g);
        if (distance <= farthest) continue;
        farthest = distance;
        for (int k = 0; k < 4; k++) best[k] = g[k];
    }
    for (long i = 0; i < samples; i++) {
        double x[4];
        for (int k = 0; k < 4; k++) x[k] = (double)((2 * i + 1) * best[k] % (2 * samples)) / (2.0 * samples);
        places[i] = (CellPlace){x[0], x[1], x[2], x[3]};
    }
}

static Grid grid_create(const Field *field, int stride, CellPlace place) {
    Grid grid = {.place = place};
    grid.sin_alpha = allocate(2 * (size_t)(stride + field->t), sizeof(float));
    grid.cos_alpha = grid.sin_alpha + stride;
    grid.sin_beta = grid.cos_alpha + stride;
    grid.cos_beta = grid.sin_beta + field->t;
    const FieldFrame own = {.e_x = {1, 0, 0}, .e_y = {0, 1, 0}, .e_z = {0, 0, 1}};
    for (int i = 0; i < stride; i++) {
        Vec3 d = field_direction(field, &own, fmin((i + place.s) / field->s, 1.0), 0.5);
        grid.sin_alpha[i] = (float)d.x, grid.cos_alpha[i] = (float)d.z;
    }
    for (int i = 0; i < field->t; i++) {
        Vec3 d = field_direction(field, &own, 0.5, (i + place.t) / field->t);
        grid.sin_beta[i] = (float)d.y, grid.cos_beta[i] = (float)d.z;
    }
    return grid;
}

static float reach_of(const Solid *solid) {
    Vec3 size = solid->size;
    if (solid->kind == SOLID_SPHERE) return (float)(0.5 * size.x);
    if (solid->kind == SOLID_CYLINDER) return (float)(0.5 * hypot(size.x, size.y));
    return (float)(0.5 * vec3_length(size));
}

Synthesis *synthesis_create(const Field *field, const LightScene *scene, int samples, bool through) {
    if (field_refused(field))
        fail("a light field of %dx%dx%dx%d: %s", field->u, field->v, field->s, field->t,
             field_refused(field));
    if (samples < 1 || samples > SAMPLES_MOST)
        fail("%d rays a texel: there may be 1 to %d", samples, SAMPLES_MOST);
    Synthesis *synthesis = allocate(1, sizeof *synthesis);
    synthesis->field = field, synthesis->scene = scene, synthesis->through = through;
    synthesis->samples = samples, synthesis->stride = (field->s + LANES - 1) / LANES * LANES;
    synthesis->grids = allocate((size_t)samples, sizeof(Grid));
    CellPlace *places = allocate((size_t)samples, sizeof *places);
    synthesis_places(samples, places);
    for (int k = 0; k < samples; k++) synthesis->grids[k] = grid_create(field, synthesis->stride, places[k]);
    free(places);
    for (int i = 0; i < scene->count; i++) {
        solid_axes_of(&scene->solids[i], synthesis->axes[i]);
        synthesis->reach[i] = reach_of(&scene->solids[i]);
    }
    for (int i = 0; i < BYTES_TABLE; i++) synthesis->bytes[i] = srgb_byte((float)(i / (BYTES_TABLE - 1.0)));
    return synthesis;
}

void synthesis_destroy(Synthesis *synthesis) {
    for (int k = 0; k < synthesis->samples; k++) free(synthesis->grids[k].sin_alpha);
    free(synthesis->grids);
    free(synthesis);
}

/* ---- A solid in the frame of a block, whose origin is where the rays start ---- */

typedef struct {
    NearSolid near;
    int first_row, last_row, first_column, last_column; /* of the rays that may meet it */
} Local;

typedef struct {
    Local solids[LIGHT_SOLIDS];
    Point light;
    int first_row, last_row; /* that any ray meets anything in */
} Stand;

/* From an angle (radians) to 0..1. */
static float stored(FieldAngles angles, float a) {
    const float right = (float)(0.5 * PI);
    a = a < -right ? -right : a > right ? right : a;
    if (angles == ANGLES_SINE) return 0.5f + 0.5f * sinf(a);
    if (angles == ANGLES_STEREOGRAPHIC) return 0.5f + 0.5f * tanf(0.5f * a);
    return 0.5f + a * (float)(1.0 / PI);
}

/* The texels whose samples may lie between two angles; one more on each side, for rounding. */
static void span_of(FieldAngles angles, float low, float high, int count, float place, int *first,
                    int *last) {
    *first = (int)ceilf(stored(angles, low) * (float)count - place) - 1;
    *last = (int)floorf(stored(angles, high) * (float)count - place) + 1;
    if (*first < 0) *first = 0;
    if (*last > count - 1) *last = count - 1;
}

/* The rectangle of rays that may meet a sphere around the solid: the cone of half angle gamma around the
 * direction d from it, between two parallels, and two meridians that touch it. */
static void bound(const Synthesis *synthesis, const Grid *grid, float reach, Local *local) {
    const Field *field = synthesis->field;
    const float half_turn = (float)PI, right = (float)(0.5 * PI);
    float low_beta = -right, high_beta = right, low_alpha = -half_turn, high_alpha = half_turn;
    Point centre = local->near.centre;
    float distance = sqrtf(dot(centre, centre));
    if (distance > reach && !synthesis->through) {
        Point d = scaled(centre, -1.0f / distance);
        float sine = reach / distance, gamma = asinf(sine), level = sqrtf(d.x * d.x + d.z * d.z);
        float beta = atan2f(d.y, level);
        low_beta = beta - gamma, high_beta = beta + gamma;
        if (level > sine) {
            float alpha = atan2f(d.x, d.z), aside = asinf(sine / level);
            low_alpha = alpha - aside, high_alpha = alpha + aside;
        }
    }
    span_of(field->angles, low_beta, high_beta, field->t, (float)grid->place.t, &local->first_row,
            &local->last_row);
    span_of(field->angles, low_alpha, high_alpha, field->s, (float)grid->place.s, &local->first_column,
            &local->last_column);
    if (low_alpha > right || high_alpha < -right)
        local->last_row = local->first_row - 1; /* behind the point */
}

static Stand stand_at(const Synthesis *synthesis, const Grid *grid, const FieldFrame *frame) {
    const LightScene *scene = synthesis->scene;
    Stand stand = {.light = point_in(frame, scene->toward_light), .first_row = synthesis->field->t};
    stand.last_row = -1;
    for (int i = 0; i < scene->count; i++) {
        Local *local = &stand.solids[i];
        local->near = near_solid(&scene->solids[i], synthesis->axes[i], frame);
        bound(synthesis, grid, synthesis->reach[i], local);
        if (local->first_row > local->last_row || local->first_column > local->last_column) continue;
        if (local->first_row < stand.first_row) stand.first_row = local->first_row;
        if (local->last_row > stand.last_row) stand.last_row = local->last_row;
    }
    return stand;
}

/* One sample of all texels of a block: the light, and how far away it comes from (NOTHING: from nowhere). */
typedef struct {
    float *depth, *light[3];
    int32_t *index; /* of the solid */
} Plane;

static const float NOTHING = INFINITY;

INLINE void cast_solid(const Synthesis *synthesis, const Grid *grid, const Stand *stand, int index,
                       Plane *plane, SolidKind kind) {
    const Local *local = &stand->solids[index];
    float start = synthesis->through ? -INFINITY : 0.0f;
    for (int row = local->first_row; row <= local->last_row; row++) {
        float sine = grid->sin_beta[row], cosine = grid->cos_beta[row];
        for (int column = local->first_column / LANES * LANES; column <= local->last_column;
             column += LANES) {
            Floats sin_alpha, cos_alpha, depth;
            LOAD(sin_alpha, grid->sin_alpha + column);
            LOAD(cos_alpha, grid->cos_alpha + column);
            Points w = {-cosine * sin_alpha, ALL(-sine), -cosine * cos_alpha};
            Meeting meeting;
            if (kind == SOLID_SPHERE)
                meet_sphere(&local->near, &w, start, &meeting);
            else if (kind == SOLID_CYLINDER)
                meet_cylinder(&local->near, &w, start, &meeting);
            else
                meet_box(&local->near, &w, start, &meeting);
            size_t at = (size_t)row * (size_t)synthesis->stride + (size_t)column;
            LOAD(depth, plane->depth + at);
            Ints nearer = meeting.met & (meeting.t < depth);
            if (!ANY(nearer)) continue;
            depth = PICK(nearer, meeting.t, depth);
            STORE(depth, plane->depth + at);
            Points light;
            shade(local->near.colour, stand->light, &meeting, &w, &light);
            const Floats channels[3] = {light.x, light.y, light.z};
            for (int k = 0; k < 3; k++) {
                Floats before;
                LOAD(before, plane->light[k] + at);
                before = PICK(nearer, channels[k], before);
                STORE(before, plane->light[k] + at);
            }
            if (!plane->index) continue;
            Ints indices;
            LOAD(indices, plane->index + at);
            indices = (indices & ~nearer) | (nearer & index);
            STORE(indices, plane->index + at);
        }
    }
}

WIDE static void cast_block(const Synthesis *synthesis, const Grid *grid, const Stand *stand, Plane *plane) {
    for (int i = 0; i < synthesis->scene->count; i++) {
        SolidKind kind = stand->solids[i].near.kind;
        if (kind == SOLID_SPHERE) cast_solid(synthesis, grid, stand, i, plane, SOLID_SPHERE);
        if (kind == SOLID_CYLINDER) cast_solid(synthesis, grid, stand, i, plane, SOLID_CYLINDER);
        if (kind == SOLID_BOX) cast_solid(synthesis, grid, stand, i, plane, SOLID_BOX);
    }
}

/* ---- Shadows, a mirror, transparency: a ray at a time ---- */

typedef struct {
    float t;
    Point normal;
    int index; /* -1: nothing is met */
} Single;

/* Narrows enter..leave of a line at + t way to between two planes at -half and half. */
static bool between(float at, float way, float half, float *enter, float *leave, bool *entered) {
    float near = (-copysignf(half, way) - at) / way, far = (copysignf(half, way) - at) / way;
    *entered = near > *enter;
    if (*entered) *enter = near;
    if (far < *leave) *leave = far;
    return *enter <= *leave;
}

static bool meet_one(const NearSolid *solid, Point origin, Point way, float *t, Point *normal) {
    Point from = sum(origin, scaled(solid->centre, -1.0f));
    if (solid->kind == SOLID_SPHERE) {
        float passing = -dot(from, way);
        Point off = sum(from, scaled(way, passing));
        float inside = solid->half.x * solid->half.x - dot(off, off);
        if (inside < 0.0f) return false;
        *t = passing - sqrtf(inside);
        *normal = scaled(sum(from, scaled(way, *t)), 1.0f / solid->half.x);
        return *t > 0.0f;
    }
    const float halves[3] = {solid->half.x, solid->half.y, solid->half.z};
    float enter = -INFINITY, leave = INFINITY;
    int side = 1;
    bool entered;
    if (solid->kind == SOLID_CYLINDER) {
        float along = dot(from, solid->axis[1]), w_along = dot(way, solid->axis[1]);
        Point at = sum(from, scaled(solid->axis[1], -along));
        Point w = sum(way, scaled(solid->axis[1], -w_along));
        float a = dot(w, w), b = dot(at, w), c = dot(solid->axis[1], cross(at, w)), square = solid->half.x;
        square *= square;
        if (a >= PARALLEL) {
            float inside = a * square - c * c;
            if (inside < 0.0f) return false;
            enter = (-b - sqrtf(inside)) / a, leave = (-b + sqrtf(inside)) / a;
        }
        if (!between(along, w_along, solid->half.y, &enter, &leave, &entered)) return false;
        Point out = sum(at, scaled(w, enter));
        if (dot(out, out) > square * (1.0f + ROUND_ROOM)) return false;
        *normal =
            entered ? scaled(solid->axis[1], -copysignf(1.0f, w_along)) : scaled(out, 1.0f / solid->half.x);
    } else {
        for (int k = 0; k < 3; k++) {
            float w_along = dot(way, solid->axis[k]);
            if (!between(dot(from, solid->axis[k]), w_along, halves[k], &enter, &leave, &entered))
                return false;
            if (entered) side = k;
        }
        *normal = scaled(solid->axis[side], -copysignf(1.0f, dot(way, solid->axis[side])));
    }
    *t = enter;
    return enter > 0.0f;
}

static Single meet_first(const Synthesis *synthesis, const Stand *stand, int but, Point origin, Point way) {
    Single first = {.t = INFINITY, .index = -1};
    for (int i = 0; i < synthesis->scene->count; i++) {
        float t;
        Point normal;
        if (i != but && meet_one(&stand->solids[i].near, origin, way, &t, &normal) && t < first.t)
            first = (Single){t, normal, i};
    }
    return first;
}

static Point light_of(const Synthesis *synthesis, const Stand *stand, Single met, Point origin, Point way,
                      bool mirrors) {
    const LightScene *scene = synthesis->scene;
    Point at = sum(origin, scaled(way, met.t)), colour = stand->solids[met.index].near.colour, unused;
    float facing = dot(met.normal, stand->light), reaching = 1.0f, t;
    for (int i = 0; i < scene->count && facing > FACING_LEAST; i++)
        if (i != met.index && meet_one(&stand->solids[i].near, at, stand->light, &t, &unused))
            reaching *= (float)scene->clear[i];
    if (facing <= FACING_LEAST) reaching = 0.0f;
    float shine = fmaxf(dot(way, stand->light) - 2.0f * facing * dot(met.normal, way), 0.0f);
    for (int i = 0; i < 5; i++) shine *= shine; /* ^32 */
    float diffuse = (float)LIGHT_AMBIENT + (float)LIGHT_DIFFUSE * facing * reaching;
    float highlight = (float)LIGHT_SPECULAR * shine * reaching;
    Point light = sum(scaled(colour, diffuse), (Point){highlight, highlight, highlight});
    float mirror = mirrors ? (float)scene->mirror[met.index] : 0.0f, clear = (float)scene->clear[met.index];
    light = scaled(light, 1.0f - mirror - clear);
    Point mirrored = sum(way, scaled(met.normal, -2.0f * dot(met.normal, way)));
    for (int k = 0; k < 2; k++) {
        float share = k ? clear : mirror;
        Point onward = k ? way : mirrored;
        Single next = {.index = -1};
        if (share > 0.0f) next = meet_first(synthesis, stand, met.index, at, onward);
        if (next.index < 0) continue;
        light = sum(light, scaled(light_of(synthesis, stand, next, at, onward, k && mirrors), share));
    }
    return light;
}

/* Replaces the plain light of what was met. */
static void add_effects(const Synthesis *synthesis, const Grid *grid, const Stand *stand, Plane *plane) {
    for (int row = stand->first_row; row <= stand->last_row; row++)
        for (int column = 0; column < synthesis->field->s; column++) {
            size_t at = (size_t)row * (size_t)synthesis->stride + (size_t)column;
            if (plane->depth[at] == NOTHING) continue;
            float sine = grid->sin_beta[row], cosine = grid->cos_beta[row];
            Point way = {-cosine * grid->sin_alpha[column], -sine, -cosine * grid->cos_alpha[column]};
            Point origin = {0, 0, 0};
            Single met = {.t = plane->depth[at], .index = plane->index[at]};
            float t;
            meet_one(&stand->solids[met.index].near, origin, way, &t, &met.normal);
            Point light = light_of(synthesis, stand, met, origin, way, true);
            plane->light[0][at] = light.x, plane->light[1][at] = light.y, plane->light[2][at] = light.z;
        }
}

/* ---- Blocks ---- */

/* What one thread works in: the sample that is being cast, and the sums of all. */
typedef struct {
    Plane plane, sums;
    int32_t *hits;
    void *memory;
} Work;

static Work work_create(const Synthesis *synthesis) {
    size_t count = (size_t)synthesis->stride * (size_t)synthesis->field->t;
    float *next = malloc(10 * count * sizeof(float)); /* not cleared, which costs: what is read was written */
    if (!next) fail("out of memory: %zu directions of a light field", count);
    Work work = {.memory = next};
    for (int i = 0; i < 3; i++) work.plane.light[i] = next, next += count;
    for (int i = 0; i < 3; i++) work.sums.light[i] = next, next += count;
    work.plane.depth = next, next += count;
    work.sums.depth = next, next += count;
    work.hits = (int32_t *)next, next += count;
    if (synthesis->scene->effects) work.plane.index = (int32_t *)next;
    return work;
}

/* Adds a sample to the sums, rows first to last, the sums being 0 if it is the first. */
WIDE static void add_plane(const Synthesis *synthesis, Work *work, int first, int last) {
    size_t begin = (size_t)first * (size_t)synthesis->stride,
           end = (size_t)(last + 1) * (size_t)synthesis->stride;
    for (size_t at = begin; at < end; at += LANES) {
        Floats depth, total;
        Ints hits;
        LOAD(depth, work->plane.depth + at);
        Ints met = depth < NOTHING;
        if (!ANY(met)) continue;
        for (int k = 0; k < 3; k++) {
            Floats light;
            LOAD(light, work->plane.light[k] + at);
            LOAD(total, work->sums.light[k] + at);
            total += PICK(met, light, ALL(0.0f));
            STORE(total, work->sums.light[k] + at);
        }
        LOAD(total, work->sums.depth + at);
        total += PICK(met, depth, ALL(0.0f));
        STORE(total, work->sums.depth + at);
        LOAD(hits, work->hits + at);
        hits -= met;
        STORE(hits, work->hits + at);
    }
}

/* All samples of one block, summed in work; returns the rows that hold anything. */
typedef struct {
    int first, last;
} Rows;

static void clear_rows(const Synthesis *synthesis, Work *work, int first, int last) {
    size_t begin = (size_t)first * (size_t)synthesis->stride,
           count = (size_t)(last - first + 1) * (size_t)synthesis->stride;
    for (int k = 0; k < 3; k++) memset(work->sums.light[k] + begin, 0, count * sizeof(float));
    memset(work->sums.depth + begin, 0, count * sizeof(float));
    memset(work->hits + begin, 0, count * sizeof(int32_t));
}

static Rows sum_block(const Synthesis *synthesis, Work *work, int u, int v) {
    const Field *field = synthesis->field;
    Rows rows = {field->t, -1};
    for (int k = 0; k < synthesis->samples; k++) {
        const Grid *grid = &synthesis->grids[k];
        FieldFrame frame = field_frame(field, (u + grid->place.u) / field->u, (v + grid->place.v) / field->v);
        Stand stand = stand_at(synthesis, grid, &frame);
        if (stand.first_row > stand.last_row) continue;
        if (rows.last < 0) {
            rows = (Rows){stand.first_row, stand.last_row};
            clear_rows(synthesis, work, rows.first, rows.last);
        }
        if (stand.first_row < rows.first) {
            clear_rows(synthesis, work, stand.first_row, rows.first - 1);
            rows.first = stand.first_row;
        }
        if (stand.last_row > rows.last) {
            clear_rows(synthesis, work, rows.last + 1, stand.last_row);
            rows.last = stand.last_row;
        }
        float *depth = work->plane.depth + (size_t)stand.first_row * (size_t)synthesis->stride;
        size_t count = (size_t)(stand.last_row - stand.first_row + 1) * (size_t)synthesis->stride;
        for (size_t i = 0; i < count; i++) depth[i] = NOTHING;
        cast_block(synthesis, grid, &stand, &work->plane);
        if (synthesis->scene->effects) add_effects(synthesis, grid, &stand, &work->plane);
        add_plane(synthesis, work, stand.first_row, stand.last_row);
    }
    return rows;
}

/* Rows first to last of a block: what nothing was met at has the sum 0, and so becomes black. */
WIDE static void write_rows(const Synthesis *synthesis, const Work *work, Rows rows, uint8_t *texels) {
    const int width = synthesis->field->s;
    const float share = 1.0f / (float)synthesis->samples;
    for (int row = rows.first; row <= rows.last; row++)
        for (int column = 0; column < width; column += LANES) {
            size_t at = (size_t)row * (size_t)synthesis->stride + (size_t)column;
            Ints hits, index[3];
            LOAD(hits, work->hits + at);
            if (!ANY(hits)) continue;
            for (int k = 0; k < 3; k++) {
                Floats light;
                LOAD(light, work->sums.light[k] + at);
                index[k] = INTS_OF(LEAST(light * share, ALL(1.0f)) * (BYTES_TABLE - 1) + 0.5f);
            }
            uint8_t *to = texels + FIELD_TEXEL * ((size_t)row * (size_t)width + (size_t)column);
            int count = width - column < LANES ? width - column : LANES;
            for (int i = 0; i < count; i++)
                for (int k = 0; k < 3; k++) *to++ = synthesis->bytes[index[k][i]];
        }
}

static void write_block(const Synthesis *synthesis, const Work *work, Rows rows, uint8_t *texels,
                        float *depths) {
    const Field *field = synthesis->field;
    memset(texels, 0, field_block(field));
    write_rows(synthesis, work, rows, texels);
    if (!depths) return;
    for (int i = 0; i < field->s * field->t; i++) depths[i] = INFINITY;
    for (int row = rows.first; row <= rows.last; row++)
        for (int column = 0; column < field->s; column++) {
            size_t at = (size_t)row * (size_t)synthesis->stride + (size_t)column;
            if (work->hits[at])
                depths[row * field->s + column] = work->sums.depth[at] / (float)work->hits[at];
        }
}

/* ---- Rows of blocks, on all cores ---- */

typedef struct {
    const Synthesis *synthesis;
    int first, per_row; /* runs of BLOCKS_AT_ONCE blocks, which are one thread's work */
    uint8_t *texels;
    float *depths;
} Job;

static void make_blocks(void *context, int i) {
    const Job *job = context;
    const Field *field = job->synthesis->field;
    Work work = work_create(job->synthesis);
    int v = i / job->per_row, begin = i % job->per_row * BLOCKS_AT_ONCE, end = begin + BLOCKS_AT_ONCE;
    for (int u = begin; u < end && u < field->u; u++) {
        size_t block = (size_t)v * (size_t)field->u + (size_t)u;
        Rows rows = sum_block(job->synthesis, &work, u, job->first + v);
        write_block(job->synthesis, &work, rows, job->texels + block * field_block(field),
                    job->depths ? job->depths + block * (size_t)(field->s * field->t) : NULL);
    }
    free(work.memory);
}

void synthesis_rows(const Synthesis *synthesis, int first, int rows, uint8_t *texels, float *depths) {
    int per_row = (synthesis->field->u + BLOCKS_AT_ONCE - 1) / BLOCKS_AT_ONCE;
    Job job = {synthesis, first, per_row, texels, depths};
    parallel_for(rows * per_row, make_blocks, &job);
}

static void light_at(const Synthesis *synthesis, const Work *work, Rows rows, int s, int t, float *light) {
    size_t at = (size_t)t * (size_t)synthesis->stride + (size_t)s;
    bool any = t >= rows.first && t <= rows.last;
    for (int k = 0; k < 3; k++) light[k] = any ? work->sums.light[k][at] / (float)synthesis->samples : 0.0f;
}

void synthesis_block(const Synthesis *synthesis, int u, int v, float *light) {
    const Field *field = synthesis->field;
    Work work = work_create(synthesis);
    Rows rows = sum_block(synthesis, &work, u, v);
    for (int t = 0; t < field->t; t++)
        for (int s = 0; s < field->s; s++, light += 3) light_at(synthesis, &work, rows, s, t, light);
    free(work.memory);
}

void synthesis_texel(const Synthesis *synthesis, int u, int v, int s, int t, float *light) {
    Work work = work_create(synthesis);
    Rows rows = sum_block(synthesis, &work, u, v);
    light_at(synthesis, &work, rows, s, t, light);
    free(work.memory);
}
