/* What pictures from one view are held against: made when first asked for, and then kept. */
#ifndef TEXEL_REFERENCE_H
#define TEXEL_REFERENCE_H

#include "compare.h"
#include "lesson.h"

typedef struct Reference {
    const View *view;
    const Truth *truth;
    int width, height, samples;
    Exact exact[2]; /* by PixelFilter */
    Seen seen[2];
    Sample *centres;    /* of the pixels; NULL before reference_look */
    double known_share; /* of the pixels: the truth may know nothing of some */
} Reference;

/* Nothing is rendered yet. view and truth must outlive it; reference_destroy frees what was made. */
Reference reference_create(const Truth *truth, const View *view, int width, int height, int samples);
void reference_destroy(Reference *reference);

/* Looks along the centres of the pixels, and counts what the truth knows; ends the program if that is
 * nothing. */
void reference_look(Reference *reference);

/* The exact picture through a pixel filter, and what an eye sees of it; the reference keeps them. */
const Exact *reference_exact(Reference *reference, PixelFilter filter);
const Seen *reference_seen(Reference *reference, PixelFilter filter);

#endif
