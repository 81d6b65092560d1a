/* The two-pass warp (Oliveira, Bishop, McAllister 2000): first every row is stretched and folded within
 * itself, to the columns where its texels belong (u_i), then every column, to the rows (v_i). Both passes are
 * the same loop over a line of texels, between which everything is interpolated, so that no holes are left in
 * it: what the line jumps over is filled with a slope from one side to the other.
 *
 * Of the paper's variants it is the one that computes v_i in the first pass, from each texel's own
 * displacement, and carries it along the row, interpolated like the colour; the second pass then needs no
 * displacement. (A straight piece of a row is seen as a straight line, on which v_i is linear in u_i: nothing
 * is lost by that.)
 *
 * What it loses: where a row folds, two of its points come to lie in one column, and the first pass keeps the
 * one painted last, though the second would have moved them apart. They are on one ray only as far as the row
 * knows. A slope that is narrow in u_i but tall in v_i has few columns to pass through the first pass in. And
 * where neighbouring rows end in different columns, nothing is painted between their ends: the only holes, at
 * the relief's own edges. */
#ifndef LESSON_TWO_PASS_H
#define LESSON_TWO_PASS_H

#include "warp.h"

/* Warps the source into the destination, which is emptied first: it stays empty where the warp is not
 * possible. Each line is painted toward the epipole, so that what is painted last is nearest to the eye; what
 * is not in front of the eye (1 + k3 d below LANDING_W_MIN) interrupts it. kept: NULL, or destination->width
 * columns by source->height rows, for the source's u that the first pass left there, or NAN. Ends the program
 * if memory runs out. */
void warp_two_pass(const Source *source, const PrewarpFactors *factors, Destination *destination,
                   float *kept);

#endif
