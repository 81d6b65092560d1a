/* How far few rays a texel are from many. */
#ifndef LESSON_SAMPLING_H
#define LESSON_SAMPLING_H

#include "light_field.h"
#include "light_scene.h"

/* Root mean squares over texels and channels: in linear light (0..1), and in the codes that are stored
 * (0..255, sRGB). seeing: over those texels alone that are not black both ways, and how many of the texels
 * these are. */
typedef struct {
    double linear, codes, linear_seeing, codes_seeing;
    int texels, seeing;
} SamplingNoise;

/* Texels made with `few` rays each against the same made with `many` (the reference, at most SAMPLES_MOST).
 * The texels are drawn from fixed seeds: a block (u, v) at random, and in it SAMPLING_PER_BLOCK of its (s, t)
 * at random and with repetition, as a block's rays cost no more together than alone; so `texels` is rounded
 * up to a multiple of that. On all cores; 100,000 texels by 2401 rays of 32 x 32 angles take seconds. */
enum { SAMPLING_PER_BLOCK = 256 };
SamplingNoise sampling_noise(const Field *field, const LightScene *scene, bool through, int few, int many,
                             int texels);

#endif
