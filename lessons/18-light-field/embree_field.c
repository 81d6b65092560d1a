#include "embree_field.h"

#include "fail.h"
#include "image.h"
#include "parallel.h"
#include "solid_lanes.h"

#include <embree3/rtcore.h>
#include <stdlib.h>

/* A chunk of rays is handed over, then shaded; its rays, of 80 bytes, stay in the cache nearest to the core.
 */
enum { CHUNK = 256, PACKET = 16, BLOCKS_AT_ONCE = 16, BYTES_TABLE = 65536 };

/* Triangles, so many that a picture shows no edges: a ball of 64 x 128 x 2, a cylinder of 256 sides. */
enum { BALL_ROWS = 64, BALL_COLUMNS = 128, SIDES = 256 };

/* A ray as 20 numbers, in this order; Embree has them for 1, 4, 8, 16 or N rays each as arrays of so many. */
enum {
    ORIGIN,
    NEAR = 3,
    WAY,
    TIME = 7,
    FAR,
    MASK,
    NUMBER,
    FLAGS,
    NORMAL,
    PLACE = 15,
    PRIMITIVE = 17,
    GEOMETRY,
    INSTANCE,
    RAY_NUMBERS
};

const char *const embree_way_names[EMBREE_WAYS] = {"rtcIntersect1",  "rtcIntersect4",  "rtcIntersect8",
                                                   "rtcIntersect16", "rtcIntersect1M", "rtcIntersectNM",
                                                   "rtcIntersectNp"};

struct EmbreeField {
    const Field *field;
    const LightScene *scene;
    bool meshes;
    RTCDevice device;
    RTCScene tree;
    Vec3 axes[LIGHT_SOLIDS][3];
    int count;       /* rays of a block, and then some that repeat the last, to a multiple of PACKET */
    int32_t *texels; /* which texel of its block each ray is for */
    float *way[3];   /* the rays' directions in the frame of the block: -d */
    uint8_t bytes[BYTES_TABLE];
};

/* ---- User geometry ---- */

/* One block's question: its solids, seen from where its rays start. Embree hands its context on. */
typedef struct {
    struct RTCIntersectContext context;
    const NearSolid *solids;
} Query;

static void solid_bounds(const struct RTCBoundsFunctionArguments *arguments) {
    const EmbreeField *embree = arguments->geometryUserPtr;
    const Solid *solid = &embree->scene->solids[arguments->primID];
    const Vec3 *axes = embree->axes[arguments->primID];
    Vec3 half = vec3_scale(solid->size, 0.5), c = solid->centre, reach;
    if (solid->kind == SOLID_SPHERE)
        reach = v3(half.x, half.x, half.x);
    else if (solid->kind == SOLID_CYLINDER) {
        Vec3 a = axes[1]; /* a disc of normal a reaches r sqrt(1 - a.x^2) along x */
        reach = v3(half.x * sqrt(fmax(1 - a.x * a.x, 0)) + half.y * fabs(a.x),
                   half.x * sqrt(fmax(1 - a.y * a.y, 0)) + half.y * fabs(a.y),
                   half.x * sqrt(fmax(1 - a.z * a.z, 0)) + half.y * fabs(a.z));
    } else
        reach = v3(half.x * fabs(axes[0].x) + half.y * fabs(axes[1].x) + half.z * fabs(axes[2].x),
                   half.x * fabs(axes[0].y) + half.y * fabs(axes[1].y) + half.z * fabs(axes[2].y),
                   half.x * fabs(axes[0].z) + half.y * fabs(axes[1].z) + half.z * fabs(axes[2].z));
    const double room = 1e-5;
    *arguments->bounds_o = (struct RTCBounds){.lower_x = (float)(c.x - reach.x - room),
                                              .lower_y = (float)(c.y - reach.y - room),
                                              .lower_z = (float)(c.z - reach.z - room),
                                              .upper_x = (float)(c.x + reach.x + room),
                                              .upper_y = (float)(c.y + reach.y + room),
                                              .upper_z = (float)(c.z + reach.z + room)};
}

