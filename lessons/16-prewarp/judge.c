#include "judge.h"

#include "fail.h"
#include "parallel.h"

#include <stdlib.h>

/* ---- The source's texels, projected ---- */

static Vec3 relief_point(const Source *source, const Plane *plane, double u, double v, double h) {
    Vec3 along = vec3_add(vec3_scale(plane->a, u), vec3_scale(plane->b, v));
    return vec3_add(plane->origin, vec3_add(along, vec3_scale(plane->f, source->scale * (h - source->base))));
}

/* From the eye toward a point: from the eye itself, or from two units above all of the relief. */
static Ray line_of_sight(const Source *source, Eye eye, Vec3 point) {
    if (eye.w > 0.0) {
        Vec3 origin = vec3_scale(eye.at, 1.0 / eye.w);
        return (Ray){origin, vec3_normalize(vec3_sub(point, origin))};
    }
    double rise = fabs(source->scale) * 2.0 + 2.0;
    Vec3 origin = vec3_add(point, vec3_scale(eye.at, rise / eye.at.z));
    return (Ray){origin, vec3_normalize(vec3_scale(eye.at, -1.0))};
}

/* Whether the eye is above the polygon's plane, beyond rounding: only there has the truth anything to say. */
static bool is_above(Eye eye) { return eye.at.z > 1e-9 * vec3_length(eye.at); }

/* Where the ray meets a plane, in its texture coordinates; false if that is not in front of the ray's origin.
 */
static bool ray_meets(Ray ray, const Plane *plane, Vec2 *at) {
    Vec3 normal = vec3_cross(plane->a, plane->b);
    double t = vec3_dot(vec3_sub(plane->origin, ray.origin), normal) / vec3_dot(ray.direction, normal);
    if (!(t > 0.0 && t < INFINITY)) return false;
    Vec3 q = vec3_sub(ray_at(ray, t), plane->origin);
    Vec3 across_b = vec3_cross(plane->b, normal), across_a = vec3_cross(plane->a, normal);
    *at = v2(vec3_dot(q, across_b) / vec3_dot(plane->a, across_b),
             vec3_dot(q, across_a) / vec3_dot(plane->b, across_a));
    return true;
}

static Relief relief_of(const Judge *judge, ReliefExtent extent) {
    const Source *source = judge->source;
    return (Relief){&judge->heights, 1.0, source->aspect, source->scale, source->base, extent};
}

/* The line of sight must meet the relief at the texel itself, and nowhere before it. */
static bool is_visible(const Judge *judge, Ray ray, double u, double v) {
    Relief relief = relief_of(judge, RELIEF_SLAB);
    Sample met = truth_relief(&relief, ray);
    return met.hit && fabs(met.u - u) * judge->source->width < 0.01 &&
           fabs(met.v - v) * judge->source->height < 0.01;
}

typedef struct {
    Judge *judge;
    Eye eye;
} Work;

static void land_row(void *context, int y) {
    const Work *work = context;
    const Source *source = work->judge->source;
    for (int x = 0; x < source->width; x++) {
        double u = (x + 0.5) / source->width, v = (y + 0.5) / source->height;
        double h = *image_at(&work->judge->heights, x, y);
        Vec3 point = relief_point(source, &source->plane, u, v, h);
        Ray ray = line_of_sight(source, work->eye, point);
        Sighting sighting = {.height = h};
        Vec2 at = v2(0, 0);
        sighting.in_front = ray.direction.z < 0.0 && ray_meets(ray, &source->plane, &at);
        sighting.u = at.x, sighting.v = at.y;
        sighting.visible = sighting.in_front && is_visible(work->judge, ray, u, v);
        work->judge->sightings[(size_t)y * source->width + x] = sighting;
    }
}

/* ---- The destination's texels ---- */

/* The centre of a destination's texel in the polygon's texture coordinates. */
static Vec2 centre(const Judge *judge, int x, int y) {
    return v2(judge->low.x + (judge->high.x - judge->low.x) * (x + 0.5) / judge->width,
              judge->low.y + (judge->high.y - judge->low.y) * (y + 0.5) / judge->height);
}

