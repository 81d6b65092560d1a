/* The command line that makes a picture again. */
#ifndef TEXEL_COMMAND_H
#define TEXEL_COMMAND_H

#include "lesson.h"

/* Prints it on standard output, as a line for a shell: the frame's scene, technique, knob, view and size, and
 * the user's own images. camera: by its numbers, or NULL where the frame's view has the name of a scene's. */
void command_print(const Frame *frame, const Camera *camera, const Options *options);

/* Reads a camera as command_print writes it (see --help). False if it is none. */
bool command_camera(const char *argument, Camera *camera);

#endif
