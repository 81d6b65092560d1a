#include "judge.h"

#include "fail.h"
#include "image.h"
#include "rates.h"
#include "sampling.h"

#include <stdlib.h>

/* ---- The sixteen taps in doubles ---- */

static Vec3 texel_light(const Made *made, int u, int v, int s, int t) {
    const Field *field = &made->recipe.field;
    size_t block = (size_t)v * (size_t)field->u + (size_t)u,
           within = (size_t)t * (size_t)field->s + (size_t)s;
    const uint8_t *texel = made->texels + block * field_block(field) + within * FIELD_TEXEL;
    return v3(srgb_decode(texel[0] / 255.0), srgb_decode(texel[1] / 255.0), srgb_decode(texel[2] / 255.0));
}

/* Four taps between the centres of the texels of one block. */
static Vec3 angular_light(const Made *made, int u, int v, Vec2 angles) {
    const Field *field = &made->recipe.field;
    double s = clamp(angles.x * field->s - 0.5, 0, field->s - 1),
           t = clamp(angles.y * field->t - 0.5, 0, field->t - 1);
    int s0 = (int)fmin(floor(s), field->s - 2), t0 = (int)fmin(floor(t), field->t - 2);
    Vec3 low = vec3_mix(texel_light(made, u, v, s0, t0), texel_light(made, u, v, s0 + 1, t0), s - s0);
    Vec3 high =
        vec3_mix(texel_light(made, u, v, s0, t0 + 1), texel_light(made, u, v, s0 + 1, t0 + 1), s - s0);
    return vec3_mix(low, high, t - t0);
}

Vec3 judge_taps(const Made *made, Vec3 at, Vec3 toward) {
    const Field *field = &made->recipe.field;
    Vec2 place = field_place(field, at);
    FieldCell cell = field_cell(field, place.x, place.y);
    Vec3 light = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        FieldFrame frame = field_frame(field, (cell.u[i] + 0.5) / field->u, (cell.v[i] + 0.5) / field->v);
        Vec2 angles = field_angles(field, &frame, toward);
        light =
            vec3_add(light, vec3_scale(angular_light(made, cell.u[i], cell.v[i], angles), cell.weight[i]));
    }
    return light;
}

/* The largest difference of a picture's channels from those taps. */
static double off_taps(const Shots *shots, const Shot *shot, const Made *made) {
    const Frame *frame = shots->frame;
    Rays rays = camera_rays(&shot->view->camera, frame->width, frame->height);
    double largest = 0.0;
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++) {
            const Sample *centre = &shot->centres[(size_t)y * (size_t)frame->width + (size_t)x];
            if (!centre->hit || image_at(&shot->picture.lookup, x, y)[3] < 0.5f) continue;
            Ray ray = rays_at(&rays, x + 0.5, y + 0.5);
            Vec3 light = judge_taps(made, ray_at(ray, centre->depth), vec3_scale(ray.direction, -1.0));
            const float *drawn = image_at(&shot->picture.colour, x, y);
            const double differences[3] = {drawn[0] - light.x, drawn[1] - light.y, drawn[2] - light.z};
            for (int k = 0; k < 3; k++) largest = fmax(largest, fabs(differences[k]));
        }
    return 255.0 * largest;
}

/* ---- How it was made ---- */

enum { SAMPLES_MANY = 2401, SAMPLED_TEXELS = 100000, RATE_ROUNDS = 5 };

/* The rays a texel that it was made with, against 7^4. */
static void judge_samples(const Shots *shots, Table *table, const Made *made) {
    if (!shots_want(shots, NULL, "samples_rms") && !shots_want(shots, NULL, "samples_rms_codes")) return;
    const Recipe *recipe = &made->recipe;
    SamplingNoise noise = sampling_noise(&recipe->field, recipe->scene, recipe->through, recipe->samples,
                                         SAMPLES_MANY, SAMPLED_TEXELS);
    table_add(table, shots, NULL, "samples_rms", noise.linear, "linear");
    table_add(table, shots, NULL, "samples_rms_seeing", noise.linear_seeing, "linear");
    table_add(table, shots, NULL, "samples_rms_codes", noise.codes, "codes");
    table_add(table, shots, NULL, "samples_rms_codes_seeing", noise.codes_seeing, "codes");
}

void judge_rates(const Shots *shots, Table *table, const Field *field, const LightScene *scene) {
    if (!shots_want(shots, NULL, "rays_per_second") && !shots_want(shots, NULL, "brute_ratio") &&
        !shots_want(shots, NULL, "embree_ratio"))
        return;
    Field small = *field;
    small.u = 64, small.v = small.s = small.t = 32;
    Rates rates = rates_measure(&small, scene, RATE_ROUNDS);
    table_add(table, shots, NULL, "rays_per_second", rates.rays_per_second, "1/s");
    table_add(table, shots, NULL, "brute_rays_per_second", rates.brute_rays_per_second, "1/s");
    table_add(table, shots, NULL, "brute_ratio", rates.brute_ratio, "1");
    table_add(table, shots, NULL, "embree_ratio", rates.embree_ratio, "1");
    static const char *const kinds[2] = {"embree_solids", "embree_meshes"};
    for (int k = 0; k < 2; k++)
        for (int way = 0; way < EMBREE_WAYS; way++) {
            char *metric = text("%s_%s_rays_per_second", kinds[k], embree_way_names[way]);
            table_add(table, shots, NULL, metric, rates.embree_rays_per_second[k][way], "1/s");
            free(metric);
        }
}

void judge_field(const Shots *shots, Table *table, const Made *made) {
    if (shots_want(shots, NULL, "bytes"))
        table_add(table, shots, NULL, "bytes", (double)field_texture_bytes(&made->texture), "bytes");
    if (shots_want(shots, NULL, "synthesis_seconds"))
        table_add(table, shots, NULL, "synthesis_seconds", made->seconds, "s");
    if (shots->frame->knob > 0.0) judge_samples(shots, table, made);
    for (int i = 0; i < shots->count && made->texels; i++)
        if (shots_want(shots, shots->shots[i].view, "off_taps_max_255"))
            table_add(table, shots, shots->shots[i].view, "off_taps_max_255",
                      off_taps(shots, &shots->shots[i], made), "1/255");
}
