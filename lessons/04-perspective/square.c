#include "square.h"

#include "fail.h"
#include "raster.h"
#include "table.h"

#include <stdlib.h>
#include <string.h>

/* ---- Loading ---- */

static void *load(const Options *options, double side, double repeats, double first) {
    Square *square = allocate(1, sizeof *square);
    *square = (Square){side, repeats, first, image_load(options->colour, IMAGE_COLOUR), {0}, {0}};
    square->texture = texture_of(&square->image, IMAGE_COLOUR);
    Mesh mesh = mesh_plane(side, side, 1, 1);
    for (int i = 0; i < mesh.vertex_count; i++) /* not in the shader, which would round once more */
        for (int k = 0; k < 2; k++)
            mesh.vertices[i].uv[k] = (float)(first + repeats * mesh.vertices[i].uv[k]);
    square->shape = shape_create(&mesh);
    mesh_destroy(&mesh);
    return square;
}

void *square_load_quad(const Options *options) { return load(options, QUAD); }
void *square_load_floor(const Options *options) { return load(options, FLOOR); }
void *square_load_horizon(const Options *options) { return load(options, HORIZON); }

void square_unload(void *data) {
    Square *square = data;
    image_destroy(&square->image);
    texture_destroy(&square->texture);
    shape_destroy(&square->shape);
    free(square);
}

/* ---- Drawing ---- */

void square_draw(const Frame *frame) {
    const Square *square = frame->data;
    program_texture(frame->program, "image", &square->texture);
    shape_draw(&square->shape);
}

/* Draws it from a camera. raster: the outputs, and every. */
static void rasterize(const Frame *frame, const Camera *camera, Raster raster) {
    const Square *square = frame->data;
    raster.width = frame->width, raster.height = frame->height;
    raster.texture = &square->image;
    raster.filling = (Filling)frame->technique->variant;
    raster.eye_y = tan(radians(camera->fov_y_degrees) / 2); /* 0 for an orthographic camera */
    raster.eye_x = raster.eye_y * frame->width / frame->height;
    ClipVertex corner[4];
    for (int i = 0; i < 4; i++) {
        double u = i == 1 || i == 2, v = i >= 2; /* 0 or 1 */
        Vec3 point = v3((u - 0.5) * square->side, (v - 0.5) * square->side, 0);
        corner[i] = clip_vertex(camera, frame->width, frame->height, point,
                                square->first + square->repeats * u, square->first + square->repeats * v);
    }
    if (raster.filling == FILL_COLOUR || raster.filling == FILL_AFFINE)
        raster_parallelogram(&raster, corner, frame->knob > 1 ? (int)fmin(frame->knob, SPLITS_MAX) : 1);
    else
        raster_polygon(&raster, corner, 4);
}

static int knob_every(double knob) { return (int)clamp(knob, 1, IMAGE_SIDE_MAX); }

void square_paint(const Frame *frame, Picture *picture) {
    Raster raster = {.colour = &picture->colour, .every = knob_every(frame->knob)};
    if (picture->lookup.pixels) raster.lookup = &picture->lookup;
    rasterize(frame, &frame->camera, raster);
}

/* ---- The truth ---- */

Sample square_truth(const void *data, Ray ray) {
    const Square *square = data;
    Sample sample = truth_plane(ray, square->side, square->side);
    if (sample.hit) {
        sample.u = square->first + square->repeats * sample.u;
        sample.v = square->first + square->repeats * sample.v;
        sample.colour = truth_colour(&square->image, sample.u, sample.v);
    }
    return sample;
}

Vec2 square_texels(const void *data) {
    const Square *square = data;
    return v2(square->image.width, square->image.height);
}

/* ---- The lesson's own metrics ---- */

/* Over the pixels whose centre both the picture and the truth hit: the snapped shape reaches a little beyond
 * the true one, and no bound is promised there. In texels. */
typedef struct {
    double error, bound, ratio; /* the largest error, bound, and error over bound */
    double largest, off;        /* the largest |s| or |t|, and the largest error of s or t, in repeats */
} Worst;

static void worst_add(Worst *worst, Vec2 texels, const float *lookup, const Sample *exact, double bound) {
    if (!exact->hit || lookup[3] <= 0.5f) return;
    double ds = fabs(lookup[0] - exact->u), dt = fabs(lookup[1] - exact->v);
    double error = hypot(ds * texels.x, dt * texels.y);
    worst->error = fmax(worst->error, error);
    worst->bound = fmax(worst->bound, bound);
    if (bound > 0) worst->ratio = fmax(worst->ratio, error / bound);
    worst->largest = fmax(worst->largest, fmax(fabs(exact->u), fabs(exact->v)));
    worst->off = fmax(worst->off, fmax(ds, dt));
}

