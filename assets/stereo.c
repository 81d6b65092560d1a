/* stereo DIR: makes a relief of a photographed scene from its measured stereo disparity.
 *
 * Reads DIR/motorcycle_left.png and DIR/motorcycle_disp.npy; writes DIR/stereo-colour.png, the height map
 * DIR/stereo-height.exr, both in one as the relief texture DIR/stereo-relief.exr with lengths in millimetres,
 * and DIR/stereo-mask.png, which is 1 where the height was measured and 0 where it was not and was filled in.
 *
 * A pixel with disparity s saw a point at depth z = baseline f / (s + shift) (Scharstein et al. 2014). The
 * relief is the photo as a plane, with each texel pressed in by its depth behind the nearest point, at the
 * scale that the plane has there: width / f times z_near millimetres a picture's width. It is orthographic,
 * while the camera saw in perspective: what lies behind is drawn smaller than it was. And it is FLATTEN times
 * flatter than the scene, as a medal is: at full depth it would be deeper than it is wide. */
#include "fail.h"
#include "image.h"
#include "vec.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The camera's calibration, for the pictures as scikit-image carries them, a quarter of the originals. */
static const double focal_pixels = 994.978, shift_pixels = 31.086, baseline_mm = 193.001;

enum { SHRINK = 2, FLATTEN = 16 }; /* a texel is SHRINK by SHRINK pixels */

/* ---- Reading NumPy's .npy ---- */

typedef struct {
    int width, height;
    float *values; /* the top row first; +infinity where the disparity is unknown */
} Disparity;

/* The whole file; *size is its length. The caller frees it. */
static unsigned char *read_whole(const char *path, size_t *size) {
    enum { LIMIT = 1 << 28 }; /* far above any picture of ours */
    FILE *file = fopen(path, "rb");
    if (!file) fail("%s: %s", path, strerror(errno));
    if (fseek(file, 0, SEEK_END)) fail("%s: %s", path, strerror(errno));
    long end = ftell(file);
    if (end < 0 || end > LIMIT) fail("%s: not a file of 0 to %d bytes", path, LIMIT);
    rewind(file);
    unsigned char *bytes = allocate((size_t)end, 1);
    *size = fread(bytes, 1, (size_t)end, file);
    if (*size != (size_t)end) fail("%s: cannot be read whole", path);
    fclose(file);
    return bytes;
}

/* The text that follows 'key': in a .npy header, which is a Python dictionary; "" when there is none. */
static const char *after_key(const char *header, const char *key) {
    const char *found = strstr(header, key);
    if (!found) return "";
    found += strlen(key);
    return found + strspn(found, " ");
}

/* Reads a .npy of version 1: the magic bytes, the header's length in 2 bytes, the header, the numbers. Only
 * what we need is accepted: little-endian float32, row after row, in two dimensions, nothing missing. */
static Disparity read_npy(const char *path) {
    size_t size;
    unsigned char *bytes = read_whole(path, &size);
    if (size < 10 || memcmp(bytes, "\x93NUMPY\x01\x00", 8)) fail("%s: not a .npy file of version 1.0", path);
    size_t start = 10 + bytes[8] + 256 * (size_t)bytes[9];
    if (start > size) fail("%s: truncated in its header", path);
    char *header = text("%.*s", (int)(start - 10), (const char *)bytes + 10);

    Disparity d = {0};
    const char *type = after_key(header, "'descr':"), *shape = after_key(header, "'shape':");
    if (strncmp(type, "'<f4'", 5)) fail("%s: its numbers are not little-endian float32", path);
    if (strncmp(after_key(header, "'fortran_order':"), "False", 5)) fail("%s: not stored row by row", path);
    char bracket = 0; /* five digits at most, so nothing overflows */
    if (sscanf(shape, "(%5d ,%5d %c", &d.height, &d.width, &bracket) != 3 || bracket != ')')
        fail("%s: its shape is not (height, width)", path);
    if (d.width < SHRINK || d.height < SHRINK || d.width > IMAGE_SIDE_MAX || d.height > IMAGE_SIDE_MAX)
        fail("%s: %d x %d numbers: a side must be %d to %d", path, d.width, d.height, SHRINK, IMAGE_SIDE_MAX);
    size_t count = (size_t)d.width * (size_t)d.height;
    if (size - start != 4 * count)
        fail("%s: %zu bytes of numbers where its shape needs %zu", path, size - start, 4 * count);

    d.values = allocate(count, sizeof(float));
    for (size_t i = 0; i < count; i++) {
        const unsigned char *b = bytes + start + 4 * i;
        uint32_t bits = b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
        memcpy(&d.values[i], &bits, sizeof bits);
        if (!(d.values[i] + shift_pixels > 0)) /* and NaN is not */
            fail("%s: the disparity in column %zu, row %zu is no point in front of the camera", path,
                 i % (size_t)d.width, i / (size_t)d.width);
    }
    free(header);
    free(bytes);
    return d;
}

/* ---- From disparity to height ---- */

static int descending(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x < y) - (x > y);
}

/* The disparity of the texel in column x, row y (from the bottom); +infinity unless all its pixels have one.
 * It is the second largest of the four, so one of them: a mean would invent depths between an object and
 * what is behind it. */
static double texel_disparity(const Disparity *d, int x, int y, int height) {
    float four[SHRINK * SHRINK];
    for (int i = 0; i < SHRINK * SHRINK; i++) {
        size_t row = (size_t)(SHRINK * (height - 1 - y) + i / SHRINK),
               column = (size_t)(SHRINK * x + i % SHRINK);
        four[i] = d->values[row * (size_t)d->width + column];
        if (isinf(four[i])) return INFINITY;
    }
    qsort(four, SHRINK * SHRINK, sizeof *four, descending);
    return four[1];
}

