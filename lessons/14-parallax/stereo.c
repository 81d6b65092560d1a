#include "stereo.h"

#include "fail.h"

#include <stdlib.h>
#include <string.h>

double stereo_find(const float *row, int width, double u, double v) {
    double found = -1.0, nearest = INFINITY;
    for (int x = 0; x + 1 < width; x++) {
        const float *a = row + 4 * x, *b = a + 4;
        if (a[3] < 0.5f || b[3] < 0.5f) continue;
        if (((double)a[0] - u) * ((double)b[0] - u) > 0.0) continue; /* u is not between them */
        double along = a[0] == b[0] ? 0.0 : (u - a[0]) / ((double)b[0] - a[0]);
        double distance = fabs(a[1] + along * ((double)b[1] - a[1]) - v);
        if (distance < nearest) {
            nearest = distance;
            found = x + 0.5 + along;
        }
    }
    return found;
}

static const Shot *shot_of(const Shots *shots, const char *name) {
    for (int i = 0; i < shots->count; i++)
        if (!strcmp(shots->shots[i].view->name, name)) return &shots->shots[i];
    return NULL;
}

/* Where the right eye sees the point that the left eye's ray meets, in pixels from the left edge; false where
 * another part of the relief hides it, or the picture ends. */
static bool seen_by_right(const Shots *shots, const Camera *right, Vec3 point, const Sample *exact,
                          double *x) {
    int width = shots->frame->width, height = shots->frame->height;
    Vec2 at = camera_project(right, width, height, point);
    Sample first = wall_truth(shots->frame->data, camera_ray(right, width, height, at.x, at.y));
    *x = at.x;
    return at.x >= 0.5 && at.x <= width - 0.5 && first.hit && fabs(first.u - exact->u) < 1e-6;
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* For each pixel of the left picture whose exact point both eyes see: how far to the left the right picture
 * shows what the left picture looked up there, against how far it shows that point. */
void stereo_measure(const Shots *shots, Table *table) {
    const Shot *left = shot_of(shots, "left"), *right = shot_of(shots, "right");
    if (!left || !right) return; /* one eye alone */
    int width = shots->frame->width, height = shots->frame->height;
    double *errors = allocate((size_t)width * height, sizeof *errors), sum = 0;
    int pixels = 0, matched = 0;
    for (int y = 0; y < height; y++) {
        const float *row = image_at(&right->picture.lookup, 0, y);
        for (int x = 0; x < width; x++) {
            const Sample *exact = &left->centres[(size_t)y * width + x];
            const float *lookup = image_at(&left->picture.lookup, x, y);
            if (!exact->hit || exact->unknown || lookup[3] < 0.5f) continue;
            Ray ray = camera_ray(&left->view->camera, width, height, x + 0.5, y + 0.5);
            double exact_x;
            if (!seen_by_right(shots, &right->view->camera, ray_at(ray, exact->depth), exact, &exact_x))
                continue;
            pixels++;
            double found_x = stereo_find(row, width, lookup[0], lookup[1]);
            if (found_x < 0.0) continue;
            double error = fabs(found_x - exact_x);
            errors[matched++] = error;
            sum += error * error;
        }
    }
    if (matched) {
        qsort(errors, (size_t)matched, sizeof *errors, by_size);
        table_add(table, shots, NULL, "disparity_error_pixels_rms", sqrt(sum / matched), "pixels");
        table_add(table, shots, NULL, "disparity_error_pixels_median", errors[matched / 2], "pixels");
    }
    if (pixels) table_add(table, shots, NULL, "matched_percent", 100.0 * matched / pixels, "%");
    free(errors);
}
