#include "brute.h"

#include "fail.h"
#include "image.h"
#include "parallel.h"
#include "solid_lanes.h"

#include <stdlib.h>

enum { BYTES_TABLE = 65536, BLOCKS_AT_ONCE = 16 };

struct Brute {
    const Field *field;
    const LightScene *scene;
    Vec3 axes[LIGHT_SOLIDS][3];
    float *sin_alpha, *cos_alpha, *sin_beta, *cos_beta; /* by s and by t */
    uint8_t bytes[BYTES_TABLE];
};

Brute *brute_create(const Field *field, const LightScene *scene) {
    Brute *brute = allocate(1, sizeof *brute);
    brute->field = field, brute->scene = scene;
    brute->sin_alpha = allocate(2 * (size_t)(field->s + field->t), sizeof(float));
    brute->cos_alpha = brute->sin_alpha + field->s;
    brute->sin_beta = brute->cos_alpha + field->s, brute->cos_beta = brute->sin_beta + field->t;
    const FieldFrame own = {.e_x = {1, 0, 0}, .e_y = {0, 1, 0}, .e_z = {0, 0, 1}};
    for (int i = 0; i < field->s; i++) {
        Vec3 d = field_direction(field, &own, (i + 0.5) / field->s, 0.5);
        brute->sin_alpha[i] = (float)d.x, brute->cos_alpha[i] = (float)d.z;
    }
    for (int i = 0; i < field->t; i++) {
        Vec3 d = field_direction(field, &own, 0.5, (i + 0.5) / field->t);
        brute->sin_beta[i] = (float)d.y, brute->cos_beta[i] = (float)d.z;
    }
    for (int i = 0; i < scene->count; i++) solid_axes_of(&scene->solids[i], brute->axes[i]);
    for (int i = 0; i < BYTES_TABLE; i++) brute->bytes[i] = srgb_byte((float)(i / (BYTES_TABLE - 1.0)));
    return brute;
}

void brute_destroy(Brute *brute) {
    free(brute->sin_alpha);
    free(brute);
}

/* ---- One ray: t w, w = -d, against one solid: the depth where it is met before `nearest`, else nearest.
 * face: the axis of the flat side that is met, or ROUND. ---- */

enum { ROUND = -1 };

static float meet_ball(const NearSolid *solid, Point w, float nearest) {
    float passing = dot(w, solid->centre), radius = solid->half.x;
    Point off = sum(scaled(w, passing), scaled(solid->centre, -1.0f));
    float inside = radius * radius - dot(off, off);
    if (inside < 0.0f) return nearest;
    float t = passing - sqrtf(inside);
    return t >= 0.0f && t < nearest ? t : nearest;
}

static float meet_can(const NearSolid *solid, Point w, float nearest, int *face) {
    float up = dot(w, solid->axis[1]), a = 1.0f - up * up, square = solid->half.x * solid->half.x;
    float c = dot(w, solid->around[1]), inside = a * square - c * c;
    float enter = -INFINITY, leave = INFINITY;
    if (a >= PARALLEL) {
        if (inside < 0.0f) return nearest;
        float b = dot(w, solid->centre) - up * solid->along[1], root = sqrtf(inside), per = 1.0f / a;
        enter = (b - root) * per, leave = (b + root) * per;
        if (enter >= nearest || leave < 0.0f) return nearest;
    }
    float per_up = 1.0f / up, side = copysignf(solid->half.y, up);
    float near = (solid->along[1] - side) * per_up, far = (solid->along[1] + side) * per_up;
    bool flat = near > enter;
    float t = flat ? near : enter;
    if (!(t <= leave && t <= far && t >= 0.0f && t < nearest)) return nearest;
    Point at = sum(scaled(w, t), scaled(solid->centre, -1.0f));
    float at_along = dot(at, solid->axis[1]);
    if (dot(at, at) - at_along * at_along > square * (1.0f + ROUND_ROOM)) return nearest;
    *face = flat ? 1 : ROUND;
    return t;
}

static float meet_crate(const NearSolid *solid, Point w, float nearest, int *face) {
    float passing = dot(w, solid->centre); /* comes it near at all? */
    Point off = sum(scaled(w, passing), scaled(solid->centre, -1.0f));
    if (dot(off, off) > dot(solid->half, solid->half)) return nearest;
    const float halves[3] = {solid->half.x, solid->half.y, solid->half.z};
    float enter = -INFINITY, leave = INFINITY;
    int entered = 0;
    for (int k = 0; k < 3; k++) {
        float w_along = dot(w, solid->axis[k]), per = 1.0f / w_along, side = copysignf(halves[k], w_along);
        float near = (solid->along[k] - side) * per, far = (solid->along[k] + side) * per;
        if (near > enter) enter = near, entered = k;
        if (far < leave) leave = far;
        if (enter > leave) return nearest;
    }
    if (!(enter >= 0.0f && enter < nearest)) return nearest;
    *face = entered;
    return enter;
}