/* The first `lanes` numbers, the rest being 0: a packet of four or a single ray is computed as eight. */
#define SOME_FLOATS(from, lanes)                                                                             \
    __extension__({                                                                                          \
        Floats some_ = {0};                                                                                  \
        if ((lanes) == LANES)                                                                                \
            LOAD(some_, from);                                                                               \
        else                                                                                                 \
            memcpy(&some_, from, (size_t)(lanes) * sizeof(float));                                           \
        some_;                                                                                               \
    })

INLINE void solid_meet(const NearSolid *solid, const struct RTCIntersectFunctionNArguments *arguments,
                       int first, int lanes, SolidKind kind) {
    const unsigned n = arguments->N;
    float *ray = (float *)arguments->rayhit + first;
    Ints valid = {0};
    memcpy(&valid, arguments->valid + first, (size_t)lanes * sizeof(int));
    Points w = {SOME_FLOATS(ray + WAY * n, lanes), SOME_FLOATS(ray + (WAY + 1) * n, lanes),
                SOME_FLOATS(ray + (WAY + 2) * n, lanes)};
    Meeting meeting;
    if (kind == SOLID_SPHERE)
        meet_sphere(solid, &w, 0.0f, &meeting);
    else if (kind == SOLID_CYLINDER)
        meet_cylinder(solid, &w, 0.0f, &meeting);
    else
        meet_box(solid, &w, 0.0f, &meeting);
    Floats far = SOME_FLOATS(ray + FAR * n, lanes);
    Ints nearer = meeting.met & (meeting.t < far) & valid;
    if (!ANY(nearer)) return;
    const Floats found[4] = {meeting.t, meeting.normal.x, meeting.normal.y, meeting.normal.z};
    static const int fields[4] = {FAR, NORMAL, NORMAL + 1, NORMAL + 2};
    for (int k = 0; k < 4; k++) {
        Floats before = SOME_FLOATS(ray + (unsigned)fields[k] * n, lanes);
        before = PICK(nearer, found[k], before);
        memcpy(ray + (unsigned)fields[k] * n, &before, (size_t)lanes * sizeof(float));
    }
    const Ints ids[2] = {(Ints){0} + (int)arguments->primID, (Ints){0} + (int)arguments->geomID};
    for (unsigned k = 0; k < 2; k++) {
        Ints before = {0};
        float *at = ray + (PRIMITIVE + k) * n;
        memcpy(&before, at, (size_t)lanes * sizeof(float));
        before = PICK_INTS(nearer, ids[k], before);
        memcpy(at, &before, (size_t)lanes * sizeof(float));
    }
}

INLINE void solid_meet_run(const NearSolid *solid, const struct RTCIntersectFunctionNArguments *arguments,
                           int first, int lanes) {
    if (solid->kind == SOLID_SPHERE) solid_meet(solid, arguments, first, lanes, SOLID_SPHERE);
    if (solid->kind == SOLID_CYLINDER) solid_meet(solid, arguments, first, lanes, SOLID_CYLINDER);
    if (solid->kind == SOLID_BOX) solid_meet(solid, arguments, first, lanes, SOLID_BOX);
}

WIDE static void solid_meet_all(const struct RTCIntersectFunctionNArguments *arguments) {
    const NearSolid *solid = &((const Query *)arguments->context)->solids[arguments->primID];
    int n = (int)arguments->N;
    if (n == 1) solid_meet_run(solid, arguments, 0, 1);
    if (n == 4) solid_meet_run(solid, arguments, 0, 4);
    for (int i = 0; n >= LANES && i < n; i += LANES) solid_meet_run(solid, arguments, i, LANES);
}

static void user_geometry(EmbreeField *embree) {
    RTCGeometry geometry = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)embree->scene->count);
    rtcSetGeometryUserData(geometry, embree);
    rtcSetGeometryBoundsFunction(geometry, solid_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, solid_meet_all);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree->tree, geometry);
    rtcReleaseGeometry(geometry);
}

/* ---- Meshes: a geometry a solid, so that its number is the solid's ---- */

typedef struct {
    Vec3 *corners;
    unsigned (*triangles)[3];
    int corner_count, triangle_count;
} Triangles;

