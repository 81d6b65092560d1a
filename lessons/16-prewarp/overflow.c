#include "overflow.h"

#include "depth_buffer.h"
#include "fail.h"
#include "landing.h"

#include <stdlib.h>
#include <string.h>

/* ---- Which edges ---- */

Displacements overflow_displacements(const Source *source) {
    int low = UINT16_MAX, high = 0;
    for (size_t i = 0; i < (size_t)source->width * source->height; i++) {
        low = source->levels[i] < low ? source->levels[i] : low;
        high = source->levels[i] > high ? source->levels[i] : high;
    }
    return (Displacements){source->scale * (low / 65535.0 - source->base),
                           source->scale * (high / 65535.0 - source->base)};
}

/* The part of a range that is in front of the eye: 1 + k3 d at least LANDING_W_MIN. False if none is. */
static bool clip_to_front(const PrewarpFactors *factors, Displacements *d) {
    double limit = factors->k3 == 0.0 ? 0.0 : (LANDING_W_MIN - 1.0) / factors->k3;
    if (factors->k3 < 0.0) d->high = fmin(d->high, limit);
    if (factors->k3 > 0.0) d->low = fmax(d->low, limit);
    return d->low <= d->high;
}

bool overflow_can(const PrewarpFactors *factors, Displacements d, Edge edge) {
    if (!factors->possible || !clip_to_front(factors, &d)) return false;
    double k = edge == EDGE_LEFT || edge == EDGE_RIGHT ? factors->k1 : factors->k2;
    double outward = edge == EDGE_LEFT || edge == EDGE_BOTTOM ? -k : k - factors->k3;
    return outward * d.low > 0.0 || outward * d.high > 0.0;
}

/* ---- Auxiliary polygons ---- */

Auxiliary auxiliary_create(const Source *source, Edge edge, bool lookup) {
    const Plane *plane = &source->plane;
    Displacements d = overflow_displacements(source);
    double low = fmin(d.low, 0.0), high = fmax(d.high, 0.0), texel = 1.0 / source->width;
    if (high - low < texel) low = high - texel;
    bool upright = edge == EDGE_LEFT || edge == EDGE_RIGHT; /* along v */
    Vec3 corner = plane->origin;
    if (edge == EDGE_RIGHT) corner = vec3_add(corner, plane->a);
    if (edge == EDGE_TOP) corner = vec3_add(corner, plane->b);
    Auxiliary auxiliary = {edge,
                           {.origin = vec3_add(corner, vec3_scale(plane->f, low)),
                            .a = upright ? plane->b : plane->a,
                            .b = vec3_scale(plane->f, high - low),
                            .f = upright ? plane->a : plane->b},
                           .destination = {0}};
    auxiliary.plane.f = vec3_normalize(auxiliary.plane.f);
    auxiliary.destination =
        destination_create(upright ? source->height : source->width,
                           (int)fmin(ceil((high - low) / texel), IMAGE_SIDE_MAX), v2(0, 0), v2(1, 1), lookup);
    return auxiliary;
}

void auxiliary_destroy(Auxiliary *auxiliary) { destination_destroy(&auxiliary->destination); }

typedef struct {
    const PrewarpFactors *factors;
    const LandedRow *below, *above; /* cell i lies between entries i - 1 and i of both */
    Destination *destination;
    int *nearest;  /* the nearest level that each destination texel saw, from either side; -1: none */
    double facing; /* the sign of the area of what the eye sees from its right side */
} Painter;

/* A corner of a triangle: which row, which entry. */
typedef struct {
    const LandedRow *row;
    int i;
} Corner;

static double x_of(Corner corner) { return corner.row->x[corner.i]; }
static double y_of(Corner corner) { return corner.row->y[corner.i]; }

/* Shows the mean of three corners, so weighted, if it is nearer than what is there: or nothing, from its
 * wrong side. */
