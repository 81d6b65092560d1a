/* object DIR: turns the two objects of common/object.h into six relief textures each, by orthographic rays
 * from the faces of its box inward.
 *
 * Reads DIR/bunny.obj; writes DIR/solids-FACE.png and DIR/bunny-FACE.png, where FACE is left (-x), right
 * (+x), bottom (-y), top (+y), back (-z) or front (+z). The face's rectangle is the top of its relief: base
 * is 1, f points outward, and u and v lie as on mesh_box. A texel is what the ray from its centre meets
 * first; where it meets nothing, the height is 0, which is no surface.
 *
 * A relief is as deep as the box: half of that would do for an object without hollows, but from the top of
 * the bunny, past its neck, one sees its feet. A step of 16 bits is then 1/200 of a texel or
 * less. */
#include "fail.h"
#include "image.h"
#include "mesh_rays.h"
#include "object.h"
#include "parallel.h"

#include <stdio.h>
#include <stdlib.h>

enum { TEXELS = 256 };

/* A face by its directions: along u, along v, outward. */
typedef struct {
    const char *name;
    Vec3 right, up, outward;
} Face;

static const Face faces[] = {
    {"left", {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},   {"right", {0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
    {"bottom", {1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {"top", {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {"back", {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},  {"front", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
};
enum { FACES = sizeof faces / sizeof *faces };

/* An object is what a ray meets: its depth and colour there, or false. */
typedef struct {
    const char *name;
    Vec3 box;
    bool (*meet)(const MeshRays *rays, Ray ray, double *depth, Vec3 *colour);
    const MeshRays *rays; /* for the bunny's */
} Object;

static bool meet_toy(const MeshRays *rays, Ray ray, double *depth, Vec3 *colour) {
    (void)rays;
    SolidHit hit;
    if (!solids_hit(toy_solids, TOY_SOLIDS, ray, &hit)) return false;
    *depth = hit.depth;
    *colour = toy_colour(&toy_solids[hit.index], ray_at(ray, hit.depth));
    return true;
}

static bool meet_bunny(const MeshRays *rays, Ray ray, double *depth, Vec3 *colour) {
    MeshHit hit;
    if (!mesh_rays_hit(rays, ray, &hit)) return false;
    *depth = hit.depth;
    *colour = bunny_colour(ray_at(ray, hit.depth));
    return true;
}

/* ---- One face ---- */

typedef struct {
    const Object *object;
    Basis basis;
    double deep; /* world units */
    Image colour, height;
} Relief;

/* The box's face: its middle is half the box's size outward, its lower left corner half a side from there. */
static Relief relief_create(const Object *object, const Face *face) {
    Relief relief = {.object = object,
                     .basis = {.a = vec3_multiply(face->right, object->box),
                               .b = vec3_multiply(face->up, object->box),
                               .f = face->outward},
                     .colour = image_create(TEXELS, TEXELS, 3),
                     .height = image_create(TEXELS, TEXELS, 1)};
    Vec3 outward = vec3_multiply(face->outward, object->box),
         sides = vec3_add(relief.basis.a, relief.basis.b);
    relief.basis.origin = vec3_scale(vec3_sub(outward, sides), 0.5);
    relief.deep = vec3_length(outward);
    relief.height.basis = relief.basis;
    relief.height.scale = relief.deep / vec3_length(relief.basis.a);
    relief.height.base = 1.0;
    relief.height.hollow = true;
    return relief;
}

static void relief_destroy(Relief *relief) {
    image_destroy(&relief->colour);
    image_destroy(&relief->height);
}

static void cast_row(void *context, int y) {
    Relief *relief = context;
    const Basis *basis = &relief->basis;
    for (int x = 0; x < TEXELS; x++) {
        Vec3 across = vec3_scale(basis->a, (x + 0.5) / TEXELS), up = vec3_scale(basis->b, (y + 0.5) / TEXELS);
        Ray ray = {vec3_add(basis->origin, vec3_add(across, up)), vec3_scale(basis->f, -1.0)};
        double depth;
        Vec3 colour;
        if (!relief->object->meet(relief->object->rays, ray, &depth, &colour)) continue;
        double h = 1.0 - depth / relief->deep;
        bool border = x == 0 || y == 0 || x == TEXELS - 1 || y == TEXELS - 1;
        if (!(h > 0.0 && h < 1.0) || border) fail("%s: it does not fit its box", relief->object->name);
        *image_at(&relief->height, x, y) = (float)h;
        float *texel = image_at(&relief->colour, x, y);
        texel[0] = (float)colour.x, texel[1] = (float)colour.y, texel[2] = (float)colour.z;
    }
}

/* ---- Colours where nothing was met ---- */

/* The mean colour of the texels around (x, y) that have one; false if none has. */
static bool mean_around(const Image *colour, const bool *coloured, int x, int y, float mean[3]) {
    int count = 0;
    mean[0] = mean[1] = mean[2] = 0.0f;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            if (i < 0 || j < 0 || i >= TEXELS || j >= TEXELS || !coloured[j * TEXELS + i]) continue;
            for (int k = 0; k < 3; k++) mean[k] += image_at(colour, i, j)[k];
            count++;
        }
    for (int k = 0; k < 3; k++) mean[k] /= (float)(count ? count : 1);
    return count > 0;
}

/* The object's colours go on for so many texels beyond its outline, so that a filter there mixes in no black.
 */
static void extend_colours(Relief *relief, int texels) {
    bool *coloured = allocate(TEXELS * TEXELS, 1), *before = allocate(TEXELS * TEXELS, 1);
    for (int i = 0; i < TEXELS * TEXELS; i++) coloured[i] = relief->height.pixels[i] > 0.0f;
    for (int n = 0; n < texels; n++) {
        for (int i = 0; i < TEXELS * TEXELS; i++) before[i] = coloured[i];
        for (int i = 0; i < TEXELS * TEXELS; i++) {
            float mean[3];
            if (before[i] || !mean_around(&relief->colour, before, i % TEXELS, i / TEXELS, mean)) continue;
            for (int k = 0; k < 3; k++) relief->colour.pixels[3 * i + k] = mean[k];
            coloured[i] = true;
        }
    }
    free(coloured);
    free(before);
}

/* ---- */

/* Prints a face's name, and how much of it is covered. */
static void make_reliefs(const Object *object, const char *folder) {
    printf("%s: box %.6f x %.6f x %.6f\n", object->name, object->box.x, object->box.y, object->box.z);
    for (int i = 0; i < FACES; i++) {
        Relief relief = relief_create(object, &faces[i]);
        parallel_for(TEXELS, cast_row, &relief);
        extend_colours(&relief, 4);
        int covered = 0;
        for (int k = 0; k < TEXELS * TEXELS; k++) covered += relief.height.pixels[k] > 0.0f;
        printf("%-8s %.2f %% covered\n", faces[i].name, 100.0 * covered / (TEXELS * TEXELS));
        char *path = text("%s/%s-%s.png", folder, object->name, faces[i].name);
        const char *refused = image_write_relief(&relief.colour, &relief.height, path, 16);
        if (refused) fail("%s: %s", path, refused);
        free(path);
        relief_destroy(&relief);
    }
}

int main(int argc, char **argv) {
    if (argc != 2) fail_usage("usage: object DIR");
    Object toy = {.name = "solids", .box = toy_box, .meet = meet_toy};
    make_reliefs(&toy, argv[1]);

    char *path = text("%s/bunny.obj", argv[1]);
    Object bunny = {.name = "bunny", .meet = meet_bunny};
    Mesh mesh = bunny_load(path, &bunny.box);
    MeshRays *rays = mesh_rays_create(&mesh);
    bunny.rays = rays;
    make_reliefs(&bunny, argv[1]);
    mesh_rays_destroy(rays);
    mesh_destroy(&mesh);
    free(path);
    return 0;
}
