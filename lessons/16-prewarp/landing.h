/* Where texels land: u_i and v_i of prewarp.h for a row of the source at a time, in floats, in the measure of
 * the destination. */
#ifndef LESSON_LANDING_H
#define LESSON_LANDING_H

#include "warp.h"

/* One row of the source. Entries 0 to count - 1 are its texels; entries -1 and count are the row's ends at u
 * = 0 and u = 1, halfway between its first and its last texel, for the image repeats. Likewise row -1 and the
 * row after the last are the edges v = 0 and v = 1. */
typedef struct {
    int row, count;
    float *u;         /* in the source */
    float *x, *y;     /* in destination texels: the lower left one's centre is 0, 0. LANDING_NOWHERE, both,
                         for a texel behind the eye or more than 2^20 texels away */
    float *w;         /* 1 + k3 d */
    uint16_t *levels; /* the heights */
    Texel *texels;
    float v;      /* of the whole row */
    void *memory; /* that all of these lie in, with room for LANES entries more, which mean nothing */
} LandedRow;

#define LANDING_NOWHERE (-1e9f)

/* What is nearer to the eye's plane than this part of the polygon's distance is not moved. */
#define LANDING_W_MIN (1.0 / 64)

/* Room for a row of that many texels, with u filled in; landed_row_destroy frees it. */
LandedRow landed_row_create(int count);
void landed_row_destroy(LandedRow *row);

/* A warp's equations in the measure of the destination, with the source's levels l for d:
 *     w = w_0 + w_l l,  x = (x_u u + x_0 + x_l l) / w,  y = (y_v v + y_0 + y_l l) / w. */
typedef struct {
    float w_0, w_l, x_u, x_0, x_l, y_v, y_0, y_l;
} Landing;

Landing landing_create(const Source *source, const PrewarpFactors *factors, const Destination *destination);

/* Lands row `index` of the source, -1 to its height. */
void landing_row(const Landing *landing, const Source *source, int index, LandedRow *row);

/* The same without its texels, which stay what they were. */
void landing_place(const Landing *landing, const Source *source, int index, LandedRow *row);

#endif
