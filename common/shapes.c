/* Where a ray meets each of the exact shapes: see truth.h. */
#include "truth.h"

Vec3 truth_colour(const Image *image, double u, double v) {
    double c[4];
    image_sample(image, u, v, c);
    return image->channels < 3 ? v3(c[0], c[0], c[0]) : v3(c[0], c[1], c[2]);
}

Sample truth_plane(Ray ray, double width, double height) {
    double t = -ray.origin.z / ray.direction.z; /* not finite for a ray within the plane */
    Vec3 p = ray_at(ray, t);
    double u = p.x / width + 0.5, v = p.y / height + 0.5;
    bool hit = t >= 0.0 && u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0; /* false for what is not a number */
    return hit ? (Sample){.u = u, .v = v, .depth = t, .hit = true} : (Sample){0};
}

/* The smaller root first; false where there is none. Of a x^2 + b x + c, without cancellation: the root
 * of larger magnitude is q / a with q = -(b + sign(b) sqrt(disc)) / 2, and the product of both is c / a. */
static bool quadratic(double a, double b, double c, double roots[2]) {
    double discriminant = b * b - 4.0 * a * c;
    if (!(discriminant >= 0.0)) return false;
    double q = -0.5 * (b + copysign(sqrt(discriminant), b));
    double first = q / a, second = c / q;
    if (a == 0.0) first = second; /* linear: one root, twice */
    if (q == 0.0) second = first; /* b = 0 and c = 0: a double root at 0, or no equation at all */
    if (isnan(first)) return false;
    roots[0] = fmin(first, second);
    roots[1] = fmax(first, second);
    return true;
}

Sample truth_cylinder(Ray ray, double radius, double height) {
    Vec3 o = ray.origin, d = ray.direction;
    double roots[2];
    if (!quadratic(d.x * d.x + d.z * d.z, 2.0 * (o.x * d.x + o.z * d.z),
                   o.x * o.x + o.z * o.z - radius * radius, roots))
        return (Sample){0};
    for (int i = 0; i < 2; i++) {
        Vec3 p = ray_at(ray, roots[i]);
        double v = p.y / height + 0.5;
        if (roots[i] >= 0.0 && v >= 0.0 && v <= 1.0)
            return (Sample){.u = (atan2(p.x, p.z) + PI) / (2.0 * PI), .v = v, .depth = roots[i], .hit = true};
    }
    return (Sample){0};
}

/* ---- The relief ---- */

/* A ray in the relief's own terms: after t world units from its start it is at (x, y), in texels with the
 * texel centres at whole numbers, and at height h. */
typedef struct {
    double x, y, h, dx, dy, dh;
} Path;

/* A cell between four texel centres, by the columns and rows of its corners, wrapped into the image; x0 and
 * y0 are also where its lower left corner is along the path, unwrapped. */
typedef struct {
    long x0, y0;
    int left, right, bottom, top;
} Cell;

static int wrap(long i, int size) {
    int rest = (int)(i % size);
    return rest < 0 ? rest + size : rest;
}

static Cell cell_at(const Image *height, double x, double y) {
    Cell cell = {.x0 = (long)floor(x), .y0 = (long)floor(y)};
    cell.left = wrap(cell.x0, height->width), cell.right = wrap(cell.x0 + 1, height->width);
    cell.bottom = wrap(cell.y0, height->height), cell.top = wrap(cell.y0 + 1, height->height);
    return cell;
}

/* One step to a neighbour along an axis: its corners low and high, in an image of that size. */
static void step(long *at, int *low, int *high, int size, bool forward) {
    *at += forward ? 1 : -1;
    if (forward) {
        *low = *high;
        *high = *high + 1 == size ? 0 : *high + 1;
    } else {
        *high = *low;
        *low = *low == 0 ? size - 1 : *low - 1;
    }
}

/* The first t in from..to at which the path is at or below the bilinear patch of a cell, or a negative
 * number. With a = x - x0 and b = y - y0 the patch is c0 + c1 a + c2 b + c3 a b; along the path that is
 * quadratic in t. */
static double patch_hit(const Image *height, const Path *path, const Cell *cell, double from, double to) {
    const float *low = height->pixels + (size_t)cell->bottom * height->width;
    const float *high = height->pixels + (size_t)cell->top * height->width;
    double h00 = low[cell->left], h10 = low[cell->right], h01 = high[cell->left], h11 = high[cell->right];
    double lowest = path->h + to * path->dh; /* the path only sinks */
    if (lowest > h00 && lowest > h10 && lowest > h01 && lowest > h11) return -1.0;
    double c0 = h00, c1 = h10 - h00, c2 = h01 - h00, c3 = h11 - h10 - h01 + h00;
    double a = path->x + from * path->dx - (double)cell->x0, b = path->y + from * path->dy - (double)cell->y0;
    double above = path->h + from * path->dh - (c0 + c1 * a + c2 * b + c3 * a * b);
    if (above <= 0.0) return from;
    double slope = path->dh - (c1 * path->dx + c2 * path->dy + c3 * (a * path->dy + b * path->dx));
    double roots[2];
    if (!quadratic(-c3 * path->dx * path->dy, slope, above, roots)) return -1.0;
    for (int k = 0; k < 2; k++)
        if (roots[k] >= 0.0 && roots[k] <= to - from) return from + roots[k];
    return -1.0;
}

