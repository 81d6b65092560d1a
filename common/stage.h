/* A scene on the stage: loaded, with its programs built, ready to be drawn by any technique from any camera.
 * What pictures, measurements and the window share. */
#ifndef TEXEL_STAGE_H
#define TEXEL_STAGE_H

#include "lesson.h"

typedef struct Stage {
    const Lesson *lesson;
    const Scene *scene;
    Options options;
    void *data;
    Truth truth;
    char *folder, *common, *cache;    /* of the lesson's shaders, of common's, of the exact pictures */
    Program programs[TECHNIQUES_MAX]; /* built when first used */
    Target plain, full;               /* without and with a lookup; made when first used */
} Stage;

/* The project's folder (the one with lessons/ in it, at or above the program's own place), and a path in it;
 * the caller frees the path. */
const char *project_folder(void);
char *project_path(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Loads a scene; the context must be current. The options' paths are completed here. */
Stage stage_open(const Lesson *lesson, const Scene *scene, const Options *options);
void stage_close(Stage *stage);

Frame stage_frame(const Stage *stage, const Technique *technique, double knob, const View *view, int width,
                  int height);

/* Draws the frame into a picture that has its size; the lookup too if the picture has one. */
void stage_draw(Stage *stage, const Frame *frame, Picture *picture);

/* Draws the frame without a lookup and without copying it out: the wall clock around C's preparation, and
 * around the finished frame. scratch: of the frame's size, without a lookup, for techniques that paint. */
Cost stage_time(Stage *stage, const Frame *frame, Picture *scratch);

/* Builds all programs anew from their files. NULL, or the log of the first that failed, which the caller
 * frees; of those that failed the last good ones stay in use. */
char *stage_reload(Stage *stage);

/* A number that changes when a shader's file does, or comes, or goes. */
uint64_t stage_stamp(const Stage *stage);

#endif