static void triangle(Triangles *out, int a, int b, int c) {
    unsigned *to = out->triangles[out->triangle_count++];
    to[0] = (unsigned)a, to[1] = (unsigned)b, to[2] = (unsigned)c;
}

static void corner(Triangles *out, double x, double y, double z) {
    out->corners[out->corner_count++] = v3(x, y, z);
}

static void ball_triangles(Triangles *out) {
    for (int row = 0; row <= BALL_ROWS; row++)
        for (int i = 0; i <= BALL_COLUMNS; i++) {
            double b = PI * row / BALL_ROWS, a = 2 * PI * (i % BALL_COLUMNS) / BALL_COLUMNS;
            corner(out, sin(b) * cos(a), cos(b), sin(b) * sin(a));
            if (row == BALL_ROWS || i == BALL_COLUMNS) continue;
            int p = row * (BALL_COLUMNS + 1) + i, q = p + BALL_COLUMNS + 1;
            if (row > 0) triangle(out, p, p + 1, q + 1);
            if (row < BALL_ROWS - 1) triangle(out, p, q + 1, q);
        }
}

static void cylinder_triangles(Triangles *out) {
    corner(out, 0, -1, 0), corner(out, 0, 1, 0);
    for (int i = 0; i < SIDES; i++) {
        double a = 2 * PI * i / SIDES;
        corner(out, cos(a), -1, sin(a)), corner(out, cos(a), 1, sin(a));
        int p = 2 + 2 * i, q = 2 + 2 * ((i + 1) % SIDES);
        triangle(out, p, p + 1, q + 1), triangle(out, p, q + 1, q);
        triangle(out, 0, p, q), triangle(out, 1, q + 1, p + 1);
    }
}

static void box_triangles(Triangles *out) {
    for (int i = 0; i < 8; i++) corner(out, i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            int at = side << axis, x = 1 << (axis + 1) % 3, y = 1 << (axis + 2) % 3;
            triangle(out, at, at + x, at + x + y), triangle(out, at, at + x + y, at + y);
        }
}

static int mesh_geometry(EmbreeField *embree, int i) {
    const Solid *solid = &embree->scene->solids[i];
    const Vec3 *axes = embree->axes[i];
    enum { MOST = 2 * (BALL_ROWS + 1) * (BALL_COLUMNS + 1) };
    Triangles own = {allocate(MOST, sizeof(Vec3)), allocate(MOST, sizeof *own.triangles), 0, 0};
    if (solid->kind == SOLID_SPHERE) ball_triangles(&own);
    if (solid->kind == SOLID_CYLINDER) cylinder_triangles(&own);
    if (solid->kind == SOLID_BOX) box_triangles(&own);
    RTCGeometry geometry = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float(*corners)[3] = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 sizeof *corners, (size_t)own.corner_count);
    void *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof *own.triangles, (size_t)own.triangle_count);
    memcpy(indices, own.triangles, sizeof *own.triangles * (size_t)own.triangle_count);
    Vec3 half = vec3_scale(solid->size, 0.5);
    if (solid->kind == SOLID_SPHERE) half = v3(half.x, half.x, half.x);
    if (solid->kind == SOLID_CYLINDER) half.z = half.x;
    for (int k = 0; k < own.corner_count; k++) {
        Vec3 p = vec3_multiply(own.corners[k], half);
        p = vec3_add(vec3_add(vec3_scale(axes[0], p.x), vec3_scale(axes[1], p.y)), vec3_scale(axes[2], p.z));
        p = vec3_add(p, solid->centre);
        corners[k][0] = (float)p.x, corners[k][1] = (float)p.y, corners[k][2] = (float)p.z;
    }
    free(own.corners), free(own.triangles);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree->tree, geometry, (unsigned)i);
    rtcReleaseGeometry(geometry);
    return own.triangle_count;
}

/* ---- */

static void embree_failed(void *context, enum RTCError error, const char *message) {
    (void)context, (void)error;
    fail("Embree: %s", message);
}