/* When a coordinate that is at `at` for t = 0 and moves by `rate` reaches the far side of cell i. */
static double leaving_time(double at, double rate, long i) {
    if (rate > 0.0) return ((double)(i + 1) - at) / rate;
    if (rate < 0.0) return ((double)i - at) / rate;
    return INFINITY;
}

/* The cells in their order along the path from t = `from` on, until the surface is met; at height 0 it must
 * have been. A negative number if the path is longer than `to` before that. */
static double walk(const Image *height, const Path *path, double from, double to) {
    double bottom = -path->h / path->dh, end = fmin(bottom, to), t = from;
    Cell cell = cell_at(height, path->x + t * path->dx, path->y + t * path->dy);
    while (t < end) {
        double tx = leaving_time(path->x, path->dx, cell.x0), ty = leaving_time(path->y, path->dy, cell.y0);
        double leave = clamp(tx < ty ? tx : ty, t, end);
        double hit = patch_hit(height, path, &cell, t, leave);
        if (hit >= 0.0) return hit;
        t = leave;
        if (tx <= ty) step(&cell.x0, &cell.left, &cell.right, height->width, path->dx > 0.0);
        if (ty <= tx) step(&cell.y0, &cell.bottom, &cell.top, height->height, path->dy > 0.0);
    }
    return bottom <= to ? bottom : -1.0;
}

/* Narrows from..to, times along a coordinate that is `at` for t = 0 and moves by `rate`, to low..high of it.
 */
static void clip(double at, double rate, double low, double high, double *from, double *to) {
    if (rate == 0.0) {
        if (at < low || at > high) *to = -INFINITY;
        return;
    }
    double a = (low - at) / rate, b = (high - at) / rate;
    *from = fmax(*from, fmin(a, b));
    *to = fmin(*to, fmax(a, b));
}

static double path_above(const Image *height, const Path *path, double t) {
    double h;
    image_sample(height, (path->x + t * path->dx + 0.5) / height->width,
                 (path->y + t * path->dy + 0.5) / height->height, &h);
    return path->h + t * path->dh - h;
}

Sample truth_relief(const Relief *relief, Ray ray) {
    double depth = relief->width * relief->scale, height = relief->width * relief->aspect;
    Sample window = truth_plane(ray, relief->width, height);
    if (!(ray.direction.z < 0.0) || (!window.hit && relief->extent != RELIEF_SLAB)) return (Sample){0};
    if (depth == 0.0) return window;
    /* The walk starts where the ray enters the layer of heights 0..1, or at the eye if that is within it. */
    double start = fmax(0.0, (depth * (1.0 - relief->base) - ray.origin.z) / ray.direction.z);
    Vec3 p = ray_at(ray, start), d = ray.direction;
    const Image *image = relief->height;
    Path path = {.x = (p.x / relief->width + 0.5) * image->width - 0.5,
                 .y = (p.y / height + 0.5) * image->height - 0.5,
                 .h = p.z / depth + relief->base,
                 .dx = d.x / relief->width * image->width,
                 .dy = d.y / height * image->height,
                 .dh = d.z / depth};
    double from = 0.0, to = INFINITY;
    if (relief->extent != RELIEF_REPEATED) {
        clip(path.x, path.dx, -0.5, image->width - 0.5, &from, &to);
        clip(path.y, path.dy, -0.5, image->height - 0.5, &from, &to);
        /* Where it enters at height 1, and the surface is as high, rounding must not put it below. */
        if (from > to || path_above(image, &path, from) < -1e-9) return (Sample){0};
    }
    double t = walk(image, &path, from, to);
    if (t < 0.0) return (Sample){0};
    return (Sample){.u = (path.x + t * path.dx + 0.5) / image->width,
                    .v = (path.y + t * path.dy + 0.5) / image->height,
                    .depth = start + t,
                    .hit = true};
}

Vec3 truth_relief_normal(const Relief *relief, double u, double v) {
    const Image *image = relief->height;
    double x = u * image->width - 0.5, y = v * image->height - 0.5;
    Cell cell = cell_at(image, x, y);
    double a = x - (double)cell.x0, b = y - (double)cell.y0;
    double h00 = *image_at(image, cell.left, cell.bottom), h10 = *image_at(image, cell.right, cell.bottom);
    double h01 = *image_at(image, cell.left, cell.top), h11 = *image_at(image, cell.right, cell.top);
    double along_u = ((h10 - h00) * (1.0 - b) + (h11 - h01) * b) * image->width;
    double along_v = ((h01 - h00) * (1.0 - a) + (h11 - h10) * a) * image->height / relief->aspect;
    return vec3_normalize(v3(-relief->scale * along_u, -relief->scale * along_v, 1.0));
}