static Point normal_at(const NearSolid *solid, Point w, float t, int face) {
    if (face != ROUND) return scaled(solid->axis[face], -copysignf(1.0f, dot(w, solid->axis[face])));
    Point at = sum(scaled(w, t), scaled(solid->centre, -1.0f));
    if (solid->kind == SOLID_CYLINDER) at = sum(at, scaled(solid->axis[1], -dot(at, solid->axis[1])));
    return scaled(at, 1.0f / solid->half.x);
}

static void shade_one(const Brute *brute, Point colour, Point light, Point normal, Point w, uint8_t *texel) {
    float facing = dot(normal, light), diffuse = (float)LIGHT_AMBIENT, highlight = 0.0f;
    if (facing > FACING_LEAST) {
        diffuse += (float)LIGHT_DIFFUSE * facing;
        float shine = dot(w, light) - 2.0f * facing * dot(normal, w);
        if (shine > 0.0f) {
            for (int i = 0; i < 5; i++) shine *= shine; /* ^32 */
            highlight = (float)LIGHT_SPECULAR * shine;
        }
    }
    const float channels[3] = {colour.x, colour.y, colour.z};
    for (int k = 0; k < 3; k++) {
        float sent = channels[k] * diffuse + highlight;
        texel[k] = brute->bytes[(int)((sent < 1.0f ? sent : 1.0f) * (BYTES_TABLE - 1) + 0.5f)];
    }
}

static void make_texel(const Brute *brute, const NearSolid *solids, Point light, Point w, uint8_t *texel) {
    float nearest = INFINITY;
    int first = -1, face = ROUND;
    for (int i = 0; i < brute->scene->count; i++) {
        int met_face = ROUND;
        float t = solids[i].kind == SOLID_SPHERE     ? meet_ball(&solids[i], w, nearest)
                  : solids[i].kind == SOLID_CYLINDER ? meet_can(&solids[i], w, nearest, &met_face)
                                                     : meet_crate(&solids[i], w, nearest, &met_face);
        if (t < nearest) nearest = t, first = i, face = met_face;
    }
    if (first < 0) return;
    Point normal = normal_at(&solids[first], w, nearest, face);
    shade_one(brute, solids[first].colour, light, normal, w, texel);
}

/* ---- Blocks ---- */

static void make_block(const Brute *brute, int u, int v, uint8_t *texels) {
    const Field *field = brute->field;
    FieldFrame frame = field_frame(field, (u + 0.5) / field->u, (v + 0.5) / field->v);
    NearSolid solids[LIGHT_SOLIDS];
    for (int i = 0; i < brute->scene->count; i++)
        solids[i] = near_solid(&brute->scene->solids[i], brute->axes[i], &frame);
    Point light = point_in(&frame, brute->scene->toward_light);
    memset(texels, 0, field_block(field));
    for (int t = 0; t < field->t; t++)
        for (int s = 0; s < field->s; s++, texels += FIELD_TEXEL) {
            float cosine = brute->cos_beta[t];
            Point w = {-cosine * brute->sin_alpha[s], -brute->sin_beta[t], -cosine * brute->cos_alpha[s]};
            make_texel(brute, solids, light, w, texels);
        }
}

typedef struct {
    const Brute *brute;
    int first, per_row;
    uint8_t *texels;
} Job;

static void make_blocks(void *context, int i) {
    const Job *job = context;
    const Field *field = job->brute->field;
    int v = i / job->per_row, begin = i % job->per_row * BLOCKS_AT_ONCE, end = begin + BLOCKS_AT_ONCE;
    for (int u = begin; u < end && u < field->u; u++)
        make_block(job->brute, u, job->first + v,
                   job->texels + ((size_t)v * (size_t)field->u + (size_t)u) * field_block(field));
}

void brute_rows(const Brute *brute, int first, int rows, uint8_t *texels) {
    int per_row = (brute->field->u + BLOCKS_AT_ONCE - 1) / BLOCKS_AT_ONCE;
    Job job = {brute, first, per_row, texels};
    parallel_for(rows * per_row, make_blocks, &job);
}