/* Fills the texels whose mask is 0: each becomes the mean of its neighbours inside the picture, over and over
 * until none moves by a millionth. So the relief is as smooth there as its rim allows and never leaves the
 * rim's range.
 */
static void fill(Image *heights, const Image *mask) {
    enum { SWEEPS_MAX = 100000 };
    static const int to_x[] = {1, -1, 0, 0}, to_y[] = {0, 0, 1, -1};
    for (int sweep = 0; sweep < SWEEPS_MAX; sweep++) {
        double moved = 0;
        for (int y = 0; y < heights->height; y++)
            for (int x = 0; x < heights->width; x++) {
                if (*image_at(mask, x, y) > 0) continue;
                double sum = 0;
                int count = 0;
                for (int i = 0; i < 4; i++) {
                    int nx = x + to_x[i], ny = y + to_y[i];
                    if (nx < 0 || ny < 0 || nx >= heights->width || ny >= heights->height) continue;
                    sum += *image_at(heights, nx, ny);
                    count++;
                }
                float *h = image_at(heights, x, y), old = *h;
                *h = count ? (float)(sum / count) : old; /* none: a picture of one texel */
                moved = fmax(moved, fabs((double)*h - old));
            }
        if (moved < 1e-6) return;
    }
}

/* The photo shrunk: the mean of linear light over each texel's pixels. Both have row 0 at the bottom, so an
 * odd row too many is dropped from the file's bottom, which is our first. */
static Image shrink(const Image *photo, int width, int height) {
    Image small = image_create(width, height, 3);
    int spare = photo->height - SHRINK * height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                double sum = 0;
                for (int i = 0; i < SHRINK * SHRINK; i++)
                    sum += image_at(photo, SHRINK * x + i % SHRINK, spare + SHRINK * y + i / SHRINK)[c];
                image_at(&small, x, y)[c] = (float)(sum / (SHRINK * SHRINK));
            }
    return small;
}

/* ---- Files ---- */

/* Ends the program if reason, of reading or writing FOLDER/NAME, is not NULL. */
static void check(const char *reason, const char *folder, const char *name) {
    if (reason) fail("%s/%s: %s", folder, name, reason);
}

static void write_raw(const Image *image, const char *folder, const char *name, int bits) {
    char *path = text("%s/%s", folder, name);
    check(image_write_raw(image, path, bits), folder, name);
    free(path);
}

int main(int count, char **arguments) {
    if (count != 2 || arguments[1][0] == '-') fail_usage("usage: stereo DIR");
    const char *folder = arguments[1];
    char *npy = text("%s/motorcycle_disp.npy", folder), *left = text("%s/motorcycle_left.png", folder);
    Disparity disparity = read_npy(npy);
    Image photo = image_load(left, IMAGE_COLOUR);
    if (photo.width != disparity.width || photo.height != disparity.height)
        fail("%s: %d x %d pixels, but %d x %d disparities", left, photo.width, photo.height, disparity.width,
             disparity.height);

    /* Depths first, for the range of heights is that of the depths. */
    int width = photo.width / SHRINK, height = photo.height / SHRINK;
    Image heights = image_create(width, height, 1), mask = image_create(width, height, 1);
    double near = INFINITY, far = 0;
    int known = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double s = texel_disparity(&disparity, x, y, height);
            if (isinf(s)) continue;
            double z = baseline_mm * focal_pixels / (s + shift_pixels);
            *image_at(&heights, x, y) = (float)z;
            *image_at(&mask, x, y) = 1;
            near = fmin(near, z), far = fmax(far, z);
            known++;
        }
    if (!known) fail("%s: every disparity is unknown", npy);
    if (!(near < far)) fail("%s: every disparity is the same: no relief", npy);

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float *h = image_at(&heights, x, y);
            *h = *image_at(&mask, x, y) > 0 ? (float)clamp((far - *h) / (far - near), 0, 1) : 0.5f;
        }
    fill(&heights, &mask);
    double plane_mm = SHRINK * width * near / focal_pixels; /* what the picture's width spans at `near` */
    heights.scale = (far - near) / plane_mm / FLATTEN;
    heights.base = 1;
    double tall_mm = plane_mm * height / width; /* the camera is at the origin and looks along -z */
    heights.basis = (Basis){.origin = v3(-plane_mm / 2, -tall_mm / 2, -near),
                            .a = v3(plane_mm, 0, 0),
                            .b = v3(0, tall_mm, 0),
                            .f = v3(0, 0, 1.0 / FLATTEN),
                            .unit = "mm"};

    Image colour = shrink(&photo, width, height);
    char *path = text("%s/stereo-colour.png", folder);
    check(image_write(&colour, path), folder, "stereo-colour.png");
    free(path);
    path = text("%s/stereo-relief.exr", folder);
    check(image_write_relief(&colour, &heights, path, 32), folder, "stereo-relief.exr");
    free(path);
    write_raw(&heights, folder, "stereo-height.exr", 32);
    write_raw(&mask, folder, "stereo-mask.png", 8);

    printf("stereo: %d x %d texels, %.2f %% of them unknown\n", width, height,
           100 - 100.0 * known / width / height);
    printf("  depth %.0f to %.0f mm; the picture spans %.0f mm at the nearest\n", near, far, plane_mm);
    printf("  scale %.5f of a width, 1/%d of the true one; base 1\n", heights.scale, FLATTEN);
    printf("  the camera's eyes: %.4f widths in front of the plane, %.4f apart\n", near / plane_mm,
           baseline_mm / plane_mm);
    image_destroy(&heights), image_destroy(&mask), image_destroy(&colour), image_destroy(&photo);
    free(disparity.values), free(npy), free(left);
    return 0;
}
