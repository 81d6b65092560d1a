/* Speed against error: all pictures of a lesson, held against the exact ones and against the clock. */
#ifndef TEXEL_MEASURE_H
#define TEXEL_MEASURE_H

#include "only.h"
#include "stage.h"
#include "table.h"

/* What the command line narrows a lesson to; NULL or 0: all. */
typedef struct {
    const char *scene, *technique, *view;
    double knob;
    int width, height;
    const Only *only;   /* of the table's rows */
    bool brief;         /* no pictures and times of extra views, unless one is asked for by name */
    const View *custom; /* a camera from the command line, instead of the scenes' own views */
} Choice;

/* What to make; NULL: not. */
typedef struct {
    const char *render, *truth, *errors; /* folders */
    const char *measure;                 /* a file */
} Orders;

/* Makes it for all scenes that were chosen, with progress on standard error. The context must be current. */
void measure_all(const Lesson *lesson, const Options *options, const Choice *choice, const Orders *orders);

/* The name that a picture's file has: SCENE-VIEW-TECHNIQUE[-KNOB]; the caller frees it. */
char *picture_name(const Frame *frame);

#endif
