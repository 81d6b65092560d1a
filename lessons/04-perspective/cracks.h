/* The scenes joints and levels: two halves of one surface, split differently, and the joint where they meet.
 */
#ifndef LESSON_CRACKS_H
#define LESSON_CRACKS_H

#include "lesson.h"

/* joints: a square of side 1 around the origin in the plane z = 0, its left half in 5 x 5 cells, its right
 * half in 7 x 7. */
#define JOINTS 5, 7

/* levels: part of a cylinder of radius 1 around the y axis, ARC_DEGREES of it around +z, y in -1/2..1/2. s
 * grows with the angle from +z toward +x, t with y, 0..1 each. Below the joint at y = 0 are 8 flat faces (in
 * 8 rows), above it 4 (in 4). */
#define LEVELS 8, 4
#define ARC_DEGREES 80.0

/* Scene callbacks, see lesson.h. */
void *cracks_load_joints(const Options *options);
void *cracks_load_levels(const Options *options);
void cracks_unload(void *data);
Sample cracks_truth(const void *data, Ray ray);
void cracks_measure(const Shots *shots, Table *table);

/* Technique callback. Missed pixels keep the background; doubled ones are drawn blue, for where a surface is
 * opaque nobody would see them. The technique's knob is the number of places a pixel, in x and in y, that a
 * vertex can snap to: 1..256, a power of two. */
enum { CRACKED, MENDED };
void cracks_paint(const Frame *frame, Picture *picture);

#endif
