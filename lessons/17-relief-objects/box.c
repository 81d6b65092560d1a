#include "box.h"

#include "fail.h"
#include "image.h"

#include <stdlib.h>
#include <string.h>

const char *const face_names[FACES] = {"front", "right", "top", "back", "left", "bottom"};

Vec3 face_point(const Face *face, double u, double v, double d) {
    const Plane *plane = &face->plane;
    Vec3 along = vec3_add(vec3_scale(plane->a, u), vec3_scale(plane->b, v));
    return vec3_add(plane->origin, vec3_add(along, vec3_scale(plane->f, d)));
}

/* ---- Loading ---- */

/* The path with its last "front" replaced. */
static char *path_of(const char *path, int face) {
    const char *last = NULL, *name = strrchr(path, '/');
    for (const char *at = name ? name : path; (at = strstr(at, face_names[0])); at++) last = at;
    if (!last) fail("%s: the name of the first of six reliefs must hold \"%s\"", path, face_names[0]);
    return text("%.*s%s%s", (int)(last - path), path, face_names[face], last + strlen(face_names[0]));
}

/* A face's plane is that of its file's basis: a x b must point out of the box, as f does. */
static Plane plane_of(const Image *height, const char *path) {
    const Basis *basis = &height->basis;
    if (isnan(basis->a.x)) fail("%s: says not where it lies: it is no relief texture with a basis", path);
    if (!height->hollow) fail("%s: is not hollow, so it is no object's", path);
    if (isnan(height->scale) || height->base != 1.0) fail("%s: its base must be 1 and its scale said", path);
    Plane plane = {basis->origin, basis->a, basis->b, vec3_normalize(basis->f)};
    Vec3 normal = vec3_normalize(vec3_cross(plane.a, plane.b));
    if (vec3_dot(normal, plane.f) < 1.0 - 1e-6)
        fail("%s: f of its basis must be along a x b, out of the box", path);
    return plane;
}

static void face_load(Face *face, const char *path, Texel **texels, size_t *count) {
    Image height = image_load(path, IMAGE_HEIGHT), colour = image_load(path, IMAGE_COLOUR);
    *face = (Face){.plane = plane_of(&height, path), .width = height.width, .height = height.height};
    size_t own = (size_t)face->width * face->height;
    if (face->width < 2 || face->height < 2) fail("%s: a face has at least 2x2 texels", path);
    if (*count + own > UINT32_MAX) fail("%s: these are more texels than 32 bits count", path);
    face->first = (uint32_t)*count;
    face->d = allocate(own + ROW - 1, sizeof *face->d);
    *texels = realloc(*texels, (*count + own) * sizeof **texels);
    if (!*texels) fail("out of memory");
    double range = height.scale * vec3_length(face->plane.a);
    for (size_t i = 0; i < own; i++) {
        Texel *texel = &(*texels)[*count + i];
        for (int k = 0; k < 3; k++)
            texel->values[k] = (uint16_t)lround(65535.0 * clamp(colour.pixels[3 * i + k], 0.0, 1.0));
        texel->values[3] = 65535;
        face->d[i] = height.pixels[i] > 0.0f ? (float)(range * (height.pixels[i] - 1.0)) : NAN;
    }
    *count += own;
    image_destroy(&height);
    image_destroy(&colour);
}

/* How far the corners of a face reach above the plane of another at most: 0 where they share a side. */
static double rise_above(const Face *face, const Face *other) {
    double rise = -INFINITY;
    for (int i = 0; i < 4; i++) {
        Vec3 corner = face_point(face, i & 1, i >> 1, 0.0);
        rise = fmax(rise, vec3_dot(vec3_sub(corner, other->plane.origin), other->plane.f));
    }
    return rise;
}

/* Opposite faces look opposite ways, the others at right angles and meet at a side. */
static void check_box(const Box *box, const char *path) {
    for (int i = 0; i < FACES; i++) {
        for (int k = 0; k < FACES; k++) {
            if (k == i) continue;
            const Face *face = &box->faces[i], *other = &box->faces[k];
            bool opposite = abs(i - k) == OPPOSITE;
            double cosine = vec3_dot(face->plane.f, other->plane.f);
            double gap = rise_above(face, other), little = 1e-6 * vec3_length(other->plane.a);
            bool fits = opposite ? gap < 0.0 : fabs(gap) <= little;
            if (fabs(cosine - (opposite ? -1.0 : 0.0)) > 1e-6 || !fits)
                fail("%s: its face and the other five are no box's", path);
        }
    }
}

void box_load(Box *box, const char *path, Walls walls) {
    *box = (Box){.texels = allocate(1, sizeof *box->texels), .texel_count = 1};
    for (int i = 0; i < FACES; i++) {
        char *own = path_of(path, i);
        face_load(&box->faces[i], own, &box->texels, &box->texel_count);
        free(own);
    }
    check_box(box, path);
    box_find_surfaces(box, walls);
}

void box_destroy(Box *box) {
    for (int i = 0; i < FACES; i++) {
        Face *face = &box->faces[i];
        free(face->d);
        free(face->cells);
        free(face->rims);
        free(face->tiles);
    }
    free(box->texels);
    *box = (Box){0};
}

/* ---- Seen from an eye ---- */

/* From a point to the eye; a direction for one infinitely far. */
static Vec3 toward(Eye eye, Vec3 point) {
    return eye.w > 0.0 ? vec3_sub(vec3_scale(eye.at, 1.0 / eye.w), point) : eye.at;
}

/* Those faces that have the eye on one side. */
static Seen faces_with(const Box *box, Eye eye, bool inside) {
    Seen seen = {.inside = inside};
    for (int i = 0; i < FACES; i++) {
        Vec3 way = toward(eye, box->faces[i].plane.origin);
        double height = vec3_dot(way, box->faces[i].plane.f) * (inside ? -1.0 : 1.0);
        if (height > 1e-6 * vec3_length(way)) seen.faces[seen.count++] = i;
    }
    return seen;
}

Seen box_faces_seen(const Box *box, Eye eye) {
    Seen seen = faces_with(box, eye, false);
    return seen.count ? seen : faces_with(box, eye, true);
}

/* A triangle with normal n at p faces away where n.(eye - p) <= 0. As seen from the sphere's centre the eye
 * is within asin(radius / distance) of where any p sees it, so all face away when the angle between `facing`
 * and the eye, less that and the spread, is still a right one. */
bool tile_faces_away(const Tile *tile, Eye eye) {
    Vec3 way = toward(eye, tile->centre);
    double distance = vec3_length(way), parallax = 0.0;
    if (eye.w > 0.0) {
        if (distance <= tile->radius) return false;
        parallax = asin(tile->radius / distance);
    }
    double slack = tile->spread + parallax;
    return slack < PI / 2 && vec3_dot(tile->facing, way) <= -sin(slack) * distance;
}
