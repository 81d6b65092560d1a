/* Solids that rays meet in closed form, placed in the world: what objects are composed of where a lesson
 * needs an object that is exact by its formula. In doubles; what is here is for truths and for making
 * textures. */
#ifndef TEXEL_SOLID_H
#define TEXEL_SOLID_H

#include "vec.h"

#include <stdbool.h>

typedef enum { SOLID_SPHERE, SOLID_CYLINDER, SOLID_BOX } SolidKind;

/* size: a sphere's diameter in x; a cylinder's diameter in x and height in y, closed at both ends; a box's
 * sides. A cylinder lies along y; then the solid is turned, by degrees about x, about y, about z in that
 * order, and moved to its centre. */
typedef struct {
    SolidKind kind;
    Vec3 size, centre, turn_degrees, colour; /* colour: linear light */
} Solid;

typedef struct {
    double depth; /* along the ray, from its origin */
    Vec3 normal;  /* unit, outward */
    int index;    /* of the solid */
} SolidHit;

/* The first crossing with depth >= 0 of a ray with the surface of one of the solids, from outside or inside
 * it; where they overlap, each still has the whole of its surface. Of a ray that begins on a surface,
 * rounding decides whether it is met there. False, and hit as it was, where nothing is met. May be called
 * from many threads. */
bool solids_hit(const Solid *solids, int count, Ray ray, SolidHit *hit);

#endif
