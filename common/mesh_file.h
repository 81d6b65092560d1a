/* Meshes out of Wavefront's .obj files: text, of which the lines "v x y z" (a vertex) and "f a b c ..." (a
 * face, by the numbers of its vertices, counted from 1) are read, and all others passed over. */
#ifndef TEXEL_MESH_FILE_H
#define TEXEL_MESH_FILE_H

#include "mesh.h"

/* Reads a file. A face of more than three corners becomes a fan of triangles; what follows a corner's number
 * after a slash is passed over, and a negative number counts back from the last vertex. A normal is the mean
 * of the triangles' around its vertex, weighted by their areas; tangents and (u, v) are 0. NULL when all went
 * well, else the reason, without the file's name, valid until the next call in this thread; mesh is then left
 * as it was. Refused: what cannot be read, a line that is longer than any should be or no text, numbers that
 * are missing, no numbers or not finite, corners that name no vertex so far, no triangle at all, and more
 * than 2^24 vertices or triangles. */
const char *mesh_read(Mesh *mesh, const char *path);

/* The same, ending the program with "PATH: reason" instead of returning one. */
Mesh mesh_load(const char *path);

#endif
