/* The two objects of the relief objects: one of solids, exact by its formula, and the Stanford bunny, a mesh.
 * What makes their textures (assets/object.c) and what judges the pictures see them through this file. Each
 * lies around the origin within a box, of which it keeps a margin: a ray along an edge of the box meets
 * nothing. Up is +y; the front is toward +z, where the bunny shows its flank: it looks toward -x. */
#ifndef TEXEL_OBJECT_H
#define TEXEL_OBJECT_H

#include "mesh.h"
#include "solid.h"

/* Of the toy, no point is hidden from all six directions of the axes, but for a ring 0.0006 wide on the body
 * around the sphere in front, whose widest circle lies 0.02 before it. */
enum { TOY_SOLIDS = 8 };
extern const Solid toy_solids[TOY_SOLIDS];
extern const Vec3 toy_box; /* its box's width, height and depth */

/* Linear light, where the solid has its surface at that position: its colour in a checker with soft edges, in
 * three dimensions. */
Vec3 toy_colour(const Solid *solid, Vec3 position);

/* The bunny out of the file bunny.obj, two units wide, for mesh_destroy, and its box. Ends the program if the
 * file cannot be read. */
Mesh bunny_load(const char *path, Vec3 *box);

/* Soft bands, in linear light, for the bunny has no colour of its own. */
Vec3 bunny_colour(Vec3 position);

#endif
