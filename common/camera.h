/* A camera: from a pixel to its ray, in doubles, and to GL's matrices, which come from the same numbers. */
#ifndef TEXEL_CAMERA_H
#define TEXEL_CAMERA_H

#include "vec.h"

#include <cglm/types.h>

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

/* Where the world's point p appears: the inverse of camera_ray, pixels from the lower left corner. Only for
 * points in front of a perspective eye. */
Vec2 camera_project(const Camera *camera, int width, int height, Vec3 p);

/* GL's matrices for the same picture (cglm's layout: column-major, floats computed from doubles). They need
 * near < far and, in perspective, 0 < near. */
void camera_matrices(const Camera *camera, int width, int height, mat4 view, mat4 projection);

/* The camera t of the way from a to b, two of one kind: every number interpolated linearly. */
Camera camera_mix(const Camera *a, const Camera *b, double t);

#endif
