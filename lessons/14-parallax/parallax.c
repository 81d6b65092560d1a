#include "parallax.h"

#include "fail.h"
#include "table.h"

#include <stdlib.h>
#include <string.h>

/* ---- Loading ---- */

static Parallax *load(const Options *options) {
    Parallax *parallax = allocate(1, sizeof *parallax);
    wall_load(&parallax->wall, options);
    return parallax;
}

void *parallax_load(const Options *options) { return load(options); }

void *parallax_load_bottom(const Options *options) {
    Parallax *parallax = load(options);
    parallax->wall.relief.base = 0.0;
    return parallax;
}

void parallax_unload(void *data) {
    Parallax *parallax = data;
    if (parallax->distortion.id) texture_destroy(&parallax->distortion);
    wall_unload(&parallax->wall);
    free(parallax);
}

/* ---- Drawing ---- */

Vec2 parallax_tangents(Vec3 view) {
    return view.z > 1e-6 * vec3_length(view) ? v2(view.x / view.z, view.y / view.z) : v2(0, 0);
}

/* The same for a camera's view of a point of the polygon. */
static Vec2 tangents_at(const Camera *camera, Vec3 point) {
    return parallax_tangents(vec3_sub(camera->eye, camera->fov_y_degrees > 0.0 ? point : camera->target));
}

Image parallax_distortion(const Relief *relief, const Camera *camera) {
    Image map = image_create(relief->height->width, relief->height->height, 2);
    for (int y = 0; y < map.height; y++) {
        for (int x = 0; x < map.width; x++) {
            Vec3 point = v3((x + 0.5) / map.width - 0.5, ((y + 0.5) / map.height - 0.5) * relief->aspect, 0);
            Vec2 tangents = tangents_at(camera, point);
            double d = relief->scale * (*image_at(relief->height, x, y) - relief->base);
            image_at(&map, x, y)[0] = (float)(d * tangents.x);                  /* u' - u */
            image_at(&map, x, y)[1] = (float)(d * tangents.y / relief->aspect); /* v' - v */
        }
    }
    return map;
}

