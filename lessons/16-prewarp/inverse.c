#include "inverse.h"

#include "landing.h"
#include "light.h"

#include <string.h>

/* A line through the source for s of 0..1, from what is nearest to the eye on: x and y in texels with centres
 * at whole numbers, and the height h, falling from above the relief or rising to an eye behind it. */
typedef struct {
    double x, y, h, dx, dy, dh;
} Line;

/* The line of the destination's point (u_i, v_i), through all heights between the eye and the relief's far
 * end; false where nothing of the relief is in front of the eye. */
static bool line_through(const Source *source, const PrewarpFactors *k, Vec2 at, Line *line) {
    double near = k->behind ? 0.0 : 1.0, far = 1.0 - near;
    /* 1 + k3 d = LANDING_W_MIN is as near as the eye sees. */
    if (k->k3 != 0.0 && source->scale > 0.0) {
        double limit = (LANDING_W_MIN - 1.0) / k->k3 / source->scale + source->base;
        near = k->behind ? fmax(near, limit) : fmin(near, limit);
    }
    if (k->behind ? near >= far : near <= far) return false;
    double u_d = k->k3 * at.x - k->k1, v_d = k->k3 * at.y - k->k2;
    double d = source->scale * (near - source->base), range = source->scale * (far - near);
    *line = (Line){.x = (at.x + u_d * d) * source->width - 0.5,
                   .y = (at.y + v_d * d) * source->height - 0.5,
                   .h = near,
                   .dx = u_d * range * source->width,
                   .dy = v_d * range * source->height,
                   .dh = far - near};
    return true;
}

/* Narrows from..to, of s, to where a coordinate lies in the source: between half a texel before the first
 * centre and half a texel after the last. */
static void clip(double at, double rate, int count, double *from, double *to) {
    double low = -0.5, high = count - 0.5;
    if (rate == 0.0) {
        if (at < low || at > high) *to = -1.0;
        return;
    }
    double a = (low - at) / rate, b = (high - at) / rate;
    *from = fmax(*from, fmin(a, b));
    *to = fmin(*to, fmax(a, b));
}

/* The four texels around a point of the cell (column, row), the image being repeated, and their weights. */
typedef struct {
    size_t index[4];
    double weight[4];
} Corners;

