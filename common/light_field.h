/* A light-field texture T(u, v, s, t): for each point (u, v) of a simple model, the light that leaves it in
 * each direction (s, t) of its outer hemisphere. What it was made of lies behind the model's surface; the
 * model is a window onto it. This is the "2+2D texture" of A. Y. Gonçalves Dias and M. K. Zuffo, "2+2D
 * Texture for Full Positive Parallax Effect", 2024 (arXiv 2402.16815).
 *
 * Here: its parametrization in doubles (Eq. 3 to 5), and how its texels lie in memory. Texel i of n of an
 * axis is at (i + 0.5) / n. */
#ifndef TEXEL_LIGHT_FIELD_H
#define TEXEL_LIGHT_FIELD_H

#include "vec.h"

#include <stdbool.h>

#include <stddef.h>
#include <stdint.h>

/* The model, around the origin. A normal at each point is all that is asked of one. */
typedef enum {
    FIELD_SPHERE,   /* seen from outside */
    FIELD_CYLINDER, /* the side of a cylinder around the y axis, open at both ends */
    FIELD_ROOM,     /* a sphere around the observer, whose normals point inward: a panorama */
} FieldModel;

/* How an angle a of -90..90 degrees becomes 0..1. */
typedef enum {
    ANGLES_LINEAR,       /* (a + 90) / 180, the paper's */
    ANGLES_SINE,         /* (sin a + 1) / 2: finer around the normal */
    ANGLES_STEREOGRAPHIC /* (tan(a/2) + 1) / 2: coarser around the normal */
} FieldAngles;

typedef struct {
    FieldModel model;
    FieldAngles angles;
    double radius, height; /* height: the cylinder's */
    int u, v, s, t;        /* texels along each axis */
} Field;

enum {
    FIELD_LEAST = 8,        /* texels along an axis; u, which half a turn must be whole texels of, is even */
    FIELD_MOST = 1024,      /* u and v, */
    FIELD_MOST_ANGLES = 256 /* s and t */
};

/* Why a field cannot be of that size, or NULL. */
const char *field_refused(const Field *field);

/* Reads a size such as 512x256x32x32 into u, v, s and t; NULL, or why that is none or is refused. */
const char *field_size(Field *field, const char *text);

/* Prints it for a lesson's --list. */
void field_list(const Field *field);

/* A point of the model and its local frame (Eq. 4): e_z is the normal, toward the observer's side; e_x = y x
 * e_z / |y x e_z|, and at the poles, where that is 0 / 0, its limit along the meridian; e_y = e_z x e_x. */
typedef struct {
    Vec3 at, e_x, e_y, e_z;
} FieldFrame;

/* The point (u, v) and its frame: Eq. 3 solved for P. On the sphere u = (theta + 180) / 360 with theta from
 * +z toward +x, v = (phi + 90) / 180; on the cylinder v runs along its height. */
FieldFrame field_frame(const Field *field, double u, double v);

/* The (u, v) of a point (Eq. 3), wherever along the line through the model's centre or axis it lies. */
Vec2 field_place(const Field *field, Vec3 p);

/* The unit vector of (s, t) in a frame, and back: Eq. 5 as s = angle(atan2(d.e_x, d.e_z)), t =
 * angle(atan2(d.e_y, hypot(d.e_x, d.e_z))). Where d.e_z < 0, s is beyond 0..1 (sine: folded, so clamped). */
Vec3 field_direction(const Field *field, const FieldFrame *frame, double s, double t);
Vec2 field_angles(const Field *field, const FieldFrame *frame, Vec3 d);

/* The four texels around (u, v), first the lower left, with what each counts. u goes around; a row below
 * v = 0 or above v = 1 of a sphere is the outermost row, half a turn on; a cylinder's rows end. */
typedef struct {
    int u[4], v[4];
    double weight[4];
} FieldCell;
FieldCell field_cell(const Field *field, double u, double v);

/* In memory and in files a texel is three bytes of sRGB, and a block is all directions of one point, row t by
 * row: texel (u, v, s, t) is number ((v nu + u) nt + t) ns + s. */
enum { FIELD_TEXEL = 3 };
static inline size_t field_block(const Field *field) { return (size_t)field->s * field->t * FIELD_TEXEL; }
static inline size_t field_row(const Field *field) { return field_block(field) * field->u; }
static inline size_t field_bytes(const Field *field) { return field_row(field) * field->v; }

#endif
