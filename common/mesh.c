#include "mesh.h"

#include "fail.h"
#include "vec.h"

#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>

/* A grid of columns x rows cells that is to join a mesh. Which of the numbers count, its function knows. */
typedef struct {
    int columns, rows;
    double radius, height;  /* of what is round */
    Vec3 left, right, up;   /* of what is flat: its lower corners, and the way from lower to upper edge */
    double u_left, u_right; /* u at those corners */
} Patch;

/* Empty, with room for so many patches of one size. */
static Mesh mesh_create(int patches, int columns, int rows) {
    if ((int64_t)columns * rows > INT_MAX / 6 / patches)
        fail("mesh: %d x %d x %d cells are too many", patches, columns, rows);
    size_t vertices = (size_t)patches * (columns + 1) * (rows + 1), cells = (size_t)patches * columns * rows;
    return (Mesh){.vertices = allocate(vertices, sizeof(Vertex)),
                  .indices = allocate(6 * cells, sizeof(uint32_t))};
}

void mesh_destroy(Mesh *mesh) {
    free(mesh->vertices);
    free(mesh->indices);
    *mesh = (Mesh){0};
}

/* w is +1, for in all these shapes u grows to the right and v upward as seen from outside. */
static Vertex vertex(Vec3 position, Vec3 normal, Vec3 tangent, double u, double v) {
    return (Vertex){.position = {(float)position.x, (float)position.y, (float)position.z},
                    .normal = {(float)normal.x, (float)normal.y, (float)normal.z},
                    .tangent = {(float)tangent.x, (float)tangent.y, (float)tangent.z, 1.0f},
                    .uv = {(float)u, (float)v}};
}