/* Every other bit of i. */
static int half_bits(unsigned i) {
    int x = 0;
    for (int bit = 0; bit < 15; bit++) x |= (int)(i >> (2 * bit) & 1) << bit;
    return x;
}

/* Texels along the Morton curve of a square that holds the grid, without those that are outside the grid. */
static void order_rays(EmbreeField *embree) {
    const Field *field = embree->field;
    const FieldFrame own = {.e_x = {1, 0, 0}, .e_y = {0, 1, 0}, .e_z = {0, 0, 1}};
    int rays = field->s * field->t, n = 0;
    embree->count = (rays + PACKET - 1) / PACKET * PACKET;
    embree->texels = allocate((size_t)embree->count, sizeof(int32_t));
    for (int k = 0; k < 3; k++) embree->way[k] = allocate((size_t)embree->count, sizeof(float));
    for (unsigned i = 0; n < embree->count; i++) {
        int s = half_bits(i), t = half_bits(i >> 1);
        if (n >= rays) s = t = 0; /* repeats one */
        if (s >= field->s || t >= field->t) continue;
        Vec3 d = field_direction(field, &own, (s + 0.5) / field->s, (t + 0.5) / field->t);
        embree->way[0][n] = -(float)d.x, embree->way[1][n] = -(float)d.y, embree->way[2][n] = -(float)d.z;
        embree->texels[n++] = t * field->s + s;
    }
}

EmbreeField *embree_field_create(const Field *field, const LightScene *scene, bool meshes, int *triangles) {
    EmbreeField *embree = allocate(1, sizeof *embree);
    embree->field = field, embree->scene = scene, embree->meshes = meshes;
    order_rays(embree);
    for (int i = 0; i < BYTES_TABLE; i++) embree->bytes[i] = srgb_byte((float)(i / (BYTES_TABLE - 1.0)));
    embree->device = rtcNewDevice("threads=1"); /* which prepare the tree; ours ask the rays */
    if (!embree->device) fail("Embree: no device (error %d)", (int)rtcGetDeviceError(NULL));
    rtcSetDeviceErrorFunction(embree->device, embree_failed, NULL);
    embree->tree = rtcNewScene(embree->device);
    rtcSetSceneBuildQuality(embree->tree, RTC_BUILD_QUALITY_HIGH);
    int sum = 0;
    for (int i = 0; i < scene->count; i++) {
        solid_axes_of(&scene->solids[i], embree->axes[i]);
        if (meshes) sum += mesh_geometry(embree, i);
    }
    if (!meshes) user_geometry(embree);
    rtcCommitScene(embree->tree);
    if (triangles) *triangles = sum;
    return embree;
}

void embree_field_destroy(EmbreeField *embree) {
    rtcReleaseScene(embree->tree);
    rtcReleaseDevice(embree->device);
    for (int k = 0; k < 3; k++) free(embree->way[k]);
    free(embree->texels);
    free(embree);
}

/* ---- Blocks ---- */

/* A chunk of rays, as packets of `packet` rays one behind the other (1: one ray behind the other; CHUNK:
 * arrays), and what they met. */
typedef struct {
    _Alignas(64) float rays[CHUNK * RAY_NUMBERS];
    int hits;
    int32_t solid[CHUNK + LANES], texel[CHUNK + LANES];
    float way[3][CHUNK + LANES], normal[3][CHUNK + LANES];
} Chunk;

/* Where a block's rays start and lie. */
typedef struct {
    Query query;
    NearSolid solids[LIGHT_SOLIDS];
    Point origin, e_x, e_y, e_z, light;
} Block;

/* The parts of rays that are the same for all. */
static void rays_prepare(Chunk *chunk, int packet, Point origin) {
    const float each[3] = {origin.x, origin.y, origin.z};
    const uint32_t mask = UINT32_MAX;
    for (int i = 0; i < CHUNK; i++) {
        float *ray = chunk->rays + i / packet * packet * RAY_NUMBERS + i % packet;
        for (int k = 0; k < 3; k++) ray[(ORIGIN + k) * packet] = each[k];
        ray[NEAR * packet] = ray[TIME * packet] = ray[NUMBER * packet] = ray[FLAGS * packet] = 0.0f;
        memcpy(&ray[MASK * packet], &mask, sizeof mask);
        memcpy(&ray[INSTANCE * packet], &mask, sizeof mask);
    }
}