/* rows: where not NULL, the same for each row of the picture. */
static Worst compare_lookup(const Frame *frame, const Shot *shot, const Image *lookup, const float *bound,
                            Worst *rows) {
    Worst all = {0};
    Vec2 texels = square_texels(frame->data);
    for (int y = 0; y < frame->height; y++)
        for (int x = 0; x < frame->width; x++) {
            size_t i = (size_t)y * frame->width + x;
            Worst *const into[] = {&all, rows ? &rows[y] : &all};
            for (int k = 0; k < (rows ? 2 : 1); k++)
                worst_add(into[k], texels, lookup->pixels + 4 * i, &shot->centres[i], bound[i]);
        }
    return all;
}

static const char *const pixels_axis = "pixels from one exact place to the next", *const row_axis = "row",
                         *const error_axis = "largest error (texels)";

/* The largest error, and its bound, against n; a line a view. */
static void measure_every(const Shots *shots, Table *table, const Shot *shot, float *bound, Image *lookup) {
    const Frame *frame = shots->frame;
    table_set(table, frame->scene->name, frame->technique->name, 0); /* one line through all n */
    size_t pixels = (size_t)frame->width * frame->height;
    for (int every = 2; every <= 128; every *= 2) {
        memset(lookup->pixels, 0, 4 * pixels * sizeof *lookup->pixels);
        rasterize(frame, &shot->view->camera, (Raster){.every = every, .bound = bound, .lookup = lookup});
        Worst worst = compare_lookup(frame, shot, lookup, bound, NULL);
        table_point(table, shots, shot->view, "span-error", pixels_axis, every, error_axis, worst.error);
        table_point(table, shots, shot->view, "span-error-bound", pixels_axis, every, error_axis,
                    worst.bound);
    }
    table_set(table, frame->scene->name, frame->technique->name, frame->knob);
}

/* The same in each span; a convex polygon has one a row. */
static void plot_rows(const Shots *shots, Table *table, const Shot *shot, const Worst *rows) {
    int step = shots->frame->height / 120 + 1;
    for (int y = 0; y < shots->frame->height; y += step) {
        if (rows[y].bound == 0) continue;
        table_point(table, shots, shot->view, "row-error", row_axis, y, error_axis, rows[y].error);
        table_point(table, shots, shot->view, "row-error-bound", row_axis, y, error_axis, rows[y].bound);
    }
}

void square_measure(const Shots *shots, Table *table) {
    const Frame *frame = shots->frame;
    const Technique *technique = frame->technique;
    bool spans = technique->variant == FILL_SPANS;
    if (technique->paint && technique->variant < FILL_SPANS) return; /* these promise nothing */
    size_t pixels = (size_t)frame->width * frame->height;
    float *bound = allocate(pixels, sizeof *bound);
    Worst *rows = allocate((size_t)frame->height, sizeof *rows);
    Picture scratch = picture_create(frame->width, frame->height, true);
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        memset(bound, 0, pixels * sizeof *bound);
        memset(rows, 0, (size_t)frame->height * sizeof *rows);
        if (technique->paint)
            rasterize(frame, &shot->view->camera, (Raster){.every = knob_every(frame->knob), .bound = bound});
        Worst worst = compare_lookup(frame, shot, &shot->picture.lookup, bound, rows);
        if (technique->paint) {
            table_add(table, shots, shot->view, "uv_error_bound_texels", worst.bound, "texels");
            table_add(table, shots, shot->view, "uv_error_over_bound", worst.ratio, "1");
        }
        if (!spans) {
            double ulp = nextafterf((float)worst.largest, INFINITY) - (float)worst.largest;
            table_add(table, shots, shot->view, "uv_error_ulp_max", worst.off / ulp, "ulp");
            table_add(table, shots, shot->view, "st_largest", worst.largest, "repeats");
            continue;
        }
        plot_rows(shots, table, shot, rows);
        if (frame->knob == technique->knob.values[0] && technique->knob.values[1] > 0) /* where n matters */
            measure_every(shots, table, shot, bound, &scratch.lookup);
    }
    picture_destroy(&scratch);
    free(rows);
    free(bound);
}
