/* Images in memory: making them, sampling them, and the sRGB transfer function. Their files are image.cpp's.
 */
#include "image_files.h"

#include "fail.h"

#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>

/* ---- Memory ---------------------------------------------------------------------------------------- */

Image image_create(int width, int height, int channels) {
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
        fail("an image of %dx%d pixels: a side must be 1 to %d", width, height, IMAGE_SIDE_MAX);
    if (channels < 1 || channels > 4) fail("an image of %d channels: there must be 1 to 4", channels);
    float *pixels = allocate((size_t)width * height, channels * sizeof(float));
    return (Image){width,        height,      channels,         .bits = 32,
                   .scale = NAN, .base = NAN, .basis.a.x = NAN, .pixels = pixels};
}

void image_destroy(Image *image) {
    free(image->pixels);
    *image = (Image){0};
}

/* ---- The sRGB transfer function -------------------------------------------------------------------- */

double srgb_encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

double srgb_decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* Encoding to bytes without pow: where each code begins in linear light, and for each of 4096 stretches of
 * 0..1 the code at its start. A stretch holds at most one beginning, for the curve is nowhere steeper than
 * 12.92 x 255 / 4096 = 0.8 codes a stretch. */
enum { STRETCHES = 4096 };
static float begins[257];
static unsigned char first[STRETCHES + 1];

static void make_byte_encoder(void) {
    begins[0] = -INFINITY;
    begins[256] = INFINITY;
    for (int code = 1; code < 256; code++) begins[code] = (float)srgb_decode((code - 0.5) / 255);
    for (int i = 0, code = 0; i <= STRETCHES; i++) {
        while (begins[code + 1] <= (float)i / STRETCHES) code++;
        first[i] = (unsigned char)code;
    }
}

unsigned char srgb_byte(float linear) {
    static pthread_once_t made = PTHREAD_ONCE_INIT;
    pthread_once(&made, make_byte_encoder);
    if (!(linear > 0)) return 0; /* so is NaN, which an 8-bit file cannot hold */
    if (linear >= 1) return 255;
    int code = first[(int)(linear * STRETCHES)];
    return (unsigned char)(code + (linear >= begins[code + 1]));
}

/* ---- Sampling -------------------------------------------------------------------------------------- */

/* The two texels around the coordinate u of a repeated row of `size`, and the way from one to the other. */
typedef struct {
    int low, high;
    double way;
} Neighbours;

/* (Without floor where it can be: it is a call, and the truth comes here for every ray.) */
static Neighbours neighbours(double u, int size) {
    if (!(u >= 0.0 && u < 1.0)) u -= floor(u); /* wrapped first, so that a large u still fits an int */
    double x = u * size - 0.5;
    int low = x < 0.0 ? -1 : (int)x;
    return (Neighbours){low < 0 ? size - 1 : low, low + 1 < size ? low + 1 : 0, x - low};
}

void image_sample(const Image *image, double u, double v, double *out) {
    Neighbours x = neighbours(u, image->width), y = neighbours(v, image->height);
    const float *a = image_at(image, x.low, y.low), *b = image_at(image, x.high, y.low);
    const float *c = image_at(image, x.low, y.high), *d = image_at(image, x.high, y.high);
    for (int i = 0; i < image->channels; i++) {
        double bottom = a[i] + ((double)b[i] - a[i]) * x.way, top = c[i] + ((double)d[i] - c[i]) * x.way;
        out[i] = bottom + (top - bottom) * y.way;
    }
}

/* ---- Files ---- */

static const ImageFiles *files;

static void load_files(void) {
    void *library = dlopen("libtexel-files.so", RTLD_LAZY); /* found beside libtexel.so */
    if (library) files = dlsym(library, "image_files");
    if (!files) fail("%s", dlerror());
}

static const ImageFiles *files_loaded(void) {
    static pthread_once_t loaded = PTHREAD_ONCE_INIT;
    pthread_once(&loaded, load_files);
    return files;
}

const char *image_read(Image *image, const char *path, ImageKind kind) {
    return files_loaded()->read(image, path, kind);
}

const char *image_write(const Image *image, const char *path) { return files_loaded()->write(image, path); }

const char *image_write_raw(const Image *image, const char *path, int bits) {
    return files_loaded()->write_raw(image, path, bits);
}

const char *image_write_relief(const Image *colour, const Image *height, const char *path, int bits) {
    return files_loaded()->write_relief(colour, height, path, bits);
}

Image image_load(const char *path, ImageKind kind) {
    Image image;
    const char *refused = image_read(&image, path, kind);
    if (refused) fail("%s: %s", path, refused);
    return image;
}

void image_save(const Image *image, const char *path) {
    const char *refused = image_write(image, path);
    if (refused) fail("%s: %s", path, refused);
}
