/* How a light-field texture is made: rays from the model's surface inward, for every texel.
 *
 * All rays of a block start at one point, and their directions are a grid of angles in its frame: so a solid
 * is met by a rectangle of that grid, and only that is tried, eight rays at a time. (Nine of ten rays of the
 * composed scene meet nothing.) Several rays a texel are spread over its cell of all four dimensions, each in
 * the frame of its own (u, v): each is one more block, seen from a point a part of a texel away.
 *
 * Rays a second, wherever they are told, count the rays of all texels, those that meet nothing too: not to
 * try them is what makes this fast. Writing the texels takes a small part of the time; the rest is
 * arithmetic. */
#ifndef TEXEL_SYNTHESIS_H
#define TEXEL_SYNTHESIS_H

#include "light_field.h"
#include "light_scene.h"

typedef struct Synthesis Synthesis;

/* samples: rays a texel, 1 (its centre) to SAMPLES_MOST. through: rays begin outside of everything, so that
 * what lies in front of the model is recorded on it too, as an eye far away sees it; else they begin on the
 * model. The field must not be refused; field and scene are kept by their addresses. synthesis_destroy frees
 * it. */
enum { SAMPLES_MOST = 4096 };
Synthesis *synthesis_create(const Field *field, const LightScene *scene, int samples, bool through);
void synthesis_destroy(Synthesis *synthesis);

/* The places of the samples in the cell of a texel, each of u, v, s, t in 0..1: a lattice of rank one
 * (N. M. Korobov 1959), sample i at the fraction parts of (2 i + 1) g / (2 samples), for g = 1, a, a^2, a^3.
 * So each axis alone has its samples evenly spaced, and all of them are symmetric about the centre: a picture
 * of few samples is not moved aside. Of all a that is taken which keeps the samples farthest from each other.
 * Writes `samples` places. */
typedef struct {
    double u, v, s, t;
} CellPlace;
void synthesis_places(int samples, CellPlace *places);

/* Makes the blocks of rows first to first + rows - 1 of v, on all cores: rows * field_row bytes into texels,
 * and, where depths is not NULL, for every texel (u fastest block, then t, then s, as texels) the mean
 * distance of what its rays met, INFINITY where that is nothing. */
void synthesis_rows(const Synthesis *synthesis, int first, int rows, uint8_t *texels, float *depths);

/* The linear light of all texels of one block, in their order, three numbers each: on this core alone. */
void synthesis_block(const Synthesis *synthesis, int u, int v, float *light);

/* The linear light of one texel alone, three numbers. (It takes as long as its block.) */
void synthesis_texel(const Synthesis *synthesis, int u, int v, int s, int t, float *light);

#endif
