#include "wall.h"

#include "fail.h"

#include <stdlib.h>

/* ---- Loading ---- */

static void require_heights(const Image *height, const char *path) {
    size_t count = (size_t)height->width * height->height;
    for (size_t i = 0; i < count; i++)
        if (height->pixels[i] < 0.0f || height->pixels[i] > 1.0f)
            fail("%s: a height must lie in 0..1, but one is %g", path, height->pixels[i]);
}

static Wall *load(const Options *options, double base) {
    Wall *wall = allocate(1, sizeof *wall);
    wall->colour_image = image_load(options->colour, IMAGE_COLOUR);
    wall->height_image = image_load(options->height, IMAGE_HEIGHT);
    require_heights(&wall->height_image, options->height);
    wall->colour = texture_of(&wall->colour_image, IMAGE_COLOUR);
    wall->height = texture_of(&wall->height_image, IMAGE_HEIGHT);
    double aspect = (double)wall->colour_image.height / wall->colour_image.width;
    wall->relief = (Relief){&wall->height_image, 1.0, aspect, options_scale(options, &wall->height_image),
                            isnan(base) ? 1.0 : base};
    Mesh plane = mesh_plane(1.0, aspect, 1, 1);
    wall->polygon = shape_create(&plane);
    mesh_destroy(&plane);
    return wall;
}

void *wall_load(const Options *options) {
    Wall *wall = load(options, 1.0);
    if (!isnan(wall->height_image.base)) wall->relief.base = wall->height_image.base;
    return wall;
}

void *wall_load_bottom(const Options *options) { return load(options, 0.0); }

void wall_unload(void *data) {
    Wall *wall = data;
    image_destroy(&wall->colour_image);
    image_destroy(&wall->height_image);
    texture_destroy(&wall->colour);
    texture_destroy(&wall->height);
    if (wall->distortion.id) texture_destroy(&wall->distortion);
    shape_destroy(&wall->polygon);
    free(wall);
}

/* ---- Drawing ---- */

/* The tangents of the view's angles from the normal at a point of the polygon, in doubles: the paper's tan
 * theta_u and tan theta_v. From behind, or within the plane, there is no such angle and no shift. */
static Vec2 tangents_at(const Camera *camera, Vec3 point) {
    Vec3 view = vec3_sub(camera->eye, camera->fov_y_degrees > 0.0 ? point : camera->target);
    return view.z > 0.0 ? v2(view.x / view.z, view.y / view.z) : v2(0, 0);
}

void wall_prepare_distortion(const Frame *frame) {
    Wall *wall = frame->data;
    const Relief *relief = &wall->relief;
    const Image *height = &wall->height_image;
    Image map = image_create(height->width, height->height, 2);
    for (int y = 0; y < map.height; y++) {
        for (int x = 0; x < map.width; x++) {
            Vec3 point = v3((x + 0.5) / map.width - 0.5, ((y + 0.5) / map.height - 0.5) * relief->aspect, 0);
            Vec2 tangents = tangents_at(&frame->camera, point);
            double d = relief->scale * (*image_at(height, x, y) - relief->base);
            image_at(&map, x, y)[0] = (float)(d * tangents.x);                  /* u' - u */
            image_at(&map, x, y)[1] = (float)(d * tangents.y / relief->aspect); /* v' - v */
        }
    }
    if (wall->distortion.id) texture_destroy(&wall->distortion);
    wall->distortion = texture_create(&map, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
    image_destroy(&map);
}

void wall_draw(const Frame *frame) {
    const Wall *wall = frame->data;
    Vec2 tangents = tangents_at(&frame->camera, v3(0, 0, 0));
    program_texture(frame->program, "colour_map", &wall->colour);
    program_texture(frame->program, "height_map", &wall->height);
    program_texture(frame->program, "distortion_map", &wall->distortion);
    program_vector(frame->program, "tangents", tangents.x, tangents.y, 0, 0);
    program_number(frame->program, "scale", wall->relief.scale);
    program_number(frame->program, "base", wall->relief.base);
    program_number(frame->program, "aspect", wall->relief.aspect);
    program_number(frame->program, "nothing", 0.0);
    shape_draw(&wall->polygon);
}

/* ---- The truth, and how far a picture is from it ---- */

Sample wall_truth(const void *data, Ray ray) {
    const Wall *wall = data;
    Sample sample = truth_relief(&wall->relief, ray);
    double rgb[3];
    if (sample.hit) {
        image_sample(&wall->colour_image, sample.u, sample.v, rgb);
        sample.colour = v3(rgb[0], rgb[1], rgb[2]);
    }
    return sample;
}

Vec2 wall_texels(const void *data) {
    const Wall *wall = data;
    return v2(wall->colour_image.width, wall->colour_image.height);
}

/* Swimming. A fold: two neighbours in a row whose u' runs against their polygon's u, which nothing that is
 * seen of a real relief does. The shift: how far a lookup is from the polygon's own coordinates. */
void wall_measure(const Shots *shots, Table *table) {
    const Wall *wall = shots->frame->data;
    Vec2 texels = wall_texels(wall);
    int width = shots->frame->width, height = shots->frame->height;
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        double folds = 0, exact_folds = 0, pairs = 0, shift = 0;
        for (int y = 0; y < height; y++) {
            Sample before = {0};
            for (int x = 0; x < width; x++) {
                Ray ray = camera_ray(&shot->view->camera, width, height, x + 0.5, y + 0.5);
                Sample polygon = truth_plane(ray, 1.0, wall->relief.aspect);
                const float *lookup = image_at(&shot->picture.lookup, x, y);
                const Sample *exact = &shot->centres[(size_t)y * width + x];
                polygon.hit = polygon.hit && lookup[3] > 0.5f && exact->hit;
                if (polygon.hit)
                    shift = fmax(
                        shift, hypot((lookup[0] - polygon.u) * texels.x, (lookup[1] - polygon.v) * texels.y));
                if (polygon.hit && before.hit) {
                    double along = polygon.u - before.u;
                    pairs++;
                    folds += ((double)lookup[0] - lookup[-4]) * along < 0.0;
                    exact_folds += (exact[0].u - exact[-1].u) * along < 0.0;
                }
                before = polygon;
            }
        }
        table_add(table, shots, shot->view, "fold_percent", 100.0 * folds / fmax(pairs, 1), "%");
        table_add(table, shots, shot->view, "fold_truth_percent", 100.0 * exact_folds / fmax(pairs, 1), "%");
        table_add(table, shots, shot->view, "shift_max_texels", shift, "texels");
    }
}
