#include "judge.h"

#include "image.h"

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

void judge_field(const Shots *shots, Table *table, const Made *made) {
    if (shots_want(shots, NULL, "bytes"))
        table_add(table, shots, NULL, "bytes", (double)field_texture_bytes(&made->texture), "bytes");
    if (shots_want(shots, NULL, "synthesis_seconds"))
        table_add(table, shots, NULL, "synthesis_seconds", made->seconds, "s");
    for (int i = 0; i < shots->count && made->texels; i++)
        if (shots_want(shots, shots->shots[i].view, "off_taps_max_255"))
            table_add(table, shots, shots->shots[i].view, "off_taps_max_255",
                      off_taps(shots, &shots->shots[i], made), "1/255");
}
