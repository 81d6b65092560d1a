/* The exact picture of what a window shows, made better and better by a thread of its own, and how far the
 * technique's picture is from it. Only one thread, the owner's, calls these. */
#ifndef TEXEL_REFINE_H
#define TEXEL_REFINE_H

#include "compare.h"
#include "truth.h"

typedef struct Refiner Refiner;

/* What is known so far. The taker owns the images, whose pixels are NULL where there is nothing new. */
typedef struct {
    Image exact;
    int rays;   /* a pixel, of the exact picture; 0: only a quick sketch of it, or none */
    Image heat; /* compare_heat, once there is an error */
    Difference difference;
    int judged;       /* the rays a pixel of the exact picture that the difference is from; 0: none yet */
    char reason[100]; /* why there is no difference, where there cannot be one */
} Refined;

/* A thread that works on the truth's scene, which must outlive it, up to so many rays a pixel. It calls wake,
 * from its own thread, when there are news. Destroying waits a moment for it to stop. */
Refiner *refiner_create(const Truth *truth, int rays, void (*wake)(void));
void refiner_destroy(Refiner *refiner);

/* From now on the exact picture is that of another camera, and what was known is dropped. NULL: of none. */
void refiner_want(Refiner *refiner, const Camera *camera, int width, int height);

/* From now on this picture, which becomes the refiner's, is held against each exact one of its size; the
 * error of the last one is dropped. No pixels: none. */
void refiner_judge(Refiner *refiner, Image picture);

/* True if something new is known since the last call. */
bool refiner_news(Refiner *refiner, Refined *refined);

#endif