static Corners corners_at(const Source *source, int column, int row, double x, double y) {
    int left = column < 0 ? source->width - 1 : column, bottom = row < 0 ? source->height - 1 : row;
    int right = left + 1 == source->width ? 0 : left + 1, top = bottom + 1 == source->height ? 0 : bottom + 1;
    size_t low = (size_t)bottom * source->width, high = (size_t)top * source->width;
    double a = x - column, b = y - row;
    return (Corners){{low + left, low + right, high + left, high + right},
                     {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
}

static double height_at(const Source *source, const Corners *corners) {
    double level = 0.0;
    for (int i = 0; i < 4; i++) level += corners->weight[i] * source->levels[corners->index[i]];
    return level / 65535.0;
}

/* How far the line is above the relief at s, seen from the eye's side, in the cell's own bilinear patch. */
static double clearance(const Source *source, const Line *line, int column, int row, double s) {
    Corners corners = corners_at(source, column, row, line->x + s * line->dx, line->y + s * line->dy);
    double above = line->h + s * line->dh - height_at(source, &corners);
    return line->dh > 0.0 ? -above : above;
}

/* Whether the line stays on the eye's side of all four of a cell's heights until s. */
static bool misses_cell(const Source *source, const Line *line, int column, int row, double until) {
    Corners corners = corners_at(source, column, row, 0.0, 0.0);
    double level = 65535.0 * (line->h + until * line->dh);
    bool misses = true;
    for (int i = 0; i < 4; i++) {
        double corner = source->levels[corners.index[i]];
        misses = misses && (line->dh > 0.0 ? level < corner : level > corner);
    }
    return misses;
}

/* The first t of 0..1 at which the quadratic with those values at 0, 1/2 and 1 is zero or below; 2 if none.
 */
static double first_zero(double start, double middle, double end) {
    if (start <= 0.0) return 0.0;
    double a = 2.0 * (start + end) - 4.0 * middle, b = end - start - a, square = b * b - 4.0 * a * start;
    if (square < 0.0) return end <= 0.0 ? 1.0 : 2.0;
    /* Of the roots 2 c / (-b +- sqrt) the positive one that comes first; this form has no cancellation. */
    double q = b < 0.0 ? -b + sqrt(square) : -b - sqrt(square);
    double one = 2.0 * start / q, two = a != 0.0 ? q / (2.0 * a) : -1.0;
    double first = one > 0.0 && (two <= 0.0 || one < two) ? one : two;
    if (first > 0.0 && first <= 1.0) return first;
    return end <= 0.0 ? 1.0 : 2.0;
}

/* When a coordinate reaches the far side of cell `cell`. */
static double leaving(double at, double rate, int cell) {
    return rate > 0.0 ? (cell + 1 - at) / rate : rate < 0.0 ? (cell - at) / rate : INFINITY;
}

/* The cell that a coordinate is in or, on a border, about to be in. */
static int cell_of(double at, double rate) { return rate < 0.0 ? (int)ceil(at) - 1 : (int)floor(at); }

/* Where the line first meets the relief: s, with its cell; false if it does not. */
static bool line_meets(const Source *source, const Line *line, double *s, int *column, int *row) {
    double from = 0.0, to = 1.0;
    clip(line->x, line->dx, source->width, &from, &to);
    clip(line->y, line->dy, source->height, &from, &to);
    if (!(from <= to)) return false;
    double x = line->x + from * line->dx, y = line->y + from * line->dy;
    *column = (int)clamp(cell_of(x, line->dx), -1, source->width - 1);
    *row = (int)clamp(cell_of(y, line->dy), -1, source->height - 1);
    if (clearance(source, line, *column, *row, from) < -1e-9) return false;
    while (*column >= -1 && *column < source->width && *row >= -1 && *row < source->height) {
        double s_x = leaving(line->x, line->dx, *column), s_y = leaving(line->y, line->dy, *row);
        double until = clamp(fmin(s_x, s_y), from, to);
        if (!misses_cell(source, line, *column, *row, until)) {
            double t = first_zero(clearance(source, line, *column, *row, from),
                                  clearance(source, line, *column, *row, 0.5 * (from + until)),
                                  clearance(source, line, *column, *row, until));
            *s = from + t * (until - from);
            if (t <= 1.0) return true;
        }
        if (until >= to) return false;
        from = until;
        if (s_x <= s_y) *column += line->dx > 0.0 ? 1 : -1;
        if (s_y <= s_x) *row += line->dy > 0.0 ? 1 : -1;
    }
    return false;
}

/* What is stored around a point, interpolated; colours in linear light. */
static Texel interpolate(const Source *source, const Corners *corners, const Light *light) {
    Vec3 colour = v3(0, 0, 0), normal = v3(0, 0, 0);
    for (int i = 0; i < 4; i++) {
        const Texel *texel = &source->texels[corners->index[i]];
        const uint8_t *c = texel->colour, *n = texel->normal;
        double weight = corners->weight[i];
        colour = vec3_add(
            colour, vec3_scale(v3(light->decoded[c[0]], light->decoded[c[1]], light->decoded[c[2]]), weight));
        normal = vec3_add(normal, vec3_scale(v3(n[0], n[1], n[2]), weight));
    }
    return (Texel){{light_encode(light, (float)colour.x), light_encode(light, (float)colour.y),
                    light_encode(light, (float)colour.z), 255},
                   {(uint8_t)(normal.x + 0.5), (uint8_t)(normal.y + 0.5), (uint8_t)(normal.z + 0.5), 0}};
}

void warp_inverse(const Source *source, const PrewarpFactors *factors, Destination *destination) {
    const size_t texels = (size_t)destination->width * destination->height;
    memset(destination->texels, 0, texels * sizeof(Texel));
    if (destination->lookup) memset(destination->lookup, 0, texels * 3 * sizeof(float));
    if (!factors->possible) return;
    const Light *light = light_tables();
    const Vec2 low = destination->low, high = destination->high;
    for (size_t i = 0; i < texels; i++) {
        double x = (double)(i % destination->width) + 0.5, y = (double)(i / destination->width) + 0.5;
        Vec2 at = v2(low.x + (high.x - low.x) * x / destination->width,
                     low.y + (high.y - low.y) * y / destination->height);
        Line line;
        double s;
        int column, row;
        if (!line_through(source, factors, at, &line) || !line_meets(source, &line, &s, &column, &row))
            continue;
        double u = line.x + s * line.dx, v = line.y + s * line.dy;
        Corners corners = corners_at(source, column, row, u, v);
        destination->texels[i] = interpolate(source, &corners, light);
        if (destination->lookup) {
            destination->lookup[3 * i] = (float)((u + 0.5) / source->width);
            destination->lookup[3 * i + 1] = (float)((v + 0.5) / source->height);
            destination->lookup[3 * i + 2] = (float)(line.h + s * line.dh);
        }
    }
}
