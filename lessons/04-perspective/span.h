/* A span: neighbouring pixels of one row, and the texture coordinates along them.
 *
 * What is linear on the screen is known along a span from its value at one end and its step from pixel to
 * pixel. Both are computed in doubles, once a span, and rounded to float; the arithmetic of each pixel
 * (perspective.glsl) is in float. Three choices keep its rounding small, wherever the span lies:
 *
 *   - it starts anew in each span, so that no error is carried from pixel to pixel or from row to row;
 *   - a value is start + k step, not the last one plus step;
 *   - k counts from the span's far end, where 1/w is least. So 1/w is a sum of two positive numbers, and its
 *     relative error stays small down to the horizon, where 1/w itself falls to 0. Counted from the near
 *     end it would be a difference there, with the rounding error of the near end's large 1/w.
 *
 * How large is it? With u = 2^-24 and M the largest |s| in the span, four roundings make 1/w (start, step,
 * product, sum), no more than 3u of it, relative. The same four make s/w: since |start| <= M/w at any later
 * pixel and |k step| <= |s/w| + |start| <= 2M/w, they add up to (1 + 2 + 2 + 1) u M/w. The division adds one
 * u: |error of s| <= 10 u M. Linear steps between two such values add (3 * 2 + 1) u M. FLOAT_TERM and
 * FLOAT_TERM_SPANS are these, one more for the products of roundings. (16 ulp(M) is at least 16 u M.) */
#ifndef LESSON_SPAN_H
#define LESSON_SPAN_H

#include <stdbool.h>

enum { FLOAT_TERM = 11, FLOAT_TERM_SPANS = 18 };

/* start + k step at the k-th pixel from the span's far end; what comes of it is kept within low..high. */
typedef struct {
    double start, step, low, high;
} Ramp;

/* What is interpolated beside 1/w: texture coordinates and, for FILL_COLOUR, a colour. */
enum { VALUE_S, VALUE_T, VALUE_R, VALUE_G, VALUE_B, VALUES };

typedef struct {
    int x, y, count;     /* pixels x .. x + count - 1 of row y */
    bool from_right;     /* the far end is the right one */
    Ramp one_over_w;     /* its step is never negative */
    Ramp values[VALUES]; /* with perspective, start and step are those of s/w, low and high those of s */
} Span;

/* Writes one value of all pixels, from left to right, as it is without perspective. */
void span_affine(const Span *span, int value, float *out);

/* The same for s and t, with perspective. */
void span_perspective(const Span *span, float *s, float *t);
void span_perspective_every(const Span *span, int every, float *s, float *t);

/* Writes the depth w, the reciprocal of 1/w. */
void span_depth(const Span *span, float *w);

/* Writes how far s and t, as a vector in texels of a width x height texture, can be from the exact ones:
 * max |s''| n^2 / 8 for linear interpolation over n pixels (n = every; 0 for a division at each), plus the
 * float term. Along a span s = N/D, N = N0 + k N1, D = D0 + k D1, so s'' = -2 D1 (N1 D0 - N0 D1) / D^3: most
 * where D is least, at the far end of each piece. */
void span_bound(const Span *span, int every, int width, int height, float *bound);

#endif
