/* How far one image is from another. */
#ifndef TEXEL_COMPARE_H
#define TEXEL_COMPARE_H

#include "image.h"

typedef struct {
    double rmse;    /* root of the mean square over pixels and RGB, linear light, unclipped */
    double psnr_db; /* after clipping to 0..1 and sRGB encoding; 100 for identical images */
    double flip; /* mean LDR-FLIP of the 8-bit sRGB images, 0..1 (see flip.c); only if a map is asked for */
    double max_abs; /* the largest difference of a channel, linear light, unclipped */
} Difference;

/* What an eye sees of an image (linear light, finite; seen as an 8-bit sRGB file keeps it), by FLIP's model:
 * two thirds of FLIP's time, so a reference for many pictures is looked at once. seen_destroy frees it. */
typedef struct SeenPixel SeenPixel;
typedef struct {
    int width, height;
    SeenPixel *pixels;
} Seen;

Seen seen_create(const Image *image);
void seen_destroy(Seen *seen);

/* Compares the first three channels (or the one) of two linear images. NULL when they can be compared, else
 * the reason with its place: another size, another number of channels (1 against 3; a fourth is ignored), a
 * value that is not finite. The reason is valid until the next call. map, if not NULL, is made: one channel
 * a pixel, the FLIP error 0..1; the caller destroys it. Without it FLIP, nine tenths of the time, is left
 * out. */
const char *compare(const Image *test, const Image *reference, Difference *difference, Image *map);

/* The same with the reference already looked at; seen is NULL where no map is asked for. */
const char *compare_seen(const Image *test, const Image *reference, const Seen *seen, Difference *difference,
                         Image *map);

/* The FLIP map's errors 0..1 as colours to look at (black, violet, orange, white), linear light, three
 * channels; the caller destroys it. */
Image compare_heat(const Image *map);

/* LDR-FLIP (Andersson et al. 2020) of two that have one size. map is made: one channel. Returns its mean. */
double flip(const Seen *test, const Seen *reference, Image *map);

#endif
