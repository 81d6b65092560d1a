/* T-joints: where two halves of one surface meet that are split differently, a vertex of one half lies on an
 * edge of the other. On paper it lies exactly on it; snapped to 1/256 pixel it does not, and on a curved
 * surface it never did. Between the three corners of that thin triangle, pixels are missed or drawn twice. */
#ifndef LESSON_JOINTS_H
#define LESSON_JOINTS_H

#include "raster.h"

/* The point of a surface at s, t, 0..1 each; the same numbers in must give the same bits out. */
typedef ClipVertex (*SurfacePoint)(const void *context, double s, double t);

typedef struct {
    int triangle_count, outline_count;
    ClipVertex (*triangles)[3]; /* owned, as the outline is: joint_destroy frees both */
    ClipVertex *outline;        /* the surface's boundary, in order */
} Joint;

/* The half s <= 1/2 in left x left cells and the half s >= 1/2 in right x right cells (1..4096 each), of two
 * triangles each. mended: a triangle with an edge on the joint becomes a fan to the vertices that the other
 * half has on that edge. Neighbours then share whole edges, and T-joints are gone. Two levels of detail are
 * left = 2 right, on a curved surface. */
Joint joint_create(int left, int right, bool mended, SurfacePoint point, const void *context);
void joint_destroy(Joint *joint);
void joint_draw(const Raster *raster, const Joint *joint);

/* Numbers of pixels: whose centre is inside the outline of the snapped surface; of these, those that no
 * triangle draws; and those, anywhere, that several draw. */
typedef struct {
    int inside, missed, doubled;
} Cracks;

/* Counts them over a picture. Where a surface hides a part of itself, it is drawn twice without a crack; so
 * look at it from where it does not. dropped_bits as in Raster. */
Cracks joint_cracks(const Joint *joint, int width, int height, int dropped_bits);

#endif
