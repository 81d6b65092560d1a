/* The toy of solids as triangles, to be drawn beside its reliefs. */
#ifndef LESSON_TOY_MESH_H
#define LESSON_TOY_MESH_H

#include "mesh.h"

/* All solids, whole, each round in `sides` columns. What is a tangent elsewhere is the solid's colour (linear
 * light), and 0. The caller destroys the mesh. */
Mesh toy_mesh(int sides);

#endif
