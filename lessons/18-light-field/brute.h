/* A light field by brute force: plain C, a ray at a time, every solid tried for every ray. What synthesis.h
 * is held against. It takes what is usual: floats, all cores, the solids moved once a block into the frame of
 * its rays, no division or root before a ray surely comes near a solid, and a normal and a colour for the
 * first solid alone. */
#ifndef LESSON_BRUTE_H
#define LESSON_BRUTE_H

#include "light_field.h"
#include "light_scene.h"

typedef struct Brute Brute;

/* Field and scene are kept by their addresses; brute_destroy frees it. */
Brute *brute_create(const Field *field, const LightScene *scene);
void brute_destroy(Brute *brute);

/* As synthesis_rows makes it with one ray a texel that begins on the model, without effects. */
void brute_rows(const Brute *brute, int first, int rows, uint8_t *texels);

#endif