static void show(const Painter *painter, const Corner corner[3], const double weight[3], bool right_side,
                 size_t at) {
    double colour[3] = {0}, normal[3] = {0}, lookup[3] = {0};
    for (int k = 0; k < 3; k++) {
        const LandedRow *row = corner[k].row;
        const Texel *texel = &row->texels[corner[k].i];
        for (int c = 0; c < 3; c++) {
            colour[c] += weight[k] * texel->colour[c];
            normal[c] += weight[k] * texel->normal[c];
        }
        lookup[0] += weight[k] * row->u[corner[k].i];
        lookup[1] += weight[k] * row->v;
        lookup[2] += weight[k] * row->levels[corner[k].i];
    }
    int level = (int)lookup[2], *nearest = &painter->nearest[at];
    if (*nearest >= 0 && !is_nearer(painter->factors, level, *nearest)) return;
    *nearest = level;
    Texel texel = {{0}, {0}};
    for (int c = 0; right_side && c < 3; c++) {
        texel.colour[c] = (uint8_t)(colour[c] + 0.5);
        texel.normal[c] = (uint8_t)(normal[c] + 0.5);
    }
    texel.colour[3] = right_side ? 255 : 0;
    painter->destination->texels[at] = texel;
    lookup[2] /= 65535.0;
    for (int k = 0; painter->destination->lookup && k < 3; k++)
        painter->destination->lookup[3 * at + k] = right_side ? (float)lookup[k] : 0.0f;
}

