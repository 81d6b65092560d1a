/* Linear filling: West's, done for whole cells. A height field is a continuous surface of cells, each between
 * four neighbouring texels, and stays one when it is moved: there are no holes between cells, only cells that
 * were stretched. Each destination texel whose centre lies in a cell takes the bilinear interpolation of its
 * four texels there. A cell that is turned over is seen from below, which is never: it is left out. */
#ifndef LESSON_FILL_H
#define LESSON_FILL_H

#include "forward.h"

/* warp_forward with FILLING_LINEAR, for possible factors; the destination may hold anything. The source has
 * at most 32767 texels in a row and rows, and 1/65536 of it is the finest step that texels are taken from.
 *
 * What made it fast, as parts of the time that it took before, on the brick wall and on the terrain: choices
 * painted without a branch and cells sorted with one linear map for u and v 0.80 and 0.80, the least and the
 * greatest of two numbers in one instruction 0.95 and 0.93, wide cells by rows of their boxes and not line by
 * line 0.90 and 0.94. Texels fetched four at a time took half of what one at a time took, once no vector was
 * loaded from memory where two halves had just been stored. */
void fill_cells(const Source *source, const PrewarpFactors *factors, Visibility visibility,
                Destination *destination, WarpCounts *counts);

#endif
