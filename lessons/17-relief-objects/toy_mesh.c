#include "toy_mesh.h"

#include "fail.h"
#include "object.h"

#include <stdlib.h>
#include <string.h>

static void *grow(void *old, int count, int more, size_t size) {
    void *grown = realloc(old, ((size_t)count + more) * size);
    if (!grown) fail("out of memory");
    return grown;
}

/* Appends a part and destroys it. */
static void append(Mesh *mesh, Mesh part) {
    mesh->vertices = grow(mesh->vertices, mesh->vertex_count, part.vertex_count, sizeof *mesh->vertices);
    mesh->indices = grow(mesh->indices, mesh->index_count, part.index_count, sizeof *mesh->indices);
    memcpy(mesh->vertices + mesh->vertex_count, part.vertices, sizeof(Vertex) * part.vertex_count);
    for (int i = 0; i < part.index_count; i++)
        mesh->indices[mesh->index_count + i] = part.indices[i] + (uint32_t)mesh->vertex_count;
    mesh->vertex_count += part.vertex_count;
    mesh->index_count += part.index_count;
    mesh_destroy(&part);
}

/* A cylinder's end, seen from +y (up = 1) or from -y (-1). */
static Mesh disc(double radius, double y, int sides, int up) {
    Mesh mesh = {.vertex_count = sides + 1,
                 .index_count = 3 * sides,
                 .vertices = allocate((size_t)sides + 1, sizeof(Vertex)),
                 .indices = allocate((size_t)sides, 3 * sizeof(uint32_t))};
    for (int i = 0; i <= sides; i++) { /* the last is the middle */
        double angle = 2.0 * PI * i / sides - PI, r = i < sides ? radius : 0.0;
        mesh.vertices[i] = (Vertex){.position = {(float)(r * sin(angle)), (float)y, (float)(r * cos(angle))},
                                    .normal = {0, (float)up, 0}};
    }
    for (int i = 0; i < sides; i++) {
        uint32_t here = (uint32_t)i, next = (uint32_t)((i + 1) % sides);
        uint32_t triangle[] = {(uint32_t)sides, up > 0 ? here : next, up > 0 ? next : here};
        memcpy(mesh.indices + 3 * i, triangle, sizeof triangle);
    }
    return mesh;
}

static Mesh solid_mesh(const Solid *solid, int sides) {
    Vec3 size = solid->size;
    if (solid->kind == SOLID_BOX) return mesh_box(size.x, size.y, size.z);
    if (solid->kind == SOLID_SPHERE) return mesh_sphere(size.x / 2.0, sides, sides / 2);
    Mesh mesh = mesh_cylinder(size.x / 2.0, size.y, sides);
    append(&mesh, disc(size.x / 2.0, size.y / 2.0, sides, 1));
    append(&mesh, disc(size.x / 2.0, -size.y / 2.0, sides, -1));
    return mesh;
}

/* By degrees about x, then y, then z, as Solid has it. */
static Vec3 turned(Vec3 p, Vec3 degrees) {
    double x = radians(degrees.x), y = radians(degrees.y), z = radians(degrees.z);
    p = v3(p.x, p.y * cos(x) - p.z * sin(x), p.y * sin(x) + p.z * cos(x));
    p = v3(p.x * cos(y) + p.z * sin(y), p.y, p.z * cos(y) - p.x * sin(y));
    return v3(p.x * cos(z) - p.y * sin(z), p.x * sin(z) + p.y * cos(z), p.z);
}

static void set(float out[3], Vec3 v) {
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static void place(Mesh *mesh, const Solid *solid) {
    for (int i = 0; i < mesh->vertex_count; i++) {
        Vertex *vertex = &mesh->vertices[i];
        const float *p = vertex->position, *n = vertex->normal;
        set(vertex->position, vec3_add(turned(v3(p[0], p[1], p[2]), solid->turn_degrees), solid->centre));
        set(vertex->normal, turned(v3(n[0], n[1], n[2]), solid->turn_degrees));
        set(vertex->tangent, solid->colour);
        vertex->tangent[3] = 0.0f;
    }
}

Mesh toy_mesh(int sides) {
    Mesh mesh = {0};
    for (int i = 0; i < TOY_SOLIDS; i++) {
        Mesh part = solid_mesh(&toy_solids[i], sides);
        place(&part, &toy_solids[i]);
        append(&mesh, part);
    }
    return mesh;
}
