/* Samples on a face of the box, and triangles drawn into them: each sample keeps the nearest surface that
 * landed on it. */
#ifndef LESSON_GRID_H
#define LESSON_GRID_H

#include "box.h"
#include "lanes.h"

/* A band of rows of a face's samples, whose places are 0.5, 1.5 and so on. Each is NOTHING deep and shows
 * texel 0 until something lands on it. */
typedef struct {
    int width, stride, first, end; /* samples in a row, and with those that only fill the last lanes; rows */
    float side;                    /* 1: what is counter-clockwise faces the eye; -1: what is clockwise */
    float *depths;                 /* of the whole face, row 0 first */
    uint32_t *texels;
} Grid;

/* A point where it lands: in samples from the face's lower left corner, and how deep. */
typedef struct {
    float x, y, depth;
} Landed;

/* Samples x0..x1 - 1 of rows y0..y1 - 1. */
typedef struct {
    int x0, x1, y0, y1;
} Extent;

void grid_clear(const Grid *grid);

/* Draws a triangle, whose samples all lie in an extent within the grid, unless it faces away or one of its
 * corners is no number. A sample shows the texel of the corner that it is nearest to by its weights. */
void grid_triangle(const Grid *grid, Extent extent, Landed a, Landed b, Landed c, const uint32_t texels[3]);

/* The means of samples x samples (1, 2 or 4) for each texel of a row: the texels' values, where nothing,
 * which is texel 0, counts as 0. colour and normal get four numbers each. */
void grid_resolve(const Grid *grid, int samples, int row, const Texel *texels, uint16_t *colour,
                  uint16_t *normal);

/* The first of the samples low..high - 1 that is not below a place; high where there is none, low where the
 * place is no number. */
static inline Ints sample_from(Floats place, int low, int high) {
    Floats from = least(greatest(place - 0.5f, floats((float)low)), floats((float)high));
    Ints below = __builtin_convertvector(from, Ints);
    return below - (Ints)(__builtin_convertvector(below, Floats) < from); /* what holds is -1 */
}

#endif
