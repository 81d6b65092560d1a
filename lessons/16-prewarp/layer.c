#include "layer.h"

#include "fail.h"

#include <stdlib.h>
#include <string.h>

/* Sixteen bits of normal are no more than the eight that were warped, but OSMesa filters eight with weights
 * of eight bits. Everything is weighed by alpha, so that a linear filter mixes no more of a texel than is
 * there.
 */
static void split(const Destination *destination, uint8_t (*colours)[4], uint16_t (*normals)[4]) {
    size_t count = (size_t)destination->width * destination->height;
    for (size_t i = 0; i < count; i++) {
        const Texel *texel = &destination->texels[i];
        unsigned alpha = texel->colour[3];
        memcpy(colours[i], texel->colour, 4);
        for (int c = 0; c < 3; c++) normals[i][c] = (uint16_t)(257u * texel->normal[c] * alpha / 255);
        normals[i][3] = (uint16_t)(257 * alpha);
        for (int c = 0; c < 3 && alpha < 255; c++)
            colours[i][c] = srgb_byte((float)(srgb_decode(texel->colour[c] / 255.0) * alpha / 255));
    }
}

static void demand_size(Layer *layer, int width, int height) {
    if (layer->colour.id && layer->colour.width == width && layer->colour.height == height) return;
    layer_destroy(layer);
    layer->colour = texture_empty(width, height, TEXTURE_SRGBA8, TEXTURE_LINEAR);
    layer->normal = texture_empty(width, height, TEXTURE_RGBA16, TEXTURE_LINEAR);
    layer->colours = allocate((size_t)width * height, sizeof *layer->colours);
    layer->normals = allocate((size_t)width * height, sizeof *layer->normals);
}

static void write_lookup(Layer *layer, const Destination *destination) {
    if (layer->lookup.id) texture_destroy(&layer->lookup);
    const Image lookup = {destination->width, destination->height, 3, .pixels = destination->lookup};
    layer->lookup = texture_create(&lookup, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
}

void layer_write(Layer *layer, const Destination *destination) {
    demand_size(layer, destination->width, destination->height);
    split(destination, layer->colours, layer->normals);
    texture_write(&layer->colour, TEXTURE_SRGBA8, layer->colours);
    texture_write(&layer->normal, TEXTURE_RGBA16, layer->normals);
    if (destination->lookup) write_lookup(layer, destination);
}

void layer_destroy(Layer *layer) {
    if (layer->colour.id) texture_destroy(&layer->colour);
    if (layer->normal.id) texture_destroy(&layer->normal);
    if (layer->lookup.id) texture_destroy(&layer->lookup);
    free(layer->colours);
    free(layer->normals);
    layer->colours = NULL, layer->normals = NULL;
}

void layer_lay(Layer *layer, const Plane *plane, Vec2 low, Vec2 high) {
    Vec3 a = vec3_scale(plane->a, high.x - low.x), b = vec3_scale(plane->b, high.y - low.y);
    Vec3 middle = vec3_add(plane->origin, vec3_add(vec3_scale(plane->a, (low.x + high.x) / 2),
                                                   vec3_scale(plane->b, (low.y + high.y) / 2)));
    const Vec3 columns[] = {a, b, plane->f, middle};
    for (int i = 0; i < 4; i++) {
        layer->model[4 * i + 0] = (float)columns[i].x;
        layer->model[4 * i + 1] = (float)columns[i].y;
        layer->model[4 * i + 2] = (float)columns[i].z;
        layer->model[4 * i + 3] = i == 3;
    }
}

void layer_bind(const Layer *layer, Program *program) {
    program->units = 0;
    program_texture(program, "colour_map", &layer->colour);
    program_texture(program, "normal_map", &layer->normal);
    if (layer->lookup.id) program_texture(program, "lookup_map", &layer->lookup);
    program_matrix(program, "model", layer->model, 4);
}
