/* How far from the exact hits a technique's lookups are: what lessons that find points of a relief report. */
#ifndef TEXEL_HITS_H
#define TEXEL_HITS_H

#include "lesson.h"

/* A wrong hit is more than one texel from the exact one, or a hit where there is none, or none where there is
 * one. */
typedef struct {
    double wrong_percent; /* of the pixels that either hits; 0 where that is none */
    double p99;           /* texels: the error that 99 % of the hits of both do not exceed; 0 without one */
} HitErrors;

/* lookup has four channels (see Picture); exact the truth along the centre of each of its pixels, row 0
 * first; texels the size of the texture in whose texels errors are measured. What the truth does not know
 * counts nowhere. */
HitErrors hit_errors(const Image *lookup, const Sample *exact, Vec2 texels);

#endif
