/* What is wrong with a warped relief, texel by texel: against exact rays, and against every texel of the
 * source projected by itself in doubles. Nothing here shares code with the warps that it judges.
 *
 * An eye from which nothing of the relief is seen (behind its plane, in it) has nothing to judge: all figures
 * are 0 then, as they are wherever there is nothing to take a share of. */
#ifndef LESSON_JUDGE_H
#define LESSON_JUDGE_H

#include "truth.h"
#include "warp.h"

/* A texel of the source as the eye has it. */
typedef struct {
    double u, v; /* where its line of sight meets the polygon's plane, in the polygon's texture coordinates */
    double height; /* h: of two on one line of sight the higher is the nearer */
    bool in_front; /* of the eye; if not, it has no u and v */
    bool visible;  /* nothing of the relief (bilinear, its sides left open) is nearer on its line of sight */
} Sighting;

/* All that one eye's figures share, for destinations of one size and place. */
typedef struct {
    const Source *source; /* the caller's, and needed as long as the judge is */
    int width, height;    /* of the destinations */
    Vec2 low, high;
    Image heights, colours; /* the source's, linear */
    Sighting *sightings;    /* one a texel of the source, row 0 first */
    Sample *exact;          /* one a texel of the destination: what the ray through its centre meets of the
                               relief behind the polygon's window; no hit for those outside the window */
    int *highest; /* one a texel of the destination: the highest of the source's texels whose landing
                     lies within it, or -1 */
} Judge;

/* For destinations that have the shape of this one, of which nothing else is read. judge_destroy frees it. */
Judge judge_create(const Source *source, Eye eye, const Destination *shape);
void judge_destroy(Judge *judge);

/* Texels left empty (alpha below 128), over those whose exact ray hits the relief. */
double judge_hole_percent(const Judge *judge, const Destination *destination);

/* Texels that show something lower than the highest texel that landed there, by more than how far the two
 * (the texel of the source nearest to what is shown, and the highest) rise or fall to a neighbour: the sum of
 * both, each over its eight neighbours. Over those that show something and where something landed. What is as
 * high as the exact ray's hit, but for its own rise, is right all the same: the highest landed half a texel
 * from the centre, which sees past it. (The exact picture would have 0.1 to 0.4 % of violations otherwise, on
 * the brick wall.) Needs lookup. */
double judge_order_violation_percent(const Judge *judge, const Destination *destination);

/* The rms difference of linear colours from the exact ray's, over the texels whose ray hits; what is empty or
 * transparent is black there. */
double judge_rmse(const Judge *judge, const Destination *destination);

/* A plane on which texels land, and the part of it that keeps them. */
typedef struct {
    Plane plane;
    Vec2 low, high;
} Canvas;

/* Visible texels of the source that land on none of the canvases, over the visible ones. */
double judge_lost_texel_percent(const Judge *judge, Eye eye, const Canvas *canvases, int count);

/* What the two-pass's first pass overwrites. kept: judge->width columns by source->height rows, the source's
 * u that was left there, or NAN. A texel counts as visible in one pass if it is visible and the highest that
 * landed in its texel of the destination; it is lost if its row keeps, in its column, a point of the source
 * more than a texel away that would be shown more than a texel higher or lower. Over those visible in one
 * pass.
 */
double judge_first_pass_loss_percent(const Judge *judge, Eye eye, const float *kept);

#endif