void parallax_prepare_distortion(const Frame *frame) {
    Parallax *parallax = frame->data;
    Image map = parallax_distortion(&parallax->wall.relief, &frame->camera);
    if (parallax->distortion.id) texture_destroy(&parallax->distortion);
    parallax->distortion = texture_create(&map, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
    image_destroy(&map);
}

void parallax_draw(const Frame *frame) {
    const Parallax *parallax = frame->data;
    Vec2 tangents = tangents_at(&frame->camera, v3(0, 0, 0));
    wall_bind(&parallax->wall, frame->program);
    program_texture(frame->program, "distortion_map", &parallax->distortion);
    program_vector(frame->program, "tangents", tangents.x, tangents.y, 0, 0);
    program_number(frame->program, "nothing", 0.0);
    shape_draw(&parallax->wall.polygon);
}

/* ---- The lesson's own metrics ---- */

double parallax_steepness(const Relief *relief) {
    const Image *height = relief->height;
    double per_x = relief->scale * height->width, per_y = relief->scale * height->height / relief->aspect;
    double steepest = 0.0;
    for (int y = 0; y < height->height; y++) {
        for (int x = 0; x < height->width; x++) {
            int right = (x + 1) % height->width, above = (y + 1) % height->height;
            double h00 = *image_at(height, x, y), h10 = *image_at(height, right, y);
            double h01 = *image_at(height, x, above), h11 = *image_at(height, right, above);
            /* Within a patch dh/dx depends on y alone and dh/dy on x alone: the steepest is a corner. */
            double dx = fmax(fabs(h10 - h00), fabs(h11 - h01)) * per_x;
            double dy = fmax(fabs(h01 - h00), fabs(h11 - h10)) * per_y;
            steepest = fmax(steepest, hypot(dx, dy));
        }
    }
    return steepest;
}

/* A view whose rows run along the shift: orthographic and turned about y alone. */
static bool along_rows(const Camera *camera) {
    return camera->fov_y_degrees <= 0.0 && camera->eye.y == camera->target.y && camera->up.x == 0.0 &&
           camera->up.z == 0.0;
}

/* What one picture is measured by, over the pixels at which polygon, picture and truth are there and known.
 */
typedef struct {
    double count, squared_error, squared_step; /* of pixels; texels squared */
    double shift_texels, tangent;              /* the largest */
    double pairs, folds, exact_folds;          /* of neighbours in a row */
} Tally;

/* A pixel: the polygon's u, v there, and what was looked up and should have been. */
typedef struct {
    bool hit;
    double u, v;
    const float *lookup;
    const Sample *exact;
} Spot;

/* How far one more iteration would move a lookup: the relief's depth there, by the tangents of the pixel's
 * ray. */
static Vec2 next_step(const Wall *wall, const Spot *spot, Vec3 way) {
    const Relief *relief = &wall->relief;
    double h;
    image_sample(&wall->height_image, spot->lookup[0], spot->lookup[1], &h);
    double d = relief->scale * (h - relief->base);
    return v2(spot->u + d * way.x / way.z - spot->lookup[0],
              spot->v + d * way.y / way.z / relief->aspect - spot->lookup[1]);
}

static double squared_texels(Vec2 texels, double du, double dv) {
    return du * du * texels.x * texels.x + dv * dv * texels.y * texels.y;
}

static Spot tally_pixel(Tally *tally, const Shots *shots, const Shot *shot, int x, int y) {
    const Wall *wall = shots->frame->data;
    int width = shots->frame->width, height = shots->frame->height;
    Ray ray = camera_ray(&shot->view->camera, width, height, x + 0.5, y + 0.5);
    Sample polygon = truth_plane(ray, 1.0, wall->relief.aspect);
    Spot spot = {false, polygon.u, polygon.v, image_at(&shot->picture.lookup, x, y),
                 &shot->centres[(size_t)y * width + x]};
    spot.hit = polygon.hit && spot.lookup[3] > 0.5f && spot.exact->hit && !spot.exact->unknown;
    if (!spot.hit) return spot;
    Vec2 texels = wall_texels(wall), step = next_step(wall, &spot, ray.direction);
    tally->count++;
    tally->squared_error +=
        squared_texels(texels, spot.lookup[0] - spot.exact->u, spot.lookup[1] - spot.exact->v);
    tally->squared_step += squared_texels(texels, step.x, step.y);
    tally->shift_texels = fmax(
        tally->shift_texels, sqrt(squared_texels(texels, spot.lookup[0] - spot.u, spot.lookup[1] - spot.v)));
    tally->tangent = fmax(tally->tangent, hypot(ray.direction.x, ray.direction.y) / fabs(ray.direction.z));
    return spot;
}

/* A fold: two neighbours in a row whose u' runs against their polygon's u. Along the shift nothing that is
 * seen of a real relief does that. */
static Tally tally_picture(const Shots *shots, const Shot *shot) {
    Tally tally = {0};
    for (int y = 0; y < shots->frame->height; y++) {
        Spot before = {0};
        for (int x = 0; x < shots->frame->width; x++) {
            Spot spot = tally_pixel(&tally, shots, shot, x, y);
            if (spot.hit && before.hit) {
                double along = spot.u - before.u;
                tally.pairs++;
                tally.folds += ((double)spot.lookup[0] - before.lookup[0]) * along < 0.0;
                tally.exact_folds += (spot.exact->u - before.exact->u) * along < 0.0;
            }
            before = spot;
        }
    }
    return tally;
}

/* The error's way through the iterations: none is `plain`, one is `per-pixel`. */
static void add_iterations(const Shots *shots, const Shot *shot, double error, double step, Table *table) {
    const Frame *frame = shots->frame;
    const char *name = frame->technique->name;
    bool plain = !strcmp(name, "plain"), one = !strcmp(name, "per-pixel");
    if (!plain && !one && strcmp(name, "iterated")) return;
    double done = plain ? 0 : one ? 1 : frame->knob;
    table_set(table, frame->scene->name, "iterated", 0); /* one line through all of them */
    table_point(table, shots, shot->view, "iteration", "iterations", done, "rms uv error (texels)", error);
    table_point(table, shots, shot->view, "next-step", "iterations", done, "rms next step (texels)", step);
    table_set(table, frame->scene->name, name, frame->knob);
}

void parallax_measure(const Shots *shots, Table *table) {
    const Wall *wall = shots->frame->data;
    bool first = shots->frame->technique == shots->frame->scene->techniques; /* for what belongs to none */
    double steepness = first ? parallax_steepness(&wall->relief) : 0;
    if (first) table_add(table, shots, NULL, "steepness_max", steepness, "widths per width");
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        Tally tally = tally_picture(shots, shot);
        if (!tally.count) continue;
        double error = sqrt(tally.squared_error / tally.count), step = sqrt(tally.squared_step / tally.count);
        table_add(table, shots, shot->view, "shift_max_texels", tally.shift_texels, "texels");
        table_add(table, shots, shot->view, "next_step_texels_rms", step, "texels");
        if (first) table_add(table, shots, shot->view, "contraction_max", tally.tangent * steepness, "1");
        if (along_rows(&shot->view->camera) && tally.pairs) {
            table_add(table, shots, shot->view, "fold_percent", 100.0 * tally.folds / tally.pairs, "%");
            table_add(table, shots, shot->view, "fold_truth_percent", 100.0 * tally.exact_folds / tally.pairs,
                      "%");
        }
        add_iterations(shots, shot, error, step, table);
    }
}
