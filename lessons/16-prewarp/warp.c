#include "warp.h"

#include "fail.h"

#include <stdlib.h>

/* ---- The source ---- */

static Texel texel_of(const float *colour, const float *normal) {
    Texel texel = {.colour = {0, 0, 0, 255}};
    for (int c = 0; c < 3; c++) {
        texel.colour[c] = srgb_byte(colour[c]);
        texel.normal[c] = (uint8_t)(127.5 + 127.5 * clamp(normal[c], -1, 1) + 0.5);
    }
    return texel;
}

static uint16_t level_of(float height) { return (uint16_t)(65535 * clamp(height, 0, 1) + 0.5); }

static void demand_size(const Image *image, int width, int height, int channels, const char *what) {
    if (image->width != width || image->height != height || image->channels != channels)
        fail("a relief texture's %s has %d channels of %d x %d, not %d of %d x %d", what, image->channels,
             image->width, image->height, channels, width, height);
}

Source source_create(const Image *colour, const Image *heights, const Image *normals, double scale,
                     double base) {
    int width = heights->width, height = heights->height;
    demand_size(heights, width, height, 1, "height");
    demand_size(colour, width, height, 3, "colour");
    demand_size(normals, width, height, 3, "normal");
    size_t count = (size_t)width * height;
    double aspect = (double)height / width;
    Source source = {
        width, height, scale,
        base,  aspect, .plane = {v3(-0.5, -0.5 * aspect, 0), v3(1, 0, 0), v3(0, aspect, 0), v3(0, 0, 1)}};
    source.levels = allocate(count, sizeof *source.levels);
    source.texels = allocate(count, sizeof *source.texels);
    for (size_t i = 0; i < count; i++) {
        source.levels[i] = level_of(heights->pixels[i]);
        source.texels[i] = texel_of(colour->pixels + 3 * i, normals->pixels + 3 * i);
    }
    return source;
}

void source_destroy(Source *source) {
    free(source->levels);
    free(source->texels);
    *source = (Source){0};
}

/* ---- The destination ---- */

Destination destination_create(int width, int height, Vec2 low, Vec2 high, bool lookup) {
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
        fail("a pre-warp's destination of %d x %d texels: 1 to %d a side", width, height, IMAGE_SIDE_MAX);
    size_t count = (size_t)width * height;
    Destination destination = {width, height, low, high, .texels = allocate(count, sizeof(Texel))};
    if (lookup) destination.lookup = allocate(count, 3 * sizeof(float));
    return destination;
}

void destination_destroy(Destination *destination) {
    free(destination->texels);
    free(destination->lookup);
    *destination = (Destination){0};
}