static void trace_row(void *context, int y) {
    const Work *work = context;
    const Judge *judge = work->judge;
    Relief relief = relief_of(judge, RELIEF_CUT);
    for (int x = 0; x < judge->width; x++) {
        Vec2 at = centre(judge, x, y);
        if (!(at.x > 0.0 && at.x < 1.0 && at.y > 0.0 && at.y < 1.0)) continue;
        Vec3 point = relief_point(judge->source, &judge->source->plane, at.x, at.y, judge->source->base);
        judge->exact[(size_t)y * judge->width + x] =
            truth_relief(&relief, line_of_sight(judge->source, work->eye, point));
    }
}

/* The texel of the destination that a landing lies in, or -1. */
static int texel_under(const Judge *judge, const Sighting *sighting) {
    if (!sighting->in_front) return -1;
    double x = floor((sighting->u - judge->low.x) / (judge->high.x - judge->low.x) * judge->width);
    double y = floor((sighting->v - judge->low.y) / (judge->high.y - judge->low.y) * judge->height);
    if (!(x >= 0.0 && x < judge->width && y >= 0.0 && y < judge->height)) return -1;
    return (int)y * judge->width + (int)x;
}

static void find_highest(Judge *judge) {
    int texels = judge->width * judge->height, count = judge->source->width * judge->source->height;
    for (int i = 0; i < texels; i++) judge->highest[i] = -1;
    for (int i = 0; i < count; i++) {
        int under = texel_under(judge, &judge->sightings[i]);
        if (under < 0) continue;
        int *highest = &judge->highest[under];
        if (*highest < 0 || judge->sightings[i].height > judge->sightings[*highest].height) *highest = i;
    }
}

Judge judge_create(const Source *source, Eye eye, const Destination *shape) {
    size_t count = (size_t)source->width * source->height, texels = (size_t)shape->width * shape->height;
    Judge judge = {.source = source,
                   .width = shape->width,
                   .height = shape->height,
                   .low = shape->low,
                   .high = shape->high,
                   .heights = image_create(source->width, source->height, 1),
                   .colours = image_create(source->width, source->height, 3),
                   .sightings = allocate(count, sizeof(Sighting)),
                   .exact = allocate(texels, sizeof(Sample)),
                   .highest = allocate(texels, sizeof(int))};
    for (size_t i = 0; i < count; i++) {
        judge.heights.pixels[i] = (float)(source->levels[i] / 65535.0);
        for (int c = 0; c < 3; c++)
            judge.colours.pixels[3 * i + c] = (float)srgb_decode(source->texels[i].colour[c] / 255.0);
    }
    if (is_above(eye)) {
        Work work = {&judge, eye};
        parallel_for(source->height, land_row, &work);
        parallel_for(judge.height, trace_row, &work);
    }
    find_highest(&judge);
    return judge;
}

void judge_destroy(Judge *judge) {
    image_destroy(&judge->heights);
    image_destroy(&judge->colours);
    free(judge->sightings);
    free(judge->exact);
    free(judge->highest);
    *judge = (Judge){0};
}

/* ---- The figures ---- */

static double percent(double part, double whole) { return whole > 0.0 ? 100.0 * part / whole : 0.0; }

static bool is_empty(const Texel *texel) { return texel->colour[3] < 128; }

double judge_hole_percent(const Judge *judge, const Destination *destination) {
    double holes = 0.0, hits = 0.0;
    for (int i = 0; i < judge->width * judge->height; i++) {
        hits += judge->exact[i].hit;
        holes += judge->exact[i].hit && is_empty(&destination->texels[i]);
    }
    return percent(holes, hits);
}

/* How far a texel of the source rises or falls to one of its eight neighbours, the relief being repeated. */
static double own_rise(const Judge *judge, int x, int y) {
    const Image *heights = &judge->heights;
    int width = heights->width, height = heights->height;
    double h = *image_at(heights, x, y), rise = 0.0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            double other = *image_at(heights, (x + dx + width) % width, (y + dy + height) % height);
            rise = fmax(rise, fabs(other - h));
        }
    return rise;
}

static double exact_height(const Judge *judge, int i) {
    double h;
    image_sample(&judge->heights, judge->exact[i].u, judge->exact[i].v, &h);
    return h;
}

/* The source's texel nearest to (u, v), which may lie up to its edges. */
static int nearest_to(int size, double u) { return (int)clamp(floor(u * size), 0.0, size - 1.0); }

