/* Occlusion-compatible order (McMillan 1997): an order in which texels can be painted over one another with
 * no buffer, because what hides another texel always comes after it.
 *
 * A ray leaves the eye; seen along f, it leaves the eye's foot in the source image (the epipole) and moves
 * straight outward. What it meets first is nearest to the epipole. So texels are painted toward the epipole,
 * whose column and row divide the image into up to four sheets, each with one order for its columns and one
 * for its rows. That holds for an eye on either side of the plane: a parallel projection has no centre that
 * the eye could be behind. An eye infinitely far has its epipole infinitely far, the way that the eye is when
 * seen along f. */
#ifndef LESSON_SHEETS_H
#define LESSON_SHEETS_H

#include "prewarp.h"

/* The numbers first, first + step, ... up to but without end; step is 1 or -1, end == first an empty run. */
typedef struct {
    int first, end, step;
} Run;

/* Up to four sheets: each of the two runs of rows with each of the two runs of columns, in this order. The
 * epipole's own row and column come last. */
typedef struct {
    Run rows[2], columns[2];
} Sheets;

/* The epipole in the source's texture coordinates: (k1, k2) / k3, which may be infinite. 0 in a coordinate in
 * which nothing moves, where any order will do. */
Vec2 sheets_epipole(const PrewarpFactors *factors);

/* The sheets of columns x rows items, of which item i reaches from i to i + 1, for an epipole in that
 * measure.
 */
Sheets sheets_toward(Vec2 epipole, int columns, int rows);

/* One sheet from left to right and from the bottom up, where the order does not matter. */
Sheets sheets_plain(int columns, int rows);

#endif
