/* Linear filling: West's, done for whole cells. A height field is a continuous surface of cells, each between
 * four neighbouring texels, and stays one when it is moved: there are no holes between cells, only cells that
 * were stretched. Each destination texel whose centre lies in a cell takes the bilinear interpolation of its
 * four texels there. A cell that is turned over is seen from below, which is never: it is left out. */
#ifndef LESSON_FILL_H
#define LESSON_FILL_H

#include "forward.h"

/* warp_forward with FILLING_LINEAR, for possible factors; the destination may hold anything. */
void fill_cells(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                Destination *destination, WarpCounts *counts);

#endif