double judge_order_violation_percent(const Judge *judge, const Destination *destination) {
    const int width = judge->source->width, height = judge->source->height;
    const double rounding = 1e-6; /* of the lookup's floats */
    double violations = 0.0, seen = 0.0;
    for (int i = 0; i < judge->width * judge->height; i++) {
        int highest = judge->highest[i];
        if (highest < 0 || is_empty(&destination->texels[i])) continue;
        const float *shown = &destination->lookup[3 * i];
        double rise = own_rise(judge, nearest_to(width, shown[0]), nearest_to(height, shown[1]));
        double allowed = rise + own_rise(judge, highest % width, highest / width) + rounding;
        bool right = judge->exact[i].hit && shown[2] >= exact_height(judge, i) - rise - rounding;
        seen++;
        violations += judge->sightings[highest].height - shown[2] > allowed && !right;
    }
    return percent(violations, seen);
}

double judge_rmse(const Judge *judge, const Destination *destination) {
    double sum = 0.0, hits = 0.0;
    for (int i = 0; i < judge->width * judge->height; i++) {
        if (!judge->exact[i].hit) continue;
        const uint8_t *colour = destination->texels[i].colour;
        Vec3 exact = truth_colour(&judge->colours, judge->exact[i].u, judge->exact[i].v);
        Vec3 shown = vec3_scale(v3(srgb_decode(colour[0] / 255.0), srgb_decode(colour[1] / 255.0),
                                   srgb_decode(colour[2] / 255.0)),
                                colour[3] / 255.0);
        Vec3 error = vec3_sub(shown, exact);
        sum += vec3_dot(error, error) / 3.0;
        hits++;
    }
    return hits > 0.0 ? sqrt(sum / hits) : 0.0;
}

static bool is_kept(const Canvas *canvas, Ray ray) {
    Vec2 at;
    return ray_meets(ray, &canvas->plane, &at) && at.x >= canvas->low.x && at.x <= canvas->high.x &&
           at.y >= canvas->low.y && at.y <= canvas->high.y;
}

double judge_lost_texel_percent(const Judge *judge, Eye eye, const Canvas *canvases, int count) {
    const Source *source = judge->source;
    double visible = 0.0, lost = 0.0;
    for (int y = 0; y < source->height; y++)
        for (int x = 0; x < source->width; x++) {
            const Sighting *sighting = &judge->sightings[(size_t)y * source->width + x];
            if (!sighting->visible) continue;
            Vec3 point = relief_point(source, &source->plane, (x + 0.5) / source->width,
                                      (y + 0.5) / source->height, sighting->height);
            Ray ray = line_of_sight(source, eye, point);
            int kept = 0;
            for (int i = 0; i < count; i++) kept += is_kept(&canvases[i], ray);
            visible++;
            lost += kept == 0;
        }
    return percent(lost, visible);
}

/* Where the eye sees the point of a row at u, upward, in texels of the destination. */
static double seen_upward(const Judge *judge, Eye eye, double u, int y) {
    const Source *source = judge->source;
    double v = (y + 0.5) / source->height, h;
    Vec2 at = v2(0, NAN);
    image_sample(&judge->heights, u, v, &h);
    ray_meets(line_of_sight(source, eye, relief_point(source, &source->plane, u, v, h)), &source->plane, &at);
    return (at.y - judge->low.y) / (judge->high.y - judge->low.y) * judge->height;
}

double judge_first_pass_loss_percent(const Judge *judge, Eye eye, const float *kept) {
    const Source *source = judge->source;
    double seen = 0.0, lost = 0.0;
    for (int i = 0; i < judge->width * judge->height; i++) {
        int texel = judge->highest[i];
        if (texel < 0 || !judge->sightings[texel].visible) continue;
        int x = texel % source->width, y = texel / source->width;
        double u = kept[(size_t)y * judge->width + i % judge->width];
        double own =
            (judge->sightings[texel].v - judge->low.y) / (judge->high.y - judge->low.y) * judge->height;
        bool other =
            fabs(u * source->width - (x + 0.5)) > 1.0 && !(fabs(seen_upward(judge, eye, u, y) - own) <= 1.0);
        seen++;
        lost += isnan(u) || other;
    }
    return percent(lost, seen);
}
