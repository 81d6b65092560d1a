#include "wall.h"

#include "fail.h"

static void require_heights(const Image *height, const char *path) {
    size_t count = (size_t)height->width * height->height;
    for (size_t i = 0; i < count; i++)
        if (height->pixels[i] < 0.0f || height->pixels[i] > 1.0f)
            fail("%s: a height must lie in 0..1, but one is %g", path, height->pixels[i]);
}

enum { BASE_MAX = 10 }; /* farther from its polygon, floats have no room for a relief */

static double base_of(const Image *height, const char *path) {
    double base = isnan(height->base) ? 1.0 : height->base;
    if (!(fabs(base) <= BASE_MAX))
        fail("%s: its base is %g; -%d to %d can be drawn", path, base, BASE_MAX, BASE_MAX);
    return base;
}

void wall_load(Wall *wall, const Options *options) {
    *wall = (Wall){.colour_image = image_load(options->colour, IMAGE_COLOUR),
                   .height_image = image_load(options->height, IMAGE_HEIGHT)};
    const Image *height = &wall->height_image;
    require_heights(height, options->height);
    if (options->other[0]) wall->mask = image_load(options->other[0], IMAGE_HEIGHT);
    wall->colour = texture_of(&wall->colour_image, IMAGE_COLOUR);
    wall->height = texture_of(height, IMAGE_HEIGHT);
    double aspect = (double)wall->colour_image.height / wall->colour_image.width;
    wall->relief = (Relief){.height = height,
                            .width = 1.0,
                            .aspect = aspect,
                            .scale = options_scale(options, height),
                            .base = base_of(height, options->height)};
    Mesh plane = mesh_plane(1.0, aspect, 1, 1);
    wall->polygon = shape_create(&plane);
    mesh_destroy(&plane);
}

void wall_unload(Wall *wall) {
    image_destroy(&wall->colour_image);
    image_destroy(&wall->height_image);
    if (wall->mask.pixels) image_destroy(&wall->mask);
    texture_destroy(&wall->colour);
    texture_destroy(&wall->height);
    shape_destroy(&wall->polygon);
}

void wall_bind(const Wall *wall, Program *program) {
    program_texture(program, "colour_map", &wall->colour);
    program_texture(program, "height_map", &wall->height);
    program_number(program, "scale", wall->relief.scale);
    program_number(program, "base", wall->relief.base);
    program_number(program, "aspect", wall->relief.aspect);
}

/* Whether one of the four texels that a bilinear read at (u, v) mixes is masked out. */
static bool unknown_at(const Wall *wall, double u, double v) {
    const Image *mask = &wall->mask;
    if (!mask->pixels || mask->width != wall->height_image.width || mask->height != wall->height_image.height)
        return false;
    double known;
    image_sample(mask, u, v, &known);
    return known < 1.0 - 1e-9;
}

Sample wall_truth(const void *data, Ray ray) {
    const Wall *wall = data;
    Sample sample = truth_relief(&wall->relief, ray);
    if (sample.hit) {
        sample.colour = truth_colour(&wall->colour_image, sample.u, sample.v);
        sample.unknown = unknown_at(wall, sample.u, sample.v);
    }
    return sample;
}

Vec2 wall_texels(const void *data) {
    const Wall *wall = data;
    return v2(wall->colour_image.width, wall->colour_image.height);
}