static bool same_place(const Mesh *mesh, uint32_t a, uint32_t b) {
    const float *p = mesh->vertices[a].position, *q = mesh->vertices[b].position;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/* Adds a triangle, unless two of its corners are in one place, as at a pole. */
static void triangle_add(Mesh *mesh, uint32_t a, uint32_t b, uint32_t c) {
    if (same_place(mesh, a, b) || same_place(mesh, b, c) || same_place(mesh, c, a)) return;
    mesh->indices[mesh->index_count++] = a;
    mesh->indices[mesh->index_count++] = b;
    mesh->indices[mesh->index_count++] = c;
}

/* Adds a patch, of which `at` makes the vertex to the left of the column and below the row. */
static void patch_add(Mesh *mesh, const Patch *patch, Vertex (*at)(const Patch *, int column, int row)) {
    uint32_t first = (uint32_t)mesh->vertex_count, stride = (uint32_t)patch->columns + 1;
    for (int j = 0; j <= patch->rows; j++)
        for (int i = 0; i <= patch->columns; i++) mesh->vertices[mesh->vertex_count++] = at(patch, i, j);
    for (int j = 0; j < patch->rows; j++)
        for (int i = 0; i < patch->columns; i++) {
            uint32_t below = first + (uint32_t)j * stride + (uint32_t)i, above = below + stride;
            triangle_add(mesh, below, below + 1, above + 1);
            triangle_add(mesh, below, above + 1, above);
        }
}

/* ---- Flat patches: plane, prism, box ---- */

static Vertex flat_at(const Patch *patch, int column, int row) {
    double s = (double)column / patch->columns, t = (double)row / patch->rows;
    Vec3 along = vec3_sub(patch->right, patch->left);
    /* Weights of 1 and 0 give the corners exactly, which left + s along would not: neighbours must meet. */
    Vec3 below = vec3_add(vec3_scale(patch->left, 1.0 - s), vec3_scale(patch->right, s));
    double u = (1.0 - s) * patch->u_left + s * patch->u_right;
    return vertex(vec3_add(below, vec3_scale(patch->up, t)), vec3_normalize(vec3_cross(along, patch->up)),
                  vec3_normalize(along), u, t);
}

Mesh mesh_plane(double width, double height, int columns, int rows) {
    if (!(width > 0.0 && height > 0.0) || columns < 1 || rows < 1)
        fail("mesh_plane: no plane has %g x %g in %d x %d cells", width, height, columns, rows);
    Patch patch = {.columns = columns,
                   .rows = rows,
                   .left = v3(-width / 2.0, -height / 2.0, 0.0),
                   .right = v3(width / 2.0, -height / 2.0, 0.0),
                   .up = v3(0.0, height, 0.0),
                   .u_right = 1.0};
    Mesh mesh = mesh_create(1, columns, rows);
    patch_add(&mesh, &patch, flat_at);
    return mesh;
}

Mesh mesh_box(double width, double height, double depth) {
    if (!(width > 0.0 && height > 0.0 && depth > 0.0))
        fail("mesh_box: no box has %g x %g x %g", width, height, depth);
    static const Vec3 faces[6][3] = {
        /* left, right, up, in halves of the box's size */
        {{-1, -1, +1}, {+1, -1, +1}, {0, 2, 0}},  /* toward +z */
        {{+1, -1, +1}, {+1, -1, -1}, {0, 2, 0}},  /* toward +x */
        {{+1, -1, -1}, {-1, -1, -1}, {0, 2, 0}},  /* toward -z */
        {{-1, -1, -1}, {-1, -1, +1}, {0, 2, 0}},  /* toward -x */
        {{-1, +1, +1}, {+1, +1, +1}, {0, 0, -2}}, /* the top */
        {{-1, -1, -1}, {+1, -1, -1}, {0, 0, +2}}  /* the bottom */
    };
    Vec3 half = v3(width / 2.0, height / 2.0, depth / 2.0);
    Mesh mesh = mesh_create(6, 1, 1);
    for (int i = 0; i < 6; i++) {
        Patch patch = {.columns = 1,
                       .rows = 1,
                       .left = vec3_multiply(half, faces[i][0]),
                       .right = vec3_multiply(half, faces[i][1]),
                       .up = vec3_multiply(half, faces[i][2]),
                       .u_right = 1.0};
        patch_add(&mesh, &patch, flat_at);
    }
    return mesh;
}

/* ---- Round ones: theta = 2 pi u - pi, from +z toward +x ---- */

/* The way from the axis to column i of n, of length one. The last column is the first again, bit for bit. */
static Vec3 outward(double i, int n) {
    double theta = 2.0 * PI * fmod(i, n) / n - PI;
    return v3(sin(theta), 0.0, cos(theta));
}

/* The way in which theta grows there: outward's derivative. */
static Vec3 around(Vec3 out) { return v3(out.z, 0.0, -out.x); }

static Vertex cylinder_at(const Patch *patch, int column, int row) {
    Vec3 out = outward(column, patch->columns), position = vec3_scale(out, patch->radius);
    double v = (double)row / patch->rows;
    position.y = (v - 0.5) * patch->height;
    return vertex(position, out, around(out), (double)column / patch->columns, v);
}

Mesh mesh_cylinder(double radius, double height, int sides) {
    if (!(radius > 0.0 && height > 0.0) || sides < 3)
        fail("mesh_cylinder: no cylinder has radius %g, height %g and %d sides", radius, height, sides);
    Patch patch = {.columns = sides, .rows = 1, .radius = radius, .height = height};
    Mesh mesh = mesh_create(1, sides, 1);
    patch_add(&mesh, &patch, cylinder_at);
    return mesh;
}

Mesh mesh_prism(double radius, double height, int sides) {
    if (!(radius > 0.0 && height > 0.0) || sides < 3)
        fail("mesh_prism: no prism has radius %g, height %g and %d sides", radius, height, sides);
    Vec3 down = v3(0.0, -height / 2.0, 0.0);
    Mesh mesh = mesh_create(sides, 1, 1);
    for (int i = 0; i < sides; i++) {
        Patch patch = {.columns = 1,
                       .rows = 1,
                       .left = vec3_add(vec3_scale(outward(i, sides), radius), down),
                       .right = vec3_add(vec3_scale(outward(i + 1, sides), radius), down),
                       .up = v3(0.0, height, 0.0),
                       .u_left = (double)i / sides,
                       .u_right = (i + 1.0) / sides};
        patch_add(&mesh, &patch, flat_at);
    }
    return mesh;
}

/* At a pole every column is in one place, so half of that row's triangles vanish. Those that stay use the
 * left vertex of their cell at the bottom and the right one at the top (see patch_add); half a column moves
 * it to the cell's middle. One vertex at each pole is left without a triangle. */
static Vertex sphere_at(const Patch *patch, int column, int row) {
    bool bottom = row == 0, top = row == patch->rows;
    double i = bottom ? column + 0.5 : top ? column - 0.5 : column, v = (double)row / patch->rows;
    double latitude = PI * (v - 0.5), ring = bottom || top ? 0.0 : cos(latitude); /* cos(PI / 2) is not 0 */
    Vec3 out = outward(i, patch->columns), normal = v3(ring * out.x, sin(latitude), ring * out.z);
    return vertex(vec3_scale(normal, patch->radius), normal, around(out), i / patch->columns, v);
}

Mesh mesh_sphere(double radius, int columns, int rows) {
    if (!(radius > 0.0) || columns < 3 || rows < 2)
        fail("mesh_sphere: no sphere has radius %g in %d x %d cells", radius, columns, rows);
    Patch patch = {.columns = columns, .rows = rows, .radius = radius};
    Mesh mesh = mesh_create(1, columns, rows);
    patch_add(&mesh, &patch, sphere_at);
    return mesh;
}