INLINE void rays_aim_by(Chunk *chunk, int packet, const EmbreeField *embree, const Block *block, int first,
                        int count) {
    const Point x = block->e_x, y = block->e_y, z = block->e_z;
    const Ints none = (Ints){0} - 1;
    const Floats far = ALL(INFINITY);
    for (int i = 0; i < count; i += LANES) {
        Floats a = FLOATS_AT(embree->way[0] + first + i), b = FLOATS_AT(embree->way[1] + first + i),
               c = FLOATS_AT(embree->way[2] + first + i);
        const Floats way[3] = {a * x.x + b * y.x + c * z.x, a * x.y + b * y.y + c * z.y,
                               a * x.z + b * y.z + c * z.z};
        if (packet >= LANES) {
            float *ray = chunk->rays + i / packet * packet * RAY_NUMBERS + i % packet;
            for (int k = 0; k < 3; k++) STORE(way[k], ray + (WAY + k) * packet);
            STORE(far, ray + FAR * packet);
            STORE(none, ray + GEOMETRY * packet);
            continue;
        }
        for (int lane = 0; lane < LANES; lane++) {
            float *ray = chunk->rays + (i + lane) / packet * packet * RAY_NUMBERS + (i + lane) % packet;
            for (int k = 0; k < 3; k++) ray[(WAY + k) * packet] = way[k][lane];
            ray[FAR * packet] = INFINITY;
            memcpy(ray + GEOMETRY * packet, &none, sizeof(float));
        }
    }
}

/* One for each packet, so that the compiler knows where numbers lie. */
WIDE static void rays_aim(Chunk *chunk, int packet, const EmbreeField *embree, const Block *block, int first,
                          int count) {
    if (packet == 1) rays_aim_by(chunk, 1, embree, block, first, count);
    if (packet == 4) rays_aim_by(chunk, 4, embree, block, first, count);
    if (packet == 8) rays_aim_by(chunk, 8, embree, block, first, count);
    if (packet == 16) rays_aim_by(chunk, 16, embree, block, first, count);
    if (packet == CHUNK) rays_aim_by(chunk, CHUNK, embree, block, first, count);
}

static const int packet_of[EMBREE_WAYS] = {1, 4, 8, 16, 1, PACKET, CHUNK};

static void trace(const EmbreeField *embree, EmbreeWay way, Query *query, Chunk *chunk, int count) {
    static const _Alignas(64) int all[PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                 -1, -1, -1, -1, -1, -1, -1, -1};
    struct RTCIntersectContext *context = &query->context;
    const int packet = packet_of[way];
    float *rays = chunk->rays;
    void *at = rays;
    if (way <= EMBREE_16)
        for (int i = 0; i < count; i += packet) {
            at = rays + i * RAY_NUMBERS;
            if (way == EMBREE_1) rtcIntersect1(embree->tree, context, at);
            if (way == EMBREE_4) rtcIntersect4(all, embree->tree, context, at);
            if (way == EMBREE_8) rtcIntersect8(all, embree->tree, context, at);
            if (way == EMBREE_16) rtcIntersect16(all, embree->tree, context, at);
        }
    if (way == EMBREE_1M)
        rtcIntersect1M(embree->tree, context, at, (unsigned)count, RAY_NUMBERS * sizeof(float));
    if (way == EMBREE_NM)
        rtcIntersectNM(embree->tree, context, at, PACKET, (unsigned)(count / PACKET),
                       PACKET * RAY_NUMBERS * sizeof(float));
    if (way != EMBREE_NP) return;
#define ARRAY(number) (rays + (number)*CHUNK)
#define WORDS(number) ((void *)ARRAY(number))
    struct RTCRayHitNp arrays = {.ray = {.org_x = ARRAY(ORIGIN),
                                         .org_y = ARRAY(ORIGIN + 1),
                                         .org_z = ARRAY(ORIGIN + 2),
                                         .tnear = ARRAY(NEAR),
                                         .dir_x = ARRAY(WAY),
                                         .dir_y = ARRAY(WAY + 1),
                                         .dir_z = ARRAY(WAY + 2),
                                         .time = ARRAY(TIME),
                                         .tfar = ARRAY(FAR),
                                         .mask = WORDS(MASK),
                                         .id = WORDS(NUMBER),
                                         .flags = WORDS(FLAGS)},
                                 .hit = {.Ng_x = ARRAY(NORMAL),
                                         .Ng_y = ARRAY(NORMAL + 1),
                                         .Ng_z = ARRAY(NORMAL + 2),
                                         .u = ARRAY(PLACE),
                                         .v = ARRAY(PLACE + 1),
                                         .primID = WORDS(PRIMITIVE),
                                         .geomID = WORDS(GEOMETRY),
                                         .instID = {WORDS(INSTANCE)}}};
    rtcIntersectNp(embree->tree, context, &arrays, (unsigned)count);
}

