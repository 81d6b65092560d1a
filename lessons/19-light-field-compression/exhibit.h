/* The scenes of this lesson: one light field, raw and encoded. */
#ifndef LESSON_EXHIBIT_H
#define LESSON_EXHIBIT_H

#include "lesson.h"

/* What a technique reads: its variant. */
typedef enum { EXHIBIT_RAW, EXHIBIT_BLOCK, EXHIBIT_VQ, EXHIBIT_RAMP } Exhibited;

/* Scene callbacks, see lesson.h. */
void exhibit_list(const Scene *scene);
void *exhibit_load(const Options *options);
void exhibit_unload(void *data);
void exhibit_draw(const Frame *frame);
Sample exhibit_truth(const void *data, Ray ray);
void exhibit_measure(const Shots *shots, Table *table);

#endif
