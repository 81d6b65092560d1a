/* What a lesson is: data. A lesson has scenes; a scene has techniques (ways to draw it), views and a truth.
 *
 * lesson.c of a lesson fills one Lesson in and hands it to lesson_run, which gives it a command line (see
 * lesson_run's --help), a window, pictures, exact pictures, and the table of speed against error. */
#ifndef TEXEL_LESSON_H
#define TEXEL_LESSON_H

#include "draw.h"
#include "truth.h"

typedef struct Lesson Lesson;
typedef struct Scene Scene;
typedef struct Technique Technique;

/* What the user chose for a scene's loading. The paths are never NULL where the scene names an image; where
 * its colour is "", that is NULL unless the user gave one. */
typedef struct {
    const char *scene;           /* its name */
    const char *colour, *height; /* full paths: the user's own, or the scene's in the assets folder */
    const char *other[2];        /* full paths of scene->other */
    double scale;                /* --scale, or NAN */
} Options;

/* A camera by name. An extra view is measured like the others, but the report shows no picture of it, times
 * nothing there and computes no flip: for many directions of one thing. Asked for by --view, it is like any
 * other. */
typedef struct {
    const char *name;
    Camera camera;
    bool extra;
} View;

/* One picture that is being made. */
typedef struct {
    const Scene *scene;
    const Technique *technique;
    double knob;      /* the technique's number; 0 where it has none */
    void *data;       /* what the scene's load returned */
    const View *view; /* where the camera started: in a window the camera may have moved since */
    Camera camera;
    int width, height; /* pixels */
    bool looking;      /* the picture gets a lookup; false while timed */
    Program *program;  /* in use while draw runs; NULL in prepare and paint */
} Frame;

enum { KNOBS_MAX = 8 };

/* One way to draw a scene. Either vertex and fragment name shader files of the lesson (or of common), and the
 * scene's draw is called with them in use; or paint makes the picture in C. */
struct Technique {
    const char *name, *what; /* what: one line for --list and the report */
    const char *vertex, *fragment;
    int variant; /* the lesson's own enum; also the shader's uniform int variant */
    struct {
        const char *name;
        double values[8];                /* positive, ended by a 0 if there are fewer */
    } knob;                              /* also the shader's uniform float knob */
    void (*prepare)(const Frame *frame); /* C before GL, timed apart (prepare_ns_per_pixel) */
    /* C instead of GL. The picture is the scene's background on entry; lookup.pixels is NULL while timed. */
    void (*paint)(const Frame *frame, Picture *picture);
};

/* A number that a scene is made of, for --list: a reader must be able to build the same scene from these. */
typedef struct {
    const char *name;
    double value;
    const char *unit;
} Fact;

/* One technique with one knob, seen from each view: what a scene's own metrics are made of. */
typedef struct {
    const View *view;
    Picture picture;
    const Sample *centres;       /* the truth along each pixel's centre ray, row 0 first */
    struct Reference *reference; /* for shot_exact */
} Shot;

/* The exact picture that the shot's is held against (the box's), rendered when first asked for; not the
 * caller's. */
const Image *shot_exact(const Shot *shot);

typedef struct {
    const Frame *frame; /* technique, knob, data, size; its camera and view belong to the first shot */
    const Shot *shots;
    int count;
    const struct Only *only; /* for shots_want */
    struct Stage *stage;     /* for shots_time */
} Shots;

/* Whether anybody asks for that row (see --only): what takes long to measure should not be otherwise. view
 * NULL where the figure belongs to none. */
bool shots_want(const Shots *shots, const View *view, const char *metric);

/* What one frame takes on the wall clock: C's preparation, and drawing until it is finished. */
typedef struct {
    double prepare_ns, draw_ns;
} Cost;

/* Draws the shots' technique from any camera, for nothing but the time it takes. */
Cost shots_time(const Shots *shots, const Camera *camera);

typedef struct Table Table;

/* Adds a row of the tidy table for the technique and knob of the shots; view NULL where the figure belongs to
 * none. The value must be finite. */
void table_add(Table *table, const Shots *shots, const View *view, const char *metric, double value,
               const char *unit);

/* Adds a point to a curve that the report plots, a line for each technique, knob and view: y against x. The
 * names may hold no comma. */
void table_point(Table *table, const Shots *shots, const View *view, const char *curve, const char *x_name,
                 double x, const char *y_name, double y);

enum { TECHNIQUES_MAX = 12, VIEWS_MAX = 64, SCENES_MAX = 8, FACTS_MAX = 12, SAMPLES = 18, SCALE_MAX = 10 };

struct Scene {
    const char *name, *what;
    Technique techniques[TECHNIQUES_MAX]; /* the first is what costs are held against */
    View views[VIEWS_MAX];
    Vec3 background;
    /* Assets by file name; --colour and --height replace them. colour "": the scene makes its own, but takes
     * a user's file (of any kind), which its truth must not depend on. */
    const char *colour, *height;
    const char *other[2]; /* assets that cannot be replaced */
    Fact facts[FACTS_MAX];
    void (*list)(const Scene *scene); /* prints more lines for --list, two spaces in front; or NULL */
    int samples;                      /* rays a pixel of the truth; 0: SAMPLES */
    bool brief_extras; /* with --brief no rmse, psnr_db and max_abs of extra views: their exact pictures take
                          long */
    bool gaussian;     /* report against the Gaussian pixel filter too */
    Camera path[2];    /* for `flicker`, 16 frames from one to the other; none where both are 0 */
    void *(*load)(const Options *options); /* with the context current */
    void (*unload)(void *data);
    /* For the shader view_projection, model (identity), eye, eye_plane, knob, variant and size are set. */
    void (*draw)(const Frame *frame);
    /* What moves by itself (a light): called in a window alone, with the seconds that it has moved for, while
     * the space bar lets it. Pictures off-screen show it as loaded. NULL: all stands still. */
    void (*move)(void *data, double seconds);
    Sample (*truth)(const void *data, Ray ray);
    Vec2 (*texels)(
        const void *data); /* width and height of the texture that u and v are errors in; or NULL */
    void (*measure)(const Shots *shots, Table *table); /* the scene's own metrics; or NULL */
};

struct Lesson {
    const char *name, *title; /* name: the folder's, NN-name */
    Scene scenes[SCENES_MAX];
    int width, height; /* of pictures where --size does not say, not of windows; 0: 640x480 */
};

/* A lesson's main: reads the command line, does it, and returns the program's exit status. */
int lesson_run(const Lesson *lesson, int argc, char **argv);

/* The scale of a height map: --scale, or what its file says, or 0.1; the program ends if it is not 0 to
 * SCALE_MAX, where the truth's walk through the texels would take for ever. Its base: what the file says,
 * or 1. */
double options_scale(const Options *options, const Image *height);

/* How many techniques, views, scenes and knob values there are (a technique without a knob has one value, 0).
 */
int technique_count(const Scene *scene);
int view_count(const Scene *scene);
int scene_count(const Lesson *lesson);
int knob_count(const Technique *technique);

/* The rays a pixel of a scene's truth. */
int scene_samples(const Scene *scene);

#endif
