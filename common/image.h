/* Images: what a file holds, as floats in memory. Their files are OpenImageIO's work, behind this C
 * interface (image.cpp).
 *
 * Row 0 is the bottom row, so that rows grow upward like texture v: files store the top row first, and
 * loading and saving flip. Colours are linear light; sRGB exists only in files and on screens. */
#ifndef TEXEL_IMAGE_H
#define TEXEL_IMAGE_H

#include "vec.h"

#include <stdbool.h>
#include <stddef.h>

/* Where a relief texture lies in its own world, so that a height has a unit: the texel coordinates (u, v)
 * with height h are the point origin + u a + v b + scale |a| (h - base) f/|f|, u and v over 0..1. a, b and f
 * are the vectors of Oliveira, Bishop and McAllister 2000, a and b here over the whole image. The length of f
 * says how many times the relief is deeper than what it shows (1: as deep), so that the true displacement is
 * scale |a| (h - base) / |f|. unit names what lengths are measured in ("m", "mm"), "" where the file says
 * none. */
typedef struct {
    Vec3 origin, a, b, f;
    char unit[16];
} Basis;

typedef struct {
    int width, height, channels; /* 1..IMAGE_SIDE_MAX a side, 1..4 channels */
    int bits;                    /* of the file's samples: 8 or 16 (integers), 32 (floats) */
    double scale, base;          /* of a height map (see below); NAN when the file does not say */
    Basis basis;                 /* of a relief texture's height; a.x is NAN when the file does not say */
    bool hollow;                 /* of a relief texture's height: a height of 0 is no surface at all */
    bool relief;                 /* the file is a relief texture, and was not read raw */
    float *pixels;               /* height * width * channels floats; image_destroy frees them */
} Image;

enum { IMAGE_SIDE_MAX = 16384 };

/* How the numbers of a file become floats. */
typedef enum {
    IMAGE_COLOUR, /* three channels of linear light: sRGB is decoded, grey is copied, alpha is dropped */
    IMAGE_HEIGHT, /* the first channel alone, or a relief texture's fourth, as it is stored (0..1 for
                     integers), with scale, base, basis and hollow */
    IMAGE_RAW     /* every channel as it is stored (0..1 for integers) */
} ImageKind;

/* A black image of 32 bits, scale and base NAN. Ends the program if the size is out of bounds. */
Image image_create(int width, int height, int channels);
void image_destroy(Image *image);

/* The channels of the texel in column x, row y, which the caller keeps in bounds. */
static inline float *image_at(const Image *image, int x, int y) {
    return image->pixels + ((size_t)y * image->width + x) * image->channels;
}

/* Reads a file (PNG, JPEG, EXR, HDR and whatever else OpenImageIO reads). NULL when all went well, else the
 * reason, without the file's name, valid until the next call. Refused: what is missing, empty, truncated (a
 * JPEG must have its end marker), no image, larger than IMAGE_SIDE_MAX a side or 1 GiB as floats (checked
 * before anything is allocated), or not finite everywhere. image is then left as it was. */
const char *image_read(Image *image, const char *path, ImageKind kind);

/* Writes linear floats as the file's ending asks: .png and .jpg 8-bit sRGB (clipped to 0..1; one channel is
 * taken as grey, and a fourth is dropped), .exr 32-bit floats, .hdr. The file appears whole or not at all:
 * it is written under another name in the same folder, then renamed. NULL or the reason, as above. */
const char *image_write(const Image *image, const char *path);

/* Writes raw numbers, without sRGB: .png of bits 8 or 16 (clipped to 0..1, rounded to nearest), .exr of
 * floats. A scale and base that are not NAN are stored as the string attributes texel:scale, texel:base. */
const char *image_write_raw(const Image *image, const char *path, int bits);

/* Writes a relief texture: one file of four channels, colour (three of linear light) and height (one channel
 * of the same size, clipped to 0..1), .png of bits 8 or 16 (colours are sRGB there) or .exr of floats. The
 * height's scale, base, basis and hollow go along as the string attributes texel:relief (the version, 1),
 * texel:scale, texel:base, texel:basis (twelve numbers: origin, a, b, f), texel:unit and texel:hollow.
 * Those that the height does not say (NAN, "", false) are left out. image_read reads such a file as
 * IMAGE_COLOUR and as IMAGE_HEIGHT. NULL or the reason, as above; among the reasons are two sizes and a basis
 * that spans no volume. */
const char *image_write_relief(const Image *colour, const Image *height, const char *path, int bits);

/* The same, ending the program with "PATH: reason" instead of returning one. */
Image image_load(const char *path, ImageKind kind);
void image_save(const Image *image, const char *path);

/* Bilinear interpolation at (u, v), in doubles, with texel centres at ((x + 0.5) / width, (y + 0.5) /
 * height) and the image repeated in both directions. out holds image->channels numbers. This is how the
 * truth sees a texture: none of GL's filtering is in it. */
void image_sample(const Image *image, double u, double v, double *out);

/* The sRGB transfer function (IEC 61966-2-1), one channel, both ways, and what an 8-bit file keeps of it. */
double srgb_encode(double linear);
double srgb_decode(double encoded);
unsigned char srgb_byte(float linear); /* 255 srgb_encode, clipped to 0..255, rounded to nearest */

#endif
