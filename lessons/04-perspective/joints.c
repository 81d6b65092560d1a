/* Building a surface with a T-joint, mending it, and counting its cracks. */
#include "joints.h"

#include "fail.h"

#include <stdlib.h>

/* ---- Building ---- */

static void add_triangle(Joint *joint, ClipVertex a, ClipVertex b, ClipVertex c) {
    ClipVertex *triangle = joint->triangles[joint->triangle_count++];
    triangle[0] = a, triangle[1] = b, triangle[2] = c;
}

typedef struct {
    SurfacePoint point;
    const void *context;
    int cells, other;  /* cells a side of this half and of the other */
    double edge, step; /* s on the outer edge of this half, and of a cell; the joint is at s = 1/2 */
    bool mended;
} Half;

/* The vertex in column i of 0..cells, counted from the outer edge, at t = j / of: a quotient of integers, so
 * that both halves compute the same t where they mean the same place. */
static ClipVertex half_vertex(const Half *half, int i, int j, int of) {
    double s = i == half->cells ? 0.5 : half->edge + i * half->step;
    return half->point(half->context, s, (double)j / of);
}

/* The triangle from a corner in the last column but one to the joint's edge j .. j + 1: if mended, in pieces
 * between the vertices of the other half that lie between, at k / other with j / cells < k / other. */
static void add_joint_triangle(Joint *joint, const Half *half, ClipVertex corner, int j) {
    ClipVertex last = half_vertex(half, half->cells, j, half->cells);
    int k = (int)((int64_t)j * half->other / half->cells) + 1;
    for (; half->mended && (int64_t)k * half->cells < (int64_t)(j + 1) * half->other; k++) {
        ClipVertex inserted = half_vertex(half, half->cells, k, half->other);
        add_triangle(joint, corner, last, inserted);
        last = inserted;
    }
    add_triangle(joint, corner, last, half_vertex(half, half->cells, j + 1, half->cells));
}

static void add_half(Joint *joint, const Half *half) {
    for (int j = 0; j < half->cells; j++)
        for (int i = 0; i < half->cells; i++) {
            ClipVertex a = half_vertex(half, i, j, half->cells), b = half_vertex(half, i + 1, j, half->cells);
            ClipVertex c = half_vertex(half, i, j + 1, half->cells);
            if (i + 1 < half->cells) {
                ClipVertex d = half_vertex(half, i + 1, j + 1, half->cells);
                add_triangle(joint, a, b, c);
                add_triangle(joint, b, d, c);
            } else {
                add_triangle(joint, a, b, c);
                add_joint_triangle(joint, half, c, j);
            }
        }
}

/* Counter-clockwise from s = t = 0. The joint's two ends are vertices of both halves. */
static void add_outline(Joint *joint, const Half *left, const Half *right) {
    ClipVertex *next = joint->outline;
    for (int i = 0; i < left->cells; i++) *next++ = half_vertex(left, i, 0, 1);
    for (int i = right->cells; i > 0; i--) *next++ = half_vertex(right, i, 0, 1);
    for (int j = 0; j < right->cells; j++) *next++ = half_vertex(right, 0, j, right->cells);
    for (int i = 0; i < right->cells; i++) *next++ = half_vertex(right, i, 1, 1);
    for (int i = left->cells; i > 0; i--) *next++ = half_vertex(left, i, 1, 1);
    for (int j = left->cells; j > 0; j--) *next++ = half_vertex(left, 0, j, left->cells);
    joint->outline_count = (int)(next - joint->outline);
}

Joint joint_create(int left, int right, bool mended, SurfacePoint point, const void *context) {
    if (left < 1 || left > 4096 || right < 1 || right > 4096) fail("a joint of %d and %d cells", left, right);
    Half a = {point, context, left, right, 0, 0.5 / left, mended};
    Half b = {point, context, right, left, 1, -0.5 / right, mended};
    size_t cells = (size_t)left * left + (size_t)right * right;
    Joint joint = {.triangles = allocate(2 * cells + left + right, sizeof *joint.triangles),
                   .outline = allocate(3 * (size_t)(left + right), sizeof *joint.outline)};
    add_half(&joint, &a);
    add_half(&joint, &b);
    add_outline(&joint, &a, &b);
    return joint;
}

void joint_destroy(Joint *joint) {
    free(joint->triangles);
    free(joint->outline);
    *joint = (Joint){0};
}

/* ---- Drawing and counting ---- */

void joint_draw(const Raster *raster, const Joint *joint) {
    for (int i = 0; i < joint->triangle_count; i++) raster_polygon(raster, joint->triangles[i], 3);
}

/* A fan over any outline, convex or not, draws a pixel an odd number of times inside and an even number
 * outside: where it overlaps itself, it does so in pairs. */
static void outline_draw(const Raster *raster, const Joint *joint) {
    const ClipVertex *outline = joint->outline;
    for (int i = 1; i + 1 < joint->outline_count; i++)
        raster_polygon(raster, (ClipVertex[]){outline[0], outline[i], outline[i + 1]}, 3);
}

Cracks joint_cracks(const Joint *joint, int width, int height, int dropped_bits) {
    size_t pixels = (size_t)width * height;
    uint16_t *drawn = allocate(pixels, sizeof *drawn), *mask = allocate(pixels, sizeof *mask);
    Raster raster = {width, height, .filling = FILL_PERSPECTIVE, .dropped_bits = dropped_bits,
                     .drawn = drawn};
    joint_draw(&raster, joint);
    raster.drawn = mask;
    outline_draw(&raster, joint);
    Cracks cracks = {0, 0, 0};
    for (size_t i = 0; i < pixels; i++) {
        bool inside = mask[i] % 2 == 1;
        cracks.inside += inside;
        cracks.missed += inside && drawn[i] == 0;
        cracks.doubled += drawn[i] > 1;
    }
    free(drawn);
    free(mask);
    return cracks;
}
