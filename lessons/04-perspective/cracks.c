#include "cracks.h"

#include "fail.h"
#include "joints.h"
#include "table.h"

#include <stdlib.h>

typedef struct {
    Image image;
    int left, right; /* cells a side */
    bool round;      /* a cylinder, not a square */
} Surface;

/* ---- Loading ---- */

static void *load(const Options *options, int left, int right, bool round) {
    Surface *surface = allocate(1, sizeof *surface);
    *surface = (Surface){image_load(options->colour, IMAGE_COLOUR), left, right, round};
    return surface;
}

void *cracks_load_joints(const Options *options) { return load(options, JOINTS, false); }
void *cracks_load_levels(const Options *options) { return load(options, LEVELS, true); }

void cracks_unload(void *data) {
    Surface *surface = data;
    image_destroy(&surface->image);
    free(surface);
}

/* ---- Drawing ---- */

/* A surface as a camera sees it: the context of joint_create. */
typedef struct {
    const Surface *surface;
    const Camera *camera;
    int width, height;
} Seen;

static ClipVertex seen_point(const void *context, double s, double t) {
    const Seen *seen = context;
    if (!seen->surface->round)
        return clip_vertex(seen->camera, seen->width, seen->height, v3(s - 0.5, t - 0.5, 0), s, t);
    double angle = (t - 0.5) * radians(ARC_DEGREES); /* the joint lies across: s is the texture's t */
    Vec3 point = v3(sin(angle), s - 0.5, cos(angle));
    return clip_vertex(seen->camera, seen->width, seen->height, point, t, s);
}

static Joint joint_of(const Frame *frame, const Camera *camera) {
    const Surface *surface = frame->data;
    Seen seen = {surface, camera, frame->width, frame->height};
    return joint_create(surface->left, surface->right, frame->technique->variant == MENDED, seen_point,
                        &seen);
}

static int dropped_bits(const Frame *frame) {
    return frame->knob > 0 ? SUBPIXEL_BITS - (int)clamp(log2(frame->knob) + 0.5, 0, SUBPIXEL_BITS) : 0;
}

void cracks_paint(const Frame *frame, Picture *picture) {
    const Surface *surface = frame->data;
    double eye_y = tan(radians(frame->camera.fov_y_degrees) / 2),
           eye_x = eye_y * frame->width / frame->height;
    size_t pixels = (size_t)frame->width * frame->height;
    uint16_t *drawn = allocate(pixels, sizeof *drawn);
    Raster raster = {.width = frame->width,
                     .height = frame->height,
                     .texture = &surface->image,
                     .filling = FILL_PERSPECTIVE,
                     .dropped_bits = dropped_bits(frame),
                     .colour = &picture->colour,
                     .lookup = picture->lookup.pixels ? &picture->lookup : NULL,
                     .eye_x = eye_x,
                     .eye_y = eye_y,
                     .drawn = drawn};
    Joint joint = joint_of(frame, &frame->camera);
    joint_draw(&raster, &joint);
    joint_destroy(&joint);
    for (size_t i = 0; i < pixels; i++) {
        if (drawn[i] < 2) continue;
        float *pixel = picture->colour.pixels + 3 * i;
        pixel[0] = pixel[1] = 0, pixel[2] = 1;
    }
    free(drawn);
}

/* ---- The truth: the surface without cells ---- */

Sample cracks_truth(const void *data, Ray ray) {
    const Surface *surface = data;
    Sample sample = surface->round ? truth_cylinder(ray, 1, 1) : truth_plane(ray, 1, 1);
    if (surface->round && sample.hit) {
        sample.u = (sample.u - 0.5) * 360 / ARC_DEGREES + 0.5;
        if (sample.u < 0 || sample.u > 1) return (Sample){0};
    }
    if (sample.hit) sample.colour = truth_colour(&surface->image, sample.u, sample.v);
    return sample;
}

/* ---- Counting ---- */

enum { PATH_VIEWS = 40 };
static const double PATH_DEGREES = 0.5; /* from one to the next */

/* Counts them in the pictures, and over a path of cameras that turns around the first view's target. */
void cracks_measure(const Shots *shots, Table *table) {
    const Frame *frame = shots->frame;
    Cracks sum = {0};
    for (int i = 0; i < shots->count + PATH_VIEWS; i++) {
        bool picture = i < shots->count;
        Camera camera = shots->shots[picture ? i : 0].view->camera;
        if (!picture) camera_orbit(&camera, radians(PATH_DEGREES) * (i - shots->count - PATH_VIEWS / 2), 0);
        Joint joint = joint_of(frame, &camera);
        Cracks cracks = joint_cracks(&joint, frame->width, frame->height, dropped_bits(frame));
        joint_destroy(&joint);
        if (picture) {
            table_add(table, shots, shots->shots[i].view, "missed_pixels", cracks.missed, "pixels");
            table_add(table, shots, shots->shots[i].view, "doubled_pixels", cracks.doubled, "pixels");
        } else {
            sum.missed += cracks.missed;
            sum.doubled += cracks.doubled;
        }
    }
    table_row(table, "-", "missed_pixels", sum.missed, "pixels");
    table_row(table, "-", "doubled_pixels", sum.doubled, "pixels");
}
