#include "object.h"

#include "mesh_file.h"

#include <float.h>

/* A body with something else on each of its faces, so that none is mistaken for another. */
const Solid toy_solids[TOY_SOLIDS] = {
    {SOLID_BOX, {1.3, 1.1, 1.2}, {0, -0.05, 0}, {0, 0, 0}, {0.75, 0.42, 0.12}},
    {SOLID_CYLINDER, {0.7, 0.7, 0}, {-0.15, 0.45, 0.1}, {0, 0, 0}, {0.15, 0.35, 0.7}}, /* a tower */
    {SOLID_SPHERE, {0.6, 0, 0}, {-0.15, 0.7, 0.1}, {0, 0, 0}, {0.7, 0.12, 0.1}},       /* its dome */
    {SOLID_SPHERE, {0.8, 0, 0}, {0.6, -0.1, 0.1}, {0, 0, 0}, {0.2, 0.55, 0.15}},       /* right */
    {SOLID_CYLINDER, {0.6, 0.66, 0}, {-0.63, 0, -0.1}, {0, 0, 90}, {0.6, 0.55, 0.12}}, /* left */
    {SOLID_SPHERE, {0.7, 0, 0}, {0.15, 0, 0.62}, {0, 0, 0}, {0.5, 0.15, 0.5}},         /* in front */
    {SOLID_BOX, {0.55, 0.55, 0.7}, {-0.1, -0.1, -0.6}, {0, 0, 30}, {0.1, 0.5, 0.5}},   /* behind */
    {SOLID_CYLINDER, {1, 0.45, 0}, {0, -0.725, 0}, {0, 0, 0}, {0.45, 0.45, 0.5}},      /* the foot */
};
const Vec3 toy_box = {2.1, 2.06, 2.02};

/* From -1 to 1 and back, once in `length`. */
static double wave(double x, double length) { return sin(2.0 * PI * x / length); }

Vec3 toy_colour(const Solid *solid, Vec3 position) {
    const double check = 0.22, start = 0.11; /* so that no face of the body lies between two layers */
    double sides = wave(position.x - start, 2 * check) * wave(position.y - start, 2 * check) *
                   wave(position.z - start, 2 * check);
    return vec3_scale(solid->colour, 0.75 + 0.25 * clamp(4.0 * sides, -1.0, 1.0));
}

/* ---- The bunny ---- */

Mesh bunny_load(const char *path, Vec3 *box) {
    Mesh mesh = mesh_load(path);
    Vec3 low = v3(DBL_MAX, DBL_MAX, DBL_MAX), high = vec3_scale(low, -1.0);
    for (int i = 0; i < mesh.vertex_count; i++) {
        const float *p = mesh.vertices[i].position;
        low = v3(fmin(low.x, p[0]), fmin(low.y, p[1]), fmin(low.z, p[2]));
        high = v3(fmax(high.x, p[0]), fmax(high.y, p[1]), fmax(high.z, p[2]));
    }
    Vec3 middle = vec3_mix(low, high, 0.5), size = vec3_sub(high, low);
    double scale = 2.0 / size.x;
    for (int i = 0; i < mesh.vertex_count; i++) {
        float *p = mesh.vertices[i].position;
        Vec3 q = vec3_scale(vec3_sub(v3(p[0], p[1], p[2]), middle), scale);
        p[0] = (float)q.x, p[1] = (float)q.y, p[2] = (float)q.z;
    }
    *box = vec3_add(vec3_scale(size, scale), v3(0.06, 0.06, 0.06));
    return mesh;
}

Vec3 bunny_colour(Vec3 position) {
    Vec3 fur = v3(0.55, 0.38, 0.22), band = v3(0.8, 0.74, 0.62);
    double bent = position.y + 0.1 * wave(position.x, 1.0) + 0.1 * wave(position.z, 0.8);
    return vec3_mix(fur, band, 0.5 + 0.5 * wave(bent, 0.25));
}
