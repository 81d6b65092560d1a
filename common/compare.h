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

/* Compares the first three channels (or the one) of two linear images. NULL when they can be compared, else
 * the reason with its place: another size, another number of channels (1 against 3; a fourth is ignored), a
 * value that is not finite. The reason is valid until the next call. map, if not NULL, is made: one channel
 * a pixel, the FLIP error 0..1; the caller destroys it. Without it FLIP, nine tenths of the time, is left
 * out. */
const char *compare(const Image *test, const Image *reference, Difference *difference, Image *map);

/* The FLIP map's errors 0..1 as colours to look at (black, violet, orange, white), linear light, three
 * channels; the caller destroys it. */
Image compare_heat(const Image *map);

/* LDR-FLIP (Andersson et al. 2020) of two images of 8-bit sRGB values given as linear light, already of one
 * size and finite. map has one channel and their size. Returns the mean of the map. */
double flip(const Image *test, const Image *reference, Image *map);

#endif
