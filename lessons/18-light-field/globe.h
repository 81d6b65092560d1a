/* The scenes of this lesson: a model with a light field on it, made of solids when first drawn. */
#ifndef LESSON_GLOBE_H
#define LESSON_GLOBE_H

#include "lesson.h"

void *globe_load(const Options *options);
void globe_unload(void *data);
void globe_draw(const Frame *frame);
Sample globe_truth(const void *data, Ray ray);

#endif