static double twice_area(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

/* The destination texels whose centres lie in a triangle, its edges included. */
static void paint_triangle(const Painter *painter, Corner a, Corner b, Corner c) {
    const Corner corner[3] = {a, b, c};
    const Destination *destination = painter->destination;
    double area = twice_area(x_of(b) - x_of(a), y_of(b) - y_of(a), x_of(c) - x_of(a), y_of(c) - y_of(a));
    double left = fmax(fmin(fmin(x_of(a), x_of(b)), x_of(c)), 0.0);
    double right = fmin(fmax(fmax(x_of(a), x_of(b)), x_of(c)), destination->width - 1.0);
    double bottom = fmax(fmin(fmin(y_of(a), y_of(b)), y_of(c)), 0.0);
    double top = fmin(fmax(fmax(y_of(a), y_of(b)), y_of(c)), destination->height - 1.0);
    if (area == 0.0 || !(left <= right) || !(bottom <= top)) return;
    for (int y = (int)ceil(bottom); y <= top; y++)
        for (int x = (int)ceil(left); x <= right; x++) {
            double weight[3];
            for (int k = 0; k < 3; k++) {
                Corner p = corner[(k + 1) % 3], q = corner[(k + 2) % 3];
                weight[k] = twice_area(x_of(p) - x, y_of(p) - y, x_of(q) - x, y_of(q) - y) / area;
            }
            if (weight[0] < 0.0 || weight[1] < 0.0 || weight[2] < 0.0) continue;
            show(painter, corner, weight, area * painter->facing > 0.0, (size_t)y * destination->width + x);
        }
}

static void paint_cells(const Painter *painter) {
    for (int i = 0; i <= painter->below->count; i++) {
        Corner p00 = {painter->below, i - 1}, p10 = {painter->below, i};
        Corner p01 = {painter->above, i - 1}, p11 = {painter->above, i};
        if (x_of(p00) == LANDING_NOWHERE || x_of(p10) == LANDING_NOWHERE || x_of(p01) == LANDING_NOWHERE ||
            x_of(p11) == LANDING_NOWHERE)
            continue;
        paint_triangle(painter, p00, p10, p11);
        paint_triangle(painter, p00, p11, p01);
    }
}

/* Lands a row on the other plane instead, with U, V and W of prewarp.h. What is as high as the eye is not
 * seen there either: beyond that height it is no longer d that tells what is nearer. */
static void land_elsewhere(const Source *source, const PrewarpMap *map, const Destination *destination,
                           LandedRow *row) {
    for (int i = -1; i <= row->count; i++) {
        double u = row->u[i], v = row->v, d = source->scale * (row->levels[i] / 65535.0 - source->base);
        double w = map->w[0] * u + map->w[1] * v + map->w[2] * d + map->w[3];
        double x = (map->u[0] * u + map->u[1] * v + map->u[2] * d + map->u[3]) / w * destination->width - 0.5;
        double y =
            (map->v[0] * u + map->v[1] * v + map->v[2] * d + map->v[3]) / w * destination->height - 0.5;
        bool somewhere = row->w[i] > (float)LANDING_W_MIN && w > 0.0 && fabs(x) < 0x1p20 && fabs(y) < 0x1p20;
        row->x[i] = somewhere ? (float)x : LANDING_NOWHERE;
        row->y[i] = somewhere ? (float)y : LANDING_NOWHERE;
    }
}

/* An upward piece of the relief runs around counter-clockwise in u and v. Seen from its right side it does so
 * on the other plane too, if that turns its own counter-clockwise side to the eye; and an eye behind the
 * source sees undersides. */
static double facing_sign(const Plane *target, Eye eye, const PrewarpFactors *factors) {
    Vec3 to_eye = vec3_sub(eye.at, vec3_scale(target->origin, eye.w));
    double side = vec3_dot(vec3_cross(target->a, target->b), to_eye);
    return (side > 0.0) == factors->behind ? -1.0 : 1.0;
}

void auxiliary_warp(const Source *source, Eye eye, Auxiliary *auxiliary) {
    Destination *destination = &auxiliary->destination;
    const size_t count = (size_t)destination->width * destination->height;
    memset(destination->texels, 0, count * sizeof(Texel));
    if (destination->lookup) memset(destination->lookup, 0, count * 3 * sizeof(float));
    PrewarpFactors factors = prewarp_factors(&source->plane, eye);
    PrewarpMap map = prewarp_map(&source->plane, &auxiliary->plane, eye);
    if (!factors.possible || !map.possible) return;

    Landing landing = landing_create(source, &factors, destination);
    LandedRow rows[2] = {landed_row_create(source->width), landed_row_create(source->width)};
    Painter painter = {.factors = &factors,
                       .destination = destination,
                       .nearest = allocate(count, sizeof *painter.nearest),
                       .facing = facing_sign(&auxiliary->plane, eye, &factors)};
    for (size_t i = 0; i < count; i++) painter.nearest[i] = -1;
    for (int y = -1; y <= source->height; y++) {
        LandedRow *row = &rows[y & 1];
        landing_row(&landing, source, y, row);
        land_elsewhere(source, &map, destination, row);
        painter.below = &rows[(y - 1) & 1], painter.above = row;
        if (y >= 0) paint_cells(&painter);
    }
    landed_row_destroy(&rows[0]);
    landed_row_destroy(&rows[1]);
    free(painter.nearest);
}

/* ---- An enlarged destination ---- */

/* Widens low..high to hold one coordinate of the eight corners, of which only four differ. */
static void widen(double k, double k3, Displacements d, double *low, double *high) {
    for (int corner = 0; corner < 4; corner++) {
        double s = corner & 1, displacement = corner & 2 ? d.high : d.low;
        double at = (s + k * displacement) / (1.0 + k3 * displacement);
        *low = fmin(*low, at);
        *high = fmax(*high, at);
    }
}

/* Outward to whole texels, with room for the rounding of a texel that lies on the border. */
static double round_outward(double at, int texels, bool up) {
    return up ? ceil(at * texels - 1e-9) / texels : floor(at * texels + 1e-9) / texels;
}

Bounds overflow_bounds(const Source *source, const PrewarpFactors *factors, double limit) {
    Displacements d = overflow_displacements(source);
    Bounds bounds = {v2(0, 0), v2(1, 1), true};
    if (!factors->possible || !clip_to_front(factors, &d)) return bounds;
    widen(factors->k1, factors->k3, d, &bounds.low.x, &bounds.high.x);
    widen(factors->k2, factors->k3, d, &bounds.low.y, &bounds.high.y);
    Bounds cut = {v2(fmax(bounds.low.x, -limit), fmax(bounds.low.y, -limit)),
                  v2(fmin(bounds.high.x, 1.0 + limit), fmin(bounds.high.y, 1.0 + limit)), true};
    cut.whole = cut.low.x == bounds.low.x && cut.low.y == bounds.low.y && cut.high.x == bounds.high.x &&
                cut.high.y == bounds.high.y;
    cut.low =
        v2(round_outward(cut.low.x, source->width, false), round_outward(cut.low.y, source->height, false));
    cut.high =
        v2(round_outward(cut.high.x, source->width, true), round_outward(cut.high.y, source->height, true));
    return cut;
}

Destination overflow_destination(const Source *source, const PrewarpFactors *factors, double limit,
                                 bool lookup) {
    int longest = source->width > source->height ? source->width : source->height;
    limit = fmin(limit, (IMAGE_SIDE_MAX / longest - 1) / 2); /* whole widths, so that rounding adds nothing */
    Bounds bounds = overflow_bounds(source, factors, limit);
    int width = (int)round((bounds.high.x - bounds.low.x) * source->width);
    int height = (int)round((bounds.high.y - bounds.low.y) * source->height);
    return destination_create(width, height, bounds.low, bounds.high, lookup);
}
