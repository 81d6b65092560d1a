/* A camera: from a pixel to its ray, in doubles, and to GL's matrices, which come from the same numbers. */
#ifndef TEXEL_CAMERA_H
#define TEXEL_CAMERA_H

#include "vec.h"

#include <cglm/types.h>
#include <stdbool.h>

typedef struct {
    Vec3 eye, target, up; /* right-handed, y up; up need only not be parallel to the view */
    double fov_y_degrees; /* the full vertical angle of a perspective camera; 0 makes it orthographic, */
    double height;        /* with this much of the world from bottom to top */
    double near, far;     /* distances of the clipping planes along the view, for GL alone */
} Camera;

/* The ray through the point (x, y) of a picture of width x height pixels, measured in pixels from its lower
 * left corner: pixel (i, j) has its centre at (i + 0.5, j + 0.5). Perspective rays start at the eye,
 * orthographic ones in the plane through the eye. */
Ray camera_ray(const Camera *camera, int width, int height, double x, double y);

/* The same for many points of one picture: all that does not depend on the point, worked out once. */
typedef struct {
    bool perspective;
    Vec3 fixed;             /* what all rays share: their origin in perspective, else their direction */
    Vec3 middle, right, up; /* of what they do not: its value in the middle, and what a pixel adds to it */
    double half_width, half_height; /* of the picture, in pixels */
} Rays;

Rays camera_rays(const Camera *camera, int width, int height);

static inline Ray rays_at(const Rays *rays, double x, double y) {
    Vec3 aside = vec3_scale(rays->right, x - rays->half_width);
    Vec3 own = vec3_add(rays->middle, vec3_add(aside, vec3_scale(rays->up, y - rays->half_height)));
    return rays->perspective ? (Ray){rays->fixed, vec3_normalize(own)} : (Ray){own, rays->fixed};
}

/* Where the world's point p appears: the inverse of camera_ray, pixels from the lower left corner. Only for
 * points in front of a perspective eye. */
Vec2 camera_project(const Camera *camera, int width, int height, Vec3 p);

/* GL's matrices for the same picture (cglm's layout: column-major, floats computed from doubles). They need
 * near < far and, in perspective, 0 < near. */
void camera_matrices(const Camera *camera, int width, int height, mat4 view, mat4 projection);

/* The camera t of the way from a to b, two of one kind: every number interpolated linearly. */
Camera camera_mix(const Camera *a, const Camera *b, double t);

/* Moves the eye around the target, by angles in radians: to the right about the camera's up, and up, but not
 * over the poles. */
void camera_orbit(Camera *camera, double right, double up);

/* Moves eye and target together, to the right and up, by parts of the height that the picture shows of the
 * world at the target. */
void camera_pan(Camera *camera, double right, double up);

/* Makes what is at the target look `factor` times as large: by coming nearer, or where that changes nothing,
 * in an orthographic picture, by showing less of the world. */
void camera_nearer(Camera *camera, double factor);

#endif
