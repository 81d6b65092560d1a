/* The scenes quad, floor and horizon: one square, drawn by each technique. */
#ifndef LESSON_SQUARE_H
#define LESSON_SQUARE_H

#include "lesson.h"

/* A square around the origin in the plane z = 0. s grows along x, t along y, from `first` at the lower left
 * corner to first + repeats at the upper right one. */
typedef struct {
    double side, repeats, first;
    Image image;
    Texture texture;
    Shape shape;
} Square;

/* The three squares: side (world units), repeats, first. */
#define QUAD 1, 1, 0
#define FLOOR 16, 4, -2
#define HORIZON 20000, 20000, -10000

/* Scene callbacks, see lesson.h. What they call u and v are s and t here, in repeats of the texture. */
void *square_load_quad(const Options *options);
void *square_load_floor(const Options *options);
void *square_load_horizon(const Options *options);
void square_unload(void *data);
void square_draw(const Frame *frame);
Sample square_truth(const void *data, Ray ray);
Vec2 square_texels(const void *data);
void square_measure(const Shots *shots, Table *table);

/* Technique callback. The technique's variant is its Filling; its knob, if any, is the number of splits a
 * side (FILL_COLOUR, FILL_AFFINE) or of pixels from one exact place to the next (FILL_SPANS). */
void square_paint(const Frame *frame, Picture *picture);

#endif
