/* A lesson in a window. */
#ifndef TEXEL_WINDOW_H
#define TEXEL_WINDOW_H

#include "measure.h"

/* Opens a window that begins with the choice's scene, technique, knob, view and size, and returns when it is
 * closed. With no display it ends the program with a line that names --render. */
void window_run(const Lesson *lesson, const Options *options, const Choice *choice);

#endif