/* A triangle's normal is its solid's there: of what is round, by the point, else its own. */
static Point mesh_normal(const NearSolid *solid, Point way, float t, Point own) {
    Point at = sum(scaled(way, t), scaled(solid->centre, -1.0f));
    if (solid->kind == SOLID_SPHERE) return scaled(at, 1.0f / sqrtf(dot(at, at)));
    float length = sqrtf(dot(own, own)), up = dot(own, solid->axis[1]);
    if (solid->kind == SOLID_CYLINDER && fabsf(up) < 0.5f * length) {
        at = sum(at, scaled(solid->axis[1], -dot(at, solid->axis[1])));
        return scaled(at, 1.0f / sqrtf(dot(at, at)));
    }
    return scaled(own, copysignf(1.0f / length, -dot(own, way)));
}

INLINE void gather_by(const EmbreeField *embree, const Block *block, Chunk *chunk, int packet, int first,
                      int count) {
    chunk->hits = 0;
    for (int i = 0; i < count; i++) {
        const float *ray = chunk->rays + i / packet * packet * RAY_NUMBERS + i % packet;
        int32_t geometry, primitive;
        if (packet >= LANES && i % LANES == 0) { /* eight that all miss */
            Ints ids;
            LOAD(ids, ray + GEOMETRY * packet);
            if (!ANY(ids + 1)) {
                i += LANES - 1;
                continue;
            }
        }
        memcpy(&geometry, ray + GEOMETRY * packet, sizeof geometry);
        if (geometry < 0) continue;
        memcpy(&primitive, ray + PRIMITIVE * packet, sizeof primitive);
        int hit = chunk->hits++, index = embree->meshes ? geometry : primitive;
        Point way = {ray[WAY * packet], ray[(WAY + 1) * packet], ray[(WAY + 2) * packet]};
        Point normal = {ray[NORMAL * packet], ray[(NORMAL + 1) * packet], ray[(NORMAL + 2) * packet]};
        if (embree->meshes) normal = mesh_normal(&block->solids[index], way, ray[FAR * packet], normal);
        chunk->solid[hit] = index, chunk->texel[hit] = embree->texels[first + i];
        chunk->way[0][hit] = way.x, chunk->way[1][hit] = way.y, chunk->way[2][hit] = way.z;
        chunk->normal[0][hit] = normal.x, chunk->normal[1][hit] = normal.y, chunk->normal[2][hit] = normal.z;
    }
}

static void gather(const EmbreeField *embree, const Block *block, Chunk *chunk, int packet, int first,
                   int count) {
    if (packet == 1) gather_by(embree, block, chunk, 1, first, count);
    if (packet == 4) gather_by(embree, block, chunk, 4, first, count);
    if (packet == 8) gather_by(embree, block, chunk, 8, first, count);
    if (packet == 16) gather_by(embree, block, chunk, 16, first, count);
    if (packet == CHUNK) gather_by(embree, block, chunk, CHUNK, first, count);
}

