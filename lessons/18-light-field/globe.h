/* The scenes of this lesson: a model around solids, with light-field textures of them on it. */
#ifndef LESSON_GLOBE_H
#define LESSON_GLOBE_H

#include "lesson.h"

/* Which light field a technique reads: its variant. In the scene aliasing its knob is the number of rays a
 * texel. */
typedef enum {
    READS_USUAL,         /* the scene's own */
    READS_USUAL_PAGED,   /* the same, by a shader that may find it in several textures */
    READS_SINE,          /* the same with other angular scales */
    READS_STEREOGRAPHIC, /* */
    READS_PLAIN_LIGHT,   /* without shadows, mirror and transparency */
    READS_64_32_256_256, /* the sizes of the paper's Figure 7 */
    READS_512_256_32_32, /* */
    READS_512_256_64_64, /* this one in several textures */
    READS_COUNT,
    READS_NOTHING = -1 /* no light field at all */
} Reads;

/* Scene callbacks, see lesson.h. */
void globe_list(const Scene *scene);
void *globe_load(const Options *options);
void globe_unload(void *data);
void globe_draw(const Frame *frame);
Sample globe_truth(const void *data, Ray ray);
void globe_measure(const Shots *shots, Table *table);

#endif
