/* What C makes of a texture so that GLSL can read much of it at once: mip chains and summed-area tables. */
#ifndef LESSON_CHAIN_H
#define LESSON_CHAIN_H

#include "image.h"

/* ---- Mip chains (Williams 1983) ----
 *
 * Each level is its parent halved: n texels become max(1, floor(n / 2)), until both sides are 1. All filters
 * work on rows, then on columns, and take the texture as repeating. */

typedef enum {
    CHAIN_BOX,      /* a texel is the mean of the area of its parent that it covers, in linear light. For odd
                     * n = 2m + 1 that is 2 + 1/m parent texels: three taps, weighted (m-i, m, i+1) / n. */
    CHAIN_SRGB_BOX, /* the classic mistake: the same mean of sRGB-encoded values, which is too dark */
    CHAIN_KAISER    /* a sinc cut off three texels from its middle by a Kaiser window, alpha = 4: sharper,
                     * and it rings: values may leave the parent's range, even below 0 */
} ChainFilter;

enum { CHAIN_LEVELS_MAX = 15 }; /* 16384 = 2^14 */

typedef struct {
    int count;
    Image levels[CHAIN_LEVELS_MAX]; /* level 0 is the base image itself, not a copy of it */
} Chain;

/* All levels of an image of linear floats of any size and range, which must outlive the chain. A fourth
 * channel is taken as alpha: never sRGB. chain_destroy frees the levels but the base. */
Chain chain_create(const Image *base, ChainFilter filter);
void chain_destroy(Chain *chain);

/* ---- Summed-area tables (Crow 1984) ----
 *
 * S(x, y) is the sum of the texels in columns 0..x and rows 0..y. Floats have 24 bits, which S fills long
 * before the small difference of four S is taken. So S = high + low: high is S rounded to a multiple of
 * q = 2^e, with e the smallest for which all texels' absolute values sum to at most 2^23 q. Then high and
 * all sums over boxes of it are multiples of q below 2^24 q: floats add and subtract them without rounding.
 * |low| <= q/2 is stored to q/2 * 2^-24, so the four corners of a box err by at most q 2^-23 together, which
 * is at most 2^-45 of the sum of all absolute values. */

typedef struct {
    Image high, low; /* the base's size and channels */
} SummedArea;

SummedArea summed_area_create(const Image *base);

/* The mistake: high is S rounded to the nearest float, low is 0. */
SummedArea summed_area_create_naive(const Image *base);

void summed_area_destroy(SummedArea *table);

#endif
