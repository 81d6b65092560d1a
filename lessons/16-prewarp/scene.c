#include "scene.h"

#include "fail.h"
#include "normals.h"

#include <stdlib.h>

static const double light_height = 0.7, turns_per_second = 0.1;

/* ---- Layers: what landed, for OpenGL ---- */

static uint16_t sixteen_bits(uint8_t eight) { return (uint16_t)(eight * 257); }

/* Writes texels into the layer's textures. A hole becomes 0 in all channels, so that a linear filter can tell
 * how much of what it mixes is there. */
static void layer_write(Layer *layer, int width, int height, const Texel *texels) {
    if (!layer->colour.id || layer->colour.width != width || layer->colour.height != height) {
        if (layer->colour.id) texture_destroy(&layer->colour), texture_destroy(&layer->normal);
        layer->colour = texture_empty(width, height, TEXTURE_SRGBA8, TEXTURE_LINEAR);
        layer->normal = texture_empty(width, height, TEXTURE_RGBA16, TEXTURE_LINEAR);
    }
    size_t count = (size_t)width * height;
    uint8_t(*colours)[4] = allocate(count, sizeof *colours);
    uint16_t(*normals)[4] = allocate(count, sizeof *normals);
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3 && texels[i].colour[3]; k++) {
            colours[i][k] = texels[i].colour[k];
            normals[i][k] = sixteen_bits(texels[i].normal[k]);
        }
        colours[i][3] = texels[i].colour[3];
        normals[i][3] = sixteen_bits(texels[i].colour[3]);
    }
    texture_write(&layer->colour, TEXTURE_SRGBA8, colours);
    texture_write(&layer->normal, TEXTURE_RGBA16, normals);
    free(colours);
    free(normals);
}

/* And where each texel came from. */
static void layer_write_lookup(Layer *layer, Image *lookup) {
    if (layer->lookup.id) texture_destroy(&layer->lookup);
    layer->lookup = texture_create(lookup, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
}

static void layer_destroy(Layer *layer) {
    if (layer->colour.id) texture_destroy(&layer->colour), texture_destroy(&layer->normal);
    if (layer->lookup.id) texture_destroy(&layer->lookup);
}

/* ---- Loading ---- */

/* The texels as they lie: where plain's come from. */
static void write_plain(Prewarp *prewarp) {
    const Image *colour = &prewarp->wall.colour_image;
    int width = colour->width, height = colour->height;
    Texel *texels = allocate((size_t)width * height, sizeof *texels);
    Image lookup = image_create(width, height, 3);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            Texel *texel = &texels[(size_t)y * width + x];
            float *from = image_at(&lookup, x, y);
            for (int k = 0; k < 3; k++) {
                texel->colour[k] = srgb_byte(image_at(colour, x, y)[k]);
                texel->normal[k] = (uint8_t)lround(127.5 + 127.5 * image_at(&prewarp->normals, x, y)[k]);
            }
            texel->colour[3] = 255;
            from[0] = (float)((x + 0.5) / width), from[1] = (float)((y + 0.5) / height);
            from[2] = (float)prewarp->wall.relief.base;
        }
    layer_write(&prewarp->plain, width, height, texels);
    layer_write_lookup(&prewarp->plain, &lookup);
    free(texels);
    image_destroy(&lookup);
}

/* A rectangle in the polygon's plane, from (u, v) = low to high. */
static void lay_flat(float model[16], Vec2 low, Vec2 high, double aspect) {
    const float matrix[16] = {[0] = (float)(high.x - low.x),
                              [5] = (float)((high.y - low.y) * aspect),
                              [10] = 1,
                              [12] = (float)((low.x + high.x) / 2 - 0.5),
                              [13] = (float)(((low.y + high.y) / 2 - 0.5) * aspect),
                              [15] = 1};
    for (int i = 0; i < 16; i++) model[i] = matrix[i];
}

static Prewarp *load(const Options *options) {
    Prewarp *prewarp = allocate(1, sizeof *prewarp);
    wall_load(&prewarp->wall, options);
    Relief *relief = &prewarp->wall.relief;
    relief->extent = RELIEF_CUT;
    prewarp->normals = height_normals(&prewarp->wall.height_image, relief->scale, relief->aspect);
    prewarp->light_angle = radians(120);
    prewarp->ambient = 0.3;
    Mesh square = mesh_plane(1, 1, 1, 1);
    prewarp->square = shape_create(&square);
    mesh_destroy(&square);
    write_plain(prewarp);
    lay_flat(prewarp->plain.model, v2(0, 0), v2(1, 1), relief->aspect);
    return prewarp;
}

void *scene_load(const Options *options) { return load(options); }

void *scene_load_bottom(const Options *options) {
    Prewarp *prewarp = load(options);
    prewarp->wall.relief.base = 0.0;
    return prewarp;
}

void scene_unload(void *data) {
    Prewarp *prewarp = data;
    layer_destroy(&prewarp->plain);
    for (int i = 0; i < LAYERS_MAX; i++) layer_destroy(&prewarp->layers[i]);
    image_destroy(&prewarp->normals);
    shape_destroy(&prewarp->square);
    wall_unload(&prewarp->wall);
    free(prewarp);
}

/* ---- Drawing ---- */

Vec3 scene_light(const Prewarp *prewarp) {
    return vec3_normalize(v3(cos(prewarp->light_angle), sin(prewarp->light_angle), light_height));
}

void scene_move(void *data, double seconds) {
    ((Prewarp *)data)->light_angle = radians(120) + 2 * PI * turns_per_second * seconds;
}

static void draw_layer(const Frame *frame, const Layer *layer) {
    Program *program = frame->program;
    program->units = 0;
    program_texture(program, "colour_map", &layer->colour);
    program_texture(program, "normal_map", &layer->normal);
    if (frame->looking) program_texture(program, "lookup_map", &layer->lookup);
    program_matrix(program, "model", layer->model, 4);
    shape_draw(&((Prewarp *)frame->data)->square);
}

void scene_draw(const Frame *frame) {
    const Prewarp *prewarp = frame->data;
    const Program *program = frame->program;
    const Relief *relief = &prewarp->wall.relief;
    Vec3 light = scene_light(prewarp);
    Vec2 texels = wall_texels(prewarp);
    program_vector(program, "light", light.x, light.y, light.z, prewarp->ambient);
    program_vector(program, "near", 4 / texels.x, 4 / texels.y, 0, 0);
    program_number(program, "scale", relief->scale);
    program_number(program, "base", relief->base);
    program_number(program, "aspect", relief->aspect);
    program_integer(program, "looking", frame->looking);
    if (!frame->technique->prepare) draw_layer(frame, &prewarp->plain);
    for (int i = 0; frame->technique->prepare && i < prewarp->layer_count; i++)
        draw_layer(frame, &prewarp->layers[i]);
}

/* ---- The truth ---- */

Sample scene_truth(const void *data, Ray ray) {
    const Prewarp *prewarp = data;
    Sample sample = wall_truth(&prewarp->wall, ray);
    if (!sample.hit) return sample;
    Vec3 normal = vec3_normalize(truth_colour(&prewarp->normals, sample.u, sample.v));
    double lit = fmax(vec3_dot(normal, scene_light(prewarp)), 0.0);
    sample.colour = vec3_scale(sample.colour, prewarp->ambient + (1.0 - prewarp->ambient) * lit);
    return sample;
}
