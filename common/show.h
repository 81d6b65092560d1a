/* What a window shows of a lesson, without the window: a scene, a technique, a camera; and their picture, the
 * truth and the error, each made anew when it is out of date. The context must be current. */
#ifndef TEXEL_SHOW_H
#define TEXEL_SHOW_H

#include "measure.h"
#include "refine.h"

enum { SHOW_FRAMES = 15 };

typedef struct {
    const Lesson *lesson;
    const Options *options;
    void (*wake)(void); /* called by another thread when show_update has something to do */
    int width, height;  /* of all pictures, in pixels */

    Stage stage;
    int technique;
    double knobs[TECHNIQUES_MAX];
    const View *start; /* where the camera began */
    Camera camera;
    bool moved;  /* the camera is no longer there: its view is then called "camera", as on the command line */
    bool moving; /* the scene moves by itself, */
    double seconds, moved_until; /* has done so for so long, and until when */
    bool eager;                  /* the truth is wanted at once, not only when all rests */

    bool changed;           /* what is below, since the owner set this to false */
    const Texture *picture; /* the technique's: one of the three below */
    Texture paint, target, nothing;
    Texture exact, heat; /* of the truth and the error, id 0 where there is none yet */
    Refined refined;     /* their numbers */
    char *log;           /* why shaders could not be built, or NULL */

    bool drawn;              /* the picture is up to date */
    double changed_at;       /* when it was not, last */
    Picture painted;         /* by a technique in C */
    Cost costs[SHOW_FRAMES]; /* of the last frames, in turns, */
    int frames;              /* their number since what they cost changed, */
    double spent;            /* and the seconds that they took */
    Refiner *refiner;
    bool wanted, given; /* the refiner knows the camera; the picture */
    uint64_t stamp;     /* of the shaders' files, */
    double glanced;     /* and when it was looked at */
} Show;

/* Fills in a show that begins with what the command line chose, and closes it. */
void show_open(Show *show, const Lesson *lesson, const Options *options, const Choice *choice,
               void (*wake)(void));
void show_close(Show *show);

/* What to look at. A next scene keeps the technique and the view if it has ones of these names. */
void show_size(Show *show, int width, int height);
void show_technique(Show *show, int index);
void show_knob(Show *show, bool up); /* to the next value of those that the technique lists */
void show_next_view(Show *show);
void show_next_scene(Show *show);
void show_moved(Show *show); /* the owner has moved the camera */

/* Lets what moves by itself go on, or stop; nothing if the scene has nothing that does. While it moves there
 * is no truth, for that takes longer than a frame. */
void show_motion(Show *show);

/* Draws the technique if its picture is out of date. Where its shader cannot be built the last one stays. */
void show_draw(Show *show);

/* Makes new what is out of date: shaders that were edited, the picture, the truth, the error. Returns the
 * seconds until there may be more to do, if nothing happens before. */
double show_update(Show *show);

const Technique *show_chosen(const Show *show);
Frame show_frame(const Show *show); /* its camera, and the view called "camera" if that moved */
Cost show_cost(const Show *show);   /* the median of the last frames */

#endif
