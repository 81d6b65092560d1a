#include "relief.h"

#include "cone.h"
#include "clock.h"
#include "fail.h"
#include "hits.h"
#include "pyramid.h"

#include <stdlib.h>

static const double AMBIENT = 0.2; /* the light that shadows have too */

/* ---- The maps ---- */

static double milliseconds(void) { return 1e3 * clock_seconds(); }

Maps maps_create(const Image *height) {
    double start = milliseconds();
    Image corners = corners_build(height);
    Pyramid pyramid = pyramid_build(height);
    Maps maps = {.pyramid_ms = milliseconds() - start,
                 .corners = texture_create(&corners, 1, TEXTURE_FLOAT, TEXTURE_NEAREST),
                 .pyramid =
                     texture_create(pyramid.levels, pyramid.count, TEXTURE_FLOAT, TEXTURE_MIP_NEAREST)};
    image_destroy(&corners);
    pyramid_destroy(&pyramid);
    return maps;
}

void maps_need_cones(Maps *maps, const Image *height) {
    if (maps->cones.id) return;
    double start = milliseconds();
    Image cones = cone_build(height);
    maps->cones_ms = milliseconds() - start;
    maps->cones = texture_create(&cones, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    image_destroy(&cones);
}

void maps_bind(const Maps *maps, Program *program) {
    program_texture(program, "corner_map", &maps->corners);
    program_texture(program, "pyramid_map", &maps->pyramid);
    program_texture(program, "cone_map", &maps->cones);
}

void maps_destroy(Maps *maps) {
    texture_destroy(&maps->corners);
    texture_destroy(&maps->pyramid);
    if (maps->cones.id) texture_destroy(&maps->cones);
}

/* ---- Loading ---- */

/* From the upper left at first, then around the normal once in 12 s. */
static Vec3 light_after(double seconds) {
    double angle = radians(148.0 + 30.0 * seconds), tangent = 1.2;
    return vec3_normalize(v3(tangent * cos(angle), tangent * sin(angle), 1.0));
}

static Field *load(const Options *options) {
    Field *field = allocate(1, sizeof *field);
    wall_load(&field->wall, options);
    field->maps = maps_create(&field->wall.height_image);
    field->light = light_after(0.0);
    return field;
}

void *relief_load(const Options *options) { return load(options); }

void *relief_load_lit(const Options *options) {
    Field *field = load(options);
    field->lit = true;
    return field;
}

void *relief_load_cut(const Options *options) {
    Field *field = load(options);
    field->wall.relief.extent = RELIEF_CUT;
    field->wall.relief.base = 1.0; /* a ray that comes in over an edge would be cut at both ends */
    return field;
}

void relief_unload(void *data) {
    Field *field = data;
    maps_destroy(&field->maps);
    wall_unload(&field->wall);
    free(field);
}

/* ---- Drawing ---- */

void relief_draw(const Frame *frame) {
    Field *field = frame->data;
    if (frame->technique->variant == CONES) maps_need_cones(&field->maps, &field->wall.height_image);
    wall_bind(&field->wall, frame->program);
    maps_bind(&field->maps, frame->program);
    program_vector(frame->program, "light", field->light.x, field->light.y, field->light.z, 0);
    program_number(frame->program, "ambient", AMBIENT);
    /* How much higher than the point the light must be stopped: more than the two searches err. */
    program_number(frame->program, "bias", 0.005);
    shape_draw(&field->wall.polygon);
}

void relief_move(void *data, double seconds) {
    Field *field = data;
    field->light = light_after(seconds);
}

/* ---- The truth ---- */

bool relief_is_lit(const Relief *relief, Vec3 light, double u, double v) {
    double h, width = relief->width, height = relief->width * relief->aspect;
    image_sample(relief->height, u, v, &h);
    double z = width * relief->scale * (h - relief->base);
    /* Where the light's ray crosses the polygon, moved into its rectangle, for the relief repeats. */
    double x = (u - 0.5) * width - z * light.x / light.z, y = (v - 0.5) * height - z * light.y / light.z;
    x -= width * floor(x / width + 0.5), y -= height * floor(y / height + 0.5);
    /* The ray starts two widths before it comes to the relief's top, or to the polygon if that is higher. */
    double top = width * relief->scale * fmax(1.0 - relief->base, 0.0), far = 2.0 * width + top / light.z;
    Ray ray = {vec3_add(v3(x, y, 0), vec3_scale(light, far)), vec3_scale(light, -1.0)};
    Sample met = truth_relief(relief, ray);
    return met.hit && met.depth > far - z / light.z - 1e-6 * width;
}

Sample relief_truth(const void *data, Ray ray) {
    const Field *field = data;
    Sample sample = wall_truth(&field->wall, ray);
    if (!sample.hit || !field->lit) return sample;
    double lit = vec3_dot(truth_relief_normal(&field->wall.relief, sample.u, sample.v), field->light);
    if (lit < 0.0 || !relief_is_lit(&field->wall.relief, field->light, sample.u, sample.v)) lit = 0.0;
    sample.colour = vec3_scale(sample.colour, AMBIENT + (1.0 - AMBIENT) * lit);
    return sample;
}

Vec2 relief_texels(const void *data) {
    const Field *field = data;
    return v2(field->wall.height_image.width, field->wall.height_image.height);
}

/* ---- The lesson's own metrics ---- */

/* Of all levels of a texture of 32-bit floats. */
static double texture_bytes(const Texture *texture, int channels) {
    double texels = 0.0;
    for (int level = 0, width = texture->width, height = texture->height; level < texture->levels; level++) {
        texels += (double)width * height;
        width = width > 1 ? width / 2 : 1, height = height > 1 ? height / 2 : 1;
    }
    return 4.0 * channels * texels;
}

/* What a search reads beside colour and height, and how long that took to build. */
static void add_maps(const Shots *shots, Table *table) {
    const Field *field = shots->frame->data;
    const Maps *maps = &field->maps;
    int variant = shots->frame->technique->variant;
    if (variant != PYRAMID && variant != CONES) return;
    const Texture *own = variant == PYRAMID ? &maps->pyramid : &maps->cones;
    double bytes = texture_bytes(&maps->corners, 4) + texture_bytes(own, 1);
    table_add(table, shots, NULL, "bytes", bytes, "bytes");
    table_add(table, shots, NULL, "build_ms", variant == PYRAMID ? maps->pyramid_ms : maps->cones_ms, "ms");
}

void relief_measure(const Shots *shots, Table *table) {
    add_maps(shots, table);
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        HitErrors errors =
            hit_errors(&shot->picture.lookup, shot->centres, relief_texels(shots->frame->data));
        table_add(table, shots, shot->view, "wrong_hit_percent", errors.wrong_percent, "%");
        table_add(table, shots, shot->view, "hit_error_texels_p99", errors.p99, "texels");
    }
}
