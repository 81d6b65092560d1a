/* What has been encoded as the textures that its shader reads. The context must be current. */
#ifndef LESSON_SHOWN_H
#define LESSON_SHOWN_H

#include "codec.h"
#include "draw.h"

typedef struct {
    Blocks blocks;
    Texture textures[PLANES_MAX];
    const char *names[PLANES_MAX]; /* of the samplers; NULL: there is none */
} Shown;

/* All planes must be whole. Ends the program with a line if OpenGL cannot hold them. shown_destroy frees it.
 */
Shown shown_create(const Encoded *encoded);
void shown_destroy(Shown *shown);

/* Binds them, and `across`, the blocks along u, v, s, t, for the program in use. */
void shown_bind(const Shown *shown, Program *program);

#endif
