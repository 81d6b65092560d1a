/* Overflow: texels that the eye sees beyond the edges of the polygon. They are lost, or land on auxiliary
 * polygons that stand at those edges, or the destination is enlarged to hold them (Parilov). */
#ifndef LESSON_OVERFLOW_H
#define LESSON_OVERFLOW_H

#include "warp.h"

typedef enum { EDGE_LEFT, EDGE_RIGHT, EDGE_BOTTOM, EDGE_TOP, EDGES } Edge;

/* The least and the greatest displacement of a source's texels, along f. */
typedef struct {
    double low, high;
} Displacements;

Displacements overflow_displacements(const Source *source);

/* Whether the eye can see a point of the source (u_s, v_s within 0..1, displaced by d within that range)
 * beyond an edge of the polygon. Points that are not in front of the eye (1 + k3 d below LANDING_W_MIN) do
 * not count.
 *
 * Beyond the left edge u_i is below 0, and u_s + k1 d is, for 1 + k3 d is positive: some u_s is enough if k1
 * d < 0. Beyond the right edge u_s + k1 d > 1 + k3 d: u_s = 1 is the best there is, so (k1 - k3) d > 0
 * decides.
 *
 * At most two edges where the polygon is the relief's top (base = 1, every d <= 0) and the eye is not behind
 * it (k3 <= 0). For left asks for k1 > 0 and right for k1 < k3: both together for k3 > 0. The same goes for
 * bottom and top. So one of the two at most, for each of u and v: those beyond whose line the eye stands, and
 * none if it is over the polygon. Where the polygon is the bottom (base = 0, every d >= 0) left asks for k1 <
 * 0 and right for k1 > k3, and for an eye over the polygon (k3 < k1 < 0, k3 < k2 < 0) all four edges
 * overflow. */
bool overflow_can(const PrewarpFactors *factors, Displacements d, Edge edge);

/* ---- Auxiliary polygons ---- */

/* A polygon perpendicular to the source plane: a runs along an edge, as u or v does, and b along f, from the
 * deepest displacement to the highest, the polygon's own 0 among them. What leaves the polygon beyond that
 * edge passes through it, and nothing that stays does. Its destination covers all of it, with texels as large
 * as the source's. */
typedef struct {
    Edge edge;
    Plane plane;
    Destination destination;
} Auxiliary;

/* Where the source has no depth (all d are 0) nothing overflows, and an auxiliary is one texel thin. With
 * lookup as in destination_create. auxiliary_destroy frees it. */
Auxiliary auxiliary_create(const Source *source, Edge edge, bool lookup);
void auxiliary_destroy(Auxiliary *auxiliary);

/* Warps the source onto it, with the equations between two planes: cells of four texels, interpolated, with a
 * depth buffer. What is seen from its wrong side, from within the relief's cut side, is left empty. The whole
 * stays empty where the eye is in either plane. */
void auxiliary_warp(const Source *source, Eye eye, Auxiliary *auxiliary);

/* ---- An enlarged destination ---- */

/* Where the image of a relief lies: low..high in the polygon's texture coordinates, 0..1 always among them.
 * Its extremes are those of the eight corners of u_s, v_s and d: with d held fixed u_i grows with u_s, and
 * with u_s held fixed its derivative by d is (k1 - k3 u_s) / (1 + k3 d)^2, whose sign does not depend on d.
 */
typedef struct {
    Vec2 low, high;
    bool whole; /* false if the limit cut it */
} Bounds;

/* The bounds of what is in front of the eye (1 + k3 d at least LANDING_W_MIN), which grow without end as the
 * eye comes down to the relief, so they are cut at most `limit` widths beyond each edge. Rounded outward to
 * whole texels. */
Bounds overflow_bounds(const Source *source, const PrewarpFactors *factors, double limit);

/* A destination over those bounds, with texels of the source's size; the limit is lowered where more would be
 * too large for an image. The caller destroys it. */
Destination overflow_destination(const Source *source, const PrewarpFactors *factors, double limit,
                                 bool lookup);

#endif
