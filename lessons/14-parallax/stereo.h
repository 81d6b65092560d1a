/* The scene `stereo`: the wall of wall.h seen by two eyes. */
#ifndef LESSON_STEREO_H
#define LESSON_STEREO_H

#include "wall.h"

/* Scene callback: disparity_error_pixels_rms, disparity_error_pixels_median and matched_percent. It needs the
 * views `left` and `right`, two cameras that differ by a step along x alone, so that what one sees in a row
 * the other sees in the same row. */
void stereo_measure(const Shots *shots, Table *table);

/* Where a row of lookups (u, v, depth, hit; four floats a pixel) shows (u, v): the place, in pixels from the
 * left edge with centres at halves, at which the row's u, linear between neighbours that are hit, is u; of
 * several places that whose v is nearest. A negative number where there is none. */
double stereo_find(const float *row, int width, double u, double v);

#endif