WIDE static void shade_hits(const EmbreeField *embree, const Block *block, const Chunk *chunk,
                            uint8_t *texels) {
    const Point white = {1, 1, 1}, black = {0, 0, 0};
    for (int i = 0; i < chunk->hits; i += LANES) {
        Points way = {FLOATS_AT(chunk->way[0] + i), FLOATS_AT(chunk->way[1] + i),
                      FLOATS_AT(chunk->way[2] + i)};
        Meeting meeting = {.normal = {FLOATS_AT(chunk->normal[0] + i), FLOATS_AT(chunk->normal[1] + i),
                                      FLOATS_AT(chunk->normal[2] + i)}};
        Points on_white, on_black; /* light is linear in the colour */
        shade(white, block->light, &meeting, &way, &on_white);
        shade(black, block->light, &meeting, &way, &on_black);
        Floats diffuse = on_white.x - on_black.x, highlight = on_black.x;
        for (int lane = 0; lane < LANES && i + lane < chunk->hits; lane++) {
            Point colour = block->solids[chunk->solid[i + lane]].colour;
            const float light[3] = {colour.x * diffuse[lane] + highlight[lane],
                                    colour.y * diffuse[lane] + highlight[lane],
                                    colour.z * diffuse[lane] + highlight[lane]};
            uint8_t *to = texels + FIELD_TEXEL * (size_t)chunk->texel[i + lane];
            for (int k = 0; k < 3; k++) {
                float most = light[k] < 1.0f ? light[k] : 1.0f;
                to[k] = embree->bytes[(int)(most * (BYTES_TABLE - 1) + 0.5f)];
            }
        }
    }
}

typedef struct {
    const EmbreeField *embree;
    EmbreeWay way;
    bool coherent;
    int first, per_row;
    uint8_t *texels;
} Job;

static void make_block(const Job *job, Chunk *chunk, int u, int v, uint8_t *texels) {
    const EmbreeField *embree = job->embree;
    const Field *field = embree->field;
    FieldFrame at = field_frame(field, (u + 0.5) / field->u, (v + 0.5) / field->v);
    FieldFrame world = {.at = at.at, .e_x = {1, 0, 0}, .e_y = {0, 1, 0}, .e_z = {0, 0, 1}};
    Block block = {.origin = point_of(at.at),
                   .e_x = point_of(at.e_x),
                   .e_y = point_of(at.e_y),
                   .e_z = point_of(at.e_z),
                   .light = point_of(embree->scene->toward_light)};
    for (int i = 0; i < embree->scene->count; i++)
        block.solids[i] = near_solid(&embree->scene->solids[i], embree->axes[i], &world);
    block.query.solids = block.solids;
    rtcInitIntersectContext(&block.query.context);
    if (job->coherent) block.query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    int packet = packet_of[job->way];
    rays_prepare(chunk, packet, block.origin);
    memset(texels, 0, field_block(field));
    for (int first = 0; first < embree->count; first += CHUNK) {
        int count = embree->count - first < CHUNK ? embree->count - first : CHUNK;
        rays_aim(chunk, packet, embree, &block, first, count);
        trace(embree, job->way, &block.query, chunk, count);
        gather(embree, &block, chunk, packet, first, count);
        shade_hits(embree, &block, chunk, texels);
    }
}

static void make_blocks(void *context, int i) {
    const Job *job = context;
    const Field *field = job->embree->field;
    Chunk chunk;
    memset(&chunk, 0, sizeof chunk);
    int v = i / job->per_row, begin = i % job->per_row * BLOCKS_AT_ONCE, end = begin + BLOCKS_AT_ONCE;
    for (int u = begin; u < end && u < field->u; u++)
        make_block(job, &chunk, u, job->first + v,
                   job->texels + ((size_t)v * (size_t)field->u + (size_t)u) * field_block(field));
}

void embree_field_rows(const EmbreeField *embree, EmbreeWay way, bool coherent, int first, int rows,
                       uint8_t *texels) {
    int per_row = (embree->field->u + BLOCKS_AT_ONCE - 1) / BLOCKS_AT_ONCE;
    Job job = {embree, way, coherent, first, per_row, texels};
    parallel_for(rows * per_row, make_blocks, &job);
}
