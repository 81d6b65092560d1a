/* Triangle meshes, made with what texturing needs at each vertex. Sizes are in world units and above zero; a
 * size or a number of cells below its minimum, or more indices than an int counts, ends the program. Where
 * patches meet, and at the seams, the positions are the same floats, so that nothing shows between them. */
#ifndef TEXEL_MESH_H
#define TEXEL_MESH_H

#include <stdint.h>

/* As GL reads it. tangent.xyz is the unit direction in which u grows; the bitangent, in which v grows, is
 * tangent.w * cross(normal, tangent.xyz), with w = +1 or -1. */
typedef struct {
    float position[3], normal[3], tangent[4], uv[2];
} Vertex;

typedef struct {
    int vertex_count, index_count;
    Vertex *vertices;  /* owned, as the indices are: mesh_destroy frees both */
    uint32_t *indices; /* three a triangle, counter-clockwise seen from where the normal points */
} Mesh;

/* The rectangle of width x height (world units) around the origin in the plane z = 0: x = +u, y = +v, z = the
 * normal, u and v over 0..1. columns x rows cells, each at least 1, of two triangles. */
Mesh mesh_plane(double width, double height, int columns, int rows);

/* The side of a cylinder around the y axis: radius, height (y from -height/2), in `sides` (at least 3) flat
 * faces, each with its own normal; open at both ends. A corner lies on the cylinder, at the angle theta =
 * 2 pi u - pi, measured from +z toward +x (the seam is at -z); u runs linearly along each face from corner to
 * corner, v upward over 0..1. */
Mesh mesh_prism(double radius, double height, int sides);

/* The same shape with the cylinder's own normals at the corners. */
Mesh mesh_cylinder(double radius, double height, int sides);

/* A sphere around the origin: u is the angle from +z toward +x over 0..1 from -pi to pi (the seam is at -z),
 * v the latitude over 0..1 from -pi/2 to pi/2. columns at least 3, rows at least 2. No triangle is
 * degenerate: the poles' rows are single triangles, each with a pole vertex of its own whose u is the middle
 * of its column. */
Mesh mesh_sphere(double radius, int columns, int rows);

/* An axis-aligned box around the origin with six faces, each with u and v over 0..1 and normals outward. On
 * the sides v grows with y and u to the right as seen from outside; on the top u grows with x and v with -z,
 * on the bottom u with x and v with z. */
Mesh mesh_box(double width, double height, double depth);

void mesh_destroy(Mesh *mesh);

#endif
