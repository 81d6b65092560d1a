#include "mesh_file.h"

#include "fail.h"
#include "vec.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERTICES_MAX = 1 << 24, INDICES_MAX = 3 << 24, LINE_MAX_CHARACTERS = 4096 };

/* Makes room for one item more than count, which has grown one by one: in powers of two. */
static void *with_room(void *items, int count, size_t size) {
    if (count & (count - 1)) return items;
    items = realloc(items, (count ? 2 * (size_t)count : 1) * size);
    if (!items) fail("out of memory for a mesh of %d vertices or indices", count);
    return items;
}

/* Whether a number ended where it should, so that 1.5 is no integer and 1x no number. */
static bool is_ended(const char *at, const char *end, const char *stops) {
    return end != at && (!*end || isspace((unsigned char)*end) || strchr(stops, *end));
}

static const char *add_vertex(Mesh *mesh, const char *at) {
    if (mesh->vertex_count == VERTICES_MAX) return "too many vertices";
    Vertex vertex = {0};
    for (int i = 0; i < 3; i++) {
        char *end;
        double value = strtod(at, &end);
        if (!is_ended(at, end, "")) return "a vertex without three numbers";
        if (!(fabs(value) <= FLT_MAX)) return "a vertex that is not finite";
        vertex.position[i] = (float)value;
        at = end;
    }
    mesh->vertices = with_room(mesh->vertices, mesh->vertex_count, sizeof(Vertex));
    mesh->vertices[mesh->vertex_count++] = vertex;
    return NULL;
}

static void add_index(Mesh *mesh, uint32_t index) {
    mesh->indices = with_room(mesh->indices, mesh->index_count, sizeof(uint32_t));
    mesh->indices[mesh->index_count++] = index;
}

static const char *add_face(Mesh *mesh, const char *at) {
    uint32_t first = 0, previous = 0;
    int corners = 0;
    for (at += strspn(at, " \t\r\n"); *at; at += strspn(at, " \t\r\n"), corners++) {
        char *end;
        long number = strtol(at, &end, 10);
        if (!is_ended(at, end, "/")) return "a corner that is no number";
        if (number < 0) number += mesh->vertex_count + 1L;
        if (number < 1 || number > mesh->vertex_count) return "a corner that names no vertex so far";
        uint32_t index = (uint32_t)(number - 1);
        if (corners >= 2) {
            if (mesh->index_count == INDICES_MAX) return "too many triangles";
            add_index(mesh, first), add_index(mesh, previous), add_index(mesh, index);
        }
        if (corners == 0) first = index;
        previous = index;
        at = end + strcspn(end, " \t\r\n");
    }
    return corners < 3 ? "a face of fewer than three corners" : NULL;
}

static Vec3 position(const Mesh *mesh, uint32_t vertex) {
    const float *p = mesh->vertices[vertex].position;
    return v3(p[0], p[1], p[2]);
}

/* The cross product of two sides is the normal times twice the area, so that a sum of them is weighted. */
static void make_normals(Mesh *mesh) {
    Vec3 *sums = allocate((size_t)mesh->vertex_count, sizeof *sums);
    for (int i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *corners = mesh->indices + i;
        Vec3 a = position(mesh, corners[0]);
        Vec3 ab = vec3_sub(position(mesh, corners[1]), a), ac = vec3_sub(position(mesh, corners[2]), a);
        for (int k = 0; k < 3; k++) sums[corners[k]] = vec3_add(sums[corners[k]], vec3_cross(ab, ac));
    }
    for (int i = 0; i < mesh->vertex_count; i++) {
        /* A vertex of no triangle, or of two back to back, has no normal: any will do. */
        Vec3 normal = vec3_length(sums[i]) > 0.0 ? vec3_normalize(sums[i]) : v3(0, 1, 0);
        float *n = mesh->vertices[i].normal;
        n[0] = (float)normal.x, n[1] = (float)normal.y, n[2] = (float)normal.z;
    }
    free(sums);
}

/* Reads the lines of an open file; *number is the last one's. */
static const char *read_lines(Mesh *mesh, FILE *file, int *number) {
    char line[LINE_MAX_CHARACTERS];
    for (*number = 1; fgets(line, sizeof line, file); ++*number) {
        if (!strchr(line, '\n') && !feof(file)) return "too long, or no text";
        const char *refused = !strncmp(line, "v ", 2)   ? add_vertex(mesh, line + 2)
                              : !strncmp(line, "f ", 2) ? add_face(mesh, line + 2)
                                                        : NULL;
        if (refused) return refused;
    }
    if (ferror(file)) return strerror(errno);
    return mesh->index_count ? NULL : "the end, and no triangle so far";
}

const char *mesh_read(Mesh *mesh, const char *path) {
    static _Thread_local char reason[128];
    FILE *file = fopen(path, "r");
    if (!file) return strerror(errno);
    Mesh read = {0};
    int number;
    const char *refused = read_lines(&read, file, &number);
    fclose(file);
    if (refused) {
        mesh_destroy(&read);
        snprintf(reason, sizeof reason, "line %d: %s", number, refused);
        return reason;
    }
    make_normals(&read);
    *mesh = read;
    return NULL;
}

Mesh mesh_load(const char *path) {
    Mesh mesh;
    const char *refused = mesh_read(&mesh, path);
    if (refused) fail("%s: %s", path, refused);
    return mesh;
}
