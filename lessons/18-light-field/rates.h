/* How fast light fields are synthesised: against brute force, and against the best that Embree does. */
#ifndef LESSON_RATES_H
#define LESSON_RATES_H

#include "embree_field.h"

/* A rate counts the rays of all texels, those that meet nothing included, in rays a second of all cores. A
 * ratio is the median over the rounds of rates of the same round, each way taking its turn in each.
 * different: of the texels that another way made, the share that differs from synthesis.h's by more than one
 * code in any channel. */
typedef struct {
    double rays_per_second;                    /* synthesis.h's */
    double brute_rays_per_second, brute_ratio; /* ours to it */
    double embree_ratio;                       /* ours to the fastest of all of Embree's */
    double embree_rays_per_second[2]
                                 [EMBREE_WAYS];  /* [0] user geometry, [1] meshes: each, as fast as it gets */
    bool embree_coherent[2][EMBREE_WAYS];        /* whether that was with the coherent flag */
    double brute_different, embree_different[2]; /* the most of any of the ways */
    int triangles;                               /* of the meshes */
} Rates;

/* Measures it for a scene without effects and rays from the model, rounds >= 1. Takes about a second for 8
 * million texels and a round, on two cores; needs twice the field's bytes. */
Rates rates_measure(const Field *field, const LightScene *scene, int rounds);

#endif
