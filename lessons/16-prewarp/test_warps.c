/* The ways to warp but for the fast one, against brute force: every texel of random reliefs projected by
 * itself, by the line from the eye through its point, and exact rays. */
#include "depth_buffer.h"
#include "inverse.h"
#include "light.h"
#include "overflow.h"
#include "splat.h"
#include "truth.h"
#include "two_pass.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- Reliefs, eyes and projection of the test's own ---- */

static uint64_t state = 0x9E3779B97F4A7C15u;

/* xorshift64*: the same numbers in every run. */
static uint32_t random_bits(void) {
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return (uint32_t)(state * 0x2545F4914F6CDD1Du >> 32);
}
static double uniform(double low, double high) { return low + (high - low) * random_bits() / 4294967296.0; }

static void near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound))
        fail_msg("got %.17g, expected %.17g within %g", value, expected, bound);
}

/* SMOOTH: two waves, so gentle that no cell is turned over from 60 degrees. STEPS: of two heights, in blocks.
 * NOISE: every texel its own height. */
typedef enum { SMOOTH, STEPS, NOISE, KINDS } Kind;

static double height_of(Kind kind, double u, double v) {
    if (kind == NOISE) return uniform(0, 1);
    if (kind == STEPS) return fmod(floor(u * 5) + floor(v * 4), 2) == 0 ? 0.25 : 0.9;
    return 0.5 + 0.25 * sin(2 * PI * (u + 0.1)) + 0.25 * cos(2 * PI * (u + v));
}

/* Every texel has its own colour (for up to 65,536 of them) and normal. */
static Source relief_new(Kind kind, int width, int height, double scale, double base) {
    Image colour = image_create(width, height, 3), heights = image_create(width, height, 1);
    Image normals = image_create(width, height, 3);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float *c = image_at(&colour, x, y), *n = image_at(&normals, x, y);
            *image_at(&heights, x, y) = (float)height_of(kind, (x + 0.5) / width, (y + 0.5) / height);
            for (int k = 0; k < 3; k++) c[k] = (float)uniform(0, 1), n[k] = (float)uniform(-0.5, 0.5);
        }
    Source source = source_create(&colour, &heights, &normals, scale, base);
    image_destroy(&colour);
    image_destroy(&heights);
    image_destroy(&normals);
    return source;
}

static Source random_relief(double base) {
    static const int sizes[][2] = {{24, 24}, {31, 17}, {1, 20}, {40, 1}, {16, 33}, {1, 1}, {2, 3}};
    const int *size = sizes[random_bits() % 7];
    return relief_new(random_bits() % KINDS, size[0], size[1], uniform(0.02, 0.3), base);
}

static Destination destination_of(const Source *source) {
    return destination_create(source->width, source->height, v2(0, 0), v2(1, 1), true);
}

static Eye far_eye(double degrees, double azimuth) {
    double t = radians(degrees), p = radians(azimuth);
    return (Eye){v3(sin(t) * cos(p), sin(t) * sin(p), cos(t)), 0};
}

/* Eyes at infinity and near by, whose epipoles lie within the image, on its edges, beyond them and at
 * infinity.
 */
static Eye eye_number(int i) {
    static const Eye chosen[] = {
        {{0, 0, 1}, 0},  {{0, 0, 1.5}, 1},     {{-0.5, 0, 1}, 1},  {{0.5, 0.5, 1.2}, 1}, {{1, 0, 1}, 0},
        {{0, -2, 1}, 0}, {{0.1, 0.2, 0.8}, 1}, {{3, 0.1, 0.9}, 1}, {{-1, 2, 1}, 1},      {{-3, -1, 1}, 0},
    };
    if (i < 10) return chosen[i];
    if (i % 2) return far_eye(uniform(0, 80), uniform(0, 360));
    return (Eye){v3(uniform(-2, 2), uniform(-2, 2), uniform(0.4, 2)), 1};
}

enum { EYES = 60 };

static Eye mirrored(Eye eye) { return (Eye){v3(eye.at.x, eye.at.y, -eye.at.z), eye.w}; }

static Vec3 point_of(const Source *source, double u, double v, double h) {
    return v3(u - 0.5, (v - 0.5) * source->aspect, source->scale * (h - source->base));
}

/* Where the line of sight of a point meets the polygon, in the destination's texels with centres at whole
 * numbers; false for what is not in front of the eye, or (1/64 of the polygon's distance) all but there. */
static bool seen_at(const Source *source, const Destination *destination, Eye eye, Vec3 point, Vec2 *at) {
    Vec3 way = eye.w > 0 ? vec3_sub(point, eye.at) : vec3_scale(eye.at, -1);
    double t = -point.z / way.z; /* from the point on */
    if (eye.w > 0 && !((point.z - eye.at.z) / -eye.at.z > LANDING_W_MIN)) return false;
    double u = point.x + t * way.x + 0.5, v = (point.y + t * way.y) / source->aspect + 0.5;
    at->x = (u - destination->low.x) / (destination->high.x - destination->low.x) * destination->width - 0.5;
    at->y = (v - destination->low.y) / (destination->high.y - destination->low.y) * destination->height - 0.5;
    return true;
}

static double level_height(const Source *source, int x, int y) {
    return source->levels[(size_t)y * source->width + x] / 65535.0;
}

static Vec2 texel_seen_at(const Source *source, const Destination *destination, Eye eye, int x, int y) {
    Vec2 at = v2(NAN, NAN);
    seen_at(
        source, destination, eye,
        point_of(source, (x + 0.5) / source->width, (y + 0.5) / source->height, level_height(source, x, y)),
        &at);
    return at;
}

static bool is_empty(const Destination *destination, size_t at) {
    return destination->texels[at].colour[3] < 128;
}

/* How far from a texel's centre its lookup's point is seen, in texels. */
static double lookup_error(const Source *source, const Destination *destination, Eye eye, int x, int y) {
    const float *lookup = &destination->lookup[3 * ((size_t)y * destination->width + x)];
    Vec2 at = v2(NAN, NAN);
    seen_at(source, destination, eye, point_of(source, lookup[0], lookup[1], lookup[2]), &at);
    return fmax(fabs(at.x - x), fabs(at.y - y));
}

/* ---- All ways, by number ---- */

typedef enum { DEPTH, DEPTH_SPLAT, ORDER_SPLAT, TWO_PASS, INVERSE, WAYS } Way;

static void warp(Way way, const Source *source, Eye eye, Destination *destination) {
    PrewarpFactors factors = prewarp_factors(&source->plane, eye);
    Visibility visibility = way == ORDER_SPLAT ? VISIBILITY_OCCLUSION_ORDER : VISIBILITY_DEPTH_BUFFER;
    if (way == TWO_PASS)
        warp_two_pass(source, &factors, destination, NULL);
    else if (way == INVERSE)
        warp_inverse(source, &factors, destination);
    else
        warp_forward(source, &factors, visibility, way == DEPTH ? FILLING_NONE : FILLING_SPLAT, destination,
                     NULL);
}

static void bytes_survive_linear_light(void **unused) {
    (void)unused;
    const Light *light = light_tables();
    for (int i = 0; i < 256; i++) assert_int_equal(light_encode(light, light->decoded[i]), i);
}

/* ---- Depth buffer ---- */

/* The texels of the source that land on one of the destination: the nearest must have stayed, with all that
 * it carries. behind: nearest is lowest. Those within a thousandth of its border may be counted either way.
 */
static void check_nearest(const Source *source, const Destination *destination, Eye eye, bool behind, int x,
                          int y) {
    size_t at = (size_t)y * destination->width + x;
    const Texel *shown = &destination->texels[at];
    double best = -1, best_inside = -1, found = -1;
    for (int j = 0; j < source->height; j++)
        for (int i = 0; i < source->width; i++) {
            Vec2 where = texel_seen_at(source, destination, eye, i, j);
            double off = fmax(fabs(where.x - x), fabs(where.y - y));
            double h = level_height(source, i, j), nearness = behind ? 1 - h : h;
            if (!(off < 0.501)) continue;
            best = fmax(best, nearness);
            if (off < 0.499) best_inside = fmax(best_inside, nearness);
            const Texel *own = &source->texels[(size_t)j * source->width + i];
            if (shown->colour[3] && !memcmp(own, shown, sizeof *own)) found = nearness;
        }
    if (best < 0) assert_int_equal(shown->colour[3], 0);
    if (best_inside >= 0) assert_int_equal(shown->colour[3], 255);
    if (shown->colour[3]) assert_true(found >= best_inside && found <= best);
}

static void depth_buffer_keeps_the_nearest(void **unused) {
    (void)unused;
    for (int e = 0; e < 2 * EYES; e++) {
        bool behind = e % 2;
        Source source = random_relief(behind ? uniform(0, 1) : 1);
        Destination destination = destination_of(&source);
        Eye eye = eye_number(e / 2);
        if (behind) eye = mirrored(eye);
        warp(DEPTH, &source, eye, &destination);
        for (int y = 0; y < destination.height; y++)
            for (int x = 0; x < destination.width; x++)
                check_nearest(&source, &destination, eye, behind, x, y);
        source_destroy(&source);
        destination_destroy(&destination);
    }
}

/* ---- Splats ---- */

/* A spot's alpha at a destination texel. */
static double spot_alpha(const Source *source, const Destination *destination, Eye eye, int i, int j, int x,
                         int y) {
    Vec2 at = texel_seen_at(source, destination, eye, i, j);
    double z = point_of(source, 0, 0, level_height(source, i, j)).z;
    double w = eye.w > 0 ? (z - eye.at.z) / -eye.at.z : 1;
    double r = hypot(at.x - x, at.y - y) * w;
    return r <= SPLAT_OPAQUE ? 1 : r < SPLAT_RADIUS ? (SPLAT_RADIUS - r) / (SPLAT_RADIUS - SPLAT_OPAQUE) : 0;
}

/* In whatever order spots are laid over and under one another, what stays transparent is the product of what
 * they leave. And with the depth buffer the highest spot, if it is opaque here, is all that is seen. */
static void check_spots(const Source *source, const Destination *destination, Way way, Eye eye, int x, int y,
                        int *opaque) {
    const Texel *shown = &destination->texels[(size_t)y * destination->width + x], *highest = NULL;
    double left = 1, highest_h = -1;
    for (int j = 0; j < source->height; j++)
        for (int i = 0; i < source->width; i++) {
            double alpha = spot_alpha(source, destination, eye, i, j, x, y);
            double h = level_height(source, i, j);
            if (!(alpha > 0)) continue;
            left *= 1 - alpha;
            if (h < highest_h) continue;
            bool alone = alpha == 1 && h > highest_h;
            highest = alone ? &source->texels[(size_t)j * source->width + i] : NULL;
            highest_h = h;
        }
    near(shown->colour[3], 255 * (1 - left), 1.0);
    if (way != DEPTH_SPLAT || !highest) return;
    for (int c = 0; c < 3; c++) near(shown->colour[c], highest->colour[c], 1);
    (*opaque)++;
}

static void splats_are_composited(void **unused) {
    (void)unused;
    int opaque = 0;
    for (int e = 0; e < EYES; e++) {
        Source source = relief_new(e % 2 ? NOISE : SMOOTH, 17, 12, 0.2, 1);
        Destination destination = destination_of(&source);
        Eye eye = eye_number(e);
        for (Way way = DEPTH_SPLAT; way <= ORDER_SPLAT; way++) {
            warp(way, &source, eye, &destination);
            for (int y = 0; y < destination.height; y++)
                for (int x = 0; x < destination.width; x++)
                    check_spots(&source, &destination, way, eye, x, y, &opaque);
        }
        source_destroy(&source);
        destination_destroy(&destination);
    }
    assert_true(opaque > 1000);
}

/* Two texels of a source, the left one high and white, the right one low and black, seen from the left so
 * that both land around the right one's place, the high one 0.2 texels off and the low one 0.75: opaque
 * white, whether it comes first or last. Then the high one 0.75 off and the low one opaque: half and half, of
 * light. */
static void near_spots_lie_over_far_ones(void **unused) {
    (void)unused;
    const double tilt[2] = {1.2, 1.75}, low[2] = {0.75, 0.0}, expected[2] = {1, 0.5};
    for (int mirror = 0; mirror < 2; mirror++)
        for (int i = 0; i < 4; i++) {
            Image colour = image_create(2, 1, 3), heights = image_create(2, 1, 1),
                  normals = image_create(2, 1, 3);
            int high_one = mirror ? 1 : 0, low_one = 1 - high_one;
            for (int c = 0; c < 3; c++) image_at(&colour, high_one, 0)[c] = 1;
            /* a texel is half a width; from 45 degrees a displacement moves by itself */
            *image_at(&heights, high_one, 0) = (float)(tilt[i / 2] / 2),
                                          *image_at(&heights, low_one, 0) = (float)(low[i / 2] / 2);
            Source source = source_create(&colour, &heights, &normals, 1, 0);
            Destination destination = destination_of(&source);
            warp(i % 2 ? DEPTH_SPLAT : ORDER_SPLAT, &source, (Eye){{mirror ? 1 : -1, 0, 1}, 0}, &destination);
            const Texel *shown = &destination.texels[low_one];
            assert_int_equal(shown->colour[3], 255);
            near(srgb_decode(shown->colour[0] / 255.0), expected[i / 2], 0.005);
            source_destroy(&source);
            destination_destroy(&destination);
            image_destroy(&colour);
            image_destroy(&heights);
            image_destroy(&normals);
        }
}

/* ---- Two passes ---- */

/* What is shown at a texel is what the eye sees there, if one believes the lookup: exactly for an eye at
 * infinity. Near by, a straight piece is divided evenly where it is seen, not where it lies. */
static void two_pass_shows_what_is_there(void **unused) {
    (void)unused;
    double texels = 0;
    for (int e = 0; e < 4 * EYES; e++) {
        Source source = random_relief(e % 3 / 2.0);
        Destination destination = destination_of(&source);
        Eye eye = eye_number(e % EYES);
        if (e >= 2 * EYES) eye = mirrored(eye);
        warp(TWO_PASS, &source, eye, &destination);
        for (int y = 0; y < destination.height; y++)
            for (int x = 0; x < destination.width; x++) {
                if (is_empty(&destination, (size_t)y * destination.width + x)) continue;
                double error = lookup_error(&source, &destination, eye, x, y);
                if (eye.w == 0)
                    near(error, 0, 2e-3);
                else if (source.scale < 0.05)
                    near(error, 0, 0.5);
                texels++;
            }
        source_destroy(&source);
        destination_destroy(&destination);
    }
    assert_true(texels > 10000);
}

/* The share of texels at which two lookups are more than that many texels of the source apart. */
static double disagreement(const Source *source, const Destination *one, const Destination *other,
                           double texels, bool mirror) {
    double count = 0, bad = 0;
    for (int i = 0; i < one->width * one->height; i++) {
        const float *p = &one->lookup[3 * i], *q = &other->lookup[3 * i];
        bool empty = is_empty(one, i);
        count++;
        if (empty != is_empty(other, i))
            bad++;
        else if (!empty)
            bad += fabs(p[0] - q[0]) * source->width > texels ||
                   fabs(p[1] - q[1]) * source->height > texels ||
                   fabs((mirror ? 1 - p[2] : p[2]) - q[2]) > 1e-3 + texels;
    }
    return bad / count;
}

/* Where all lies in one row, or in one column, a pass has nothing to lose: what it shows is what the inverse
 * finds, but for silhouettes. Painted away from the epipole it would show what is farthest. */
static void two_pass_is_exact_in_a_line(void **unused) {
    (void)unused;
    for (int e = 0; e < EYES; e++) {
        bool upright = e % 2;
        Source source =
            relief_new(e % KINDS, upright ? 1 : 200, upright ? 200 : 1, upright ? 20 : 0.1, e % 3 / 2.0);
        Destination one = destination_of(&source), other = destination_of(&source);
        double along = uniform(-4, 4), up = upright ? 200 : 1; /* both 200 texels long */
        Eye eye = {upright ? v3(0, along * up, up) : v3(along, 0, up), e % 4 < 2};
        warp(TWO_PASS, &source, eye, &one);
        warp(INVERSE, &source, eye, &other);
        assert_true(disagreement(&source, &one, &other, 0.1, false) <= 0.03);
        source_destroy(&source);
        destination_destroy(&one);
        destination_destroy(&other);
    }
}

/* A pin of one texel, which an eye right beside its top looks down on: the piece of the row below the eye
 * comes last, or the pin's far side would be seen through its near one. */
static void the_piece_below_the_eye_comes_last(void **unused) {
    (void)unused;
    Source source = relief_new(NOISE, 8, 1, 0.55, 1);
    for (int x = 0; x < 8; x++) source.levels[x] = x == 4 ? UINT16_MAX : 0;
    Eye eye = {v3(4.7 / 8 - 0.5, 0, 0.05), 1}; /* the pin's top is at 4.5 of 8 */
    Destination destination = destination_create(16, 1, v2(4.5 / 8, 0), v2(4.7 / 8, 1), true);
    warp(TWO_PASS, &source, eye, &destination);
    for (int x = 0; x < 16; x++) {
        double shown = 8 * destination.lookup[3 * x];
        assert_true(shown > 4.5 && shown < 5.5);
    }
    source_destroy(&source);
    destination_destroy(&destination);
}

/* A gentle relief has no folds to lose anything in: two passes show what the inverse does. */
static void two_pass_is_the_inverse_without_folds(void **unused) {
    (void)unused;
    for (int e = 0; e < EYES; e++) {
        Source source = relief_new(SMOOTH, 61, 47, 0.05, e % 2);
        Destination one = destination_of(&source), other = destination_of(&source);
        Eye eye = e % 2 ? far_eye(uniform(0, 50), uniform(0, 360))
                        : (Eye){v3(uniform(-1, 1), uniform(-1, 1), uniform(1, 2)), 1};
        warp(TWO_PASS, &source, eye, &one);
        warp(INVERSE, &source, eye, &other);
        assert_true(disagreement(&source, &one, &other, 0.2, false) <= 0.01);
        source_destroy(&source);
        destination_destroy(&one);
        destination_destroy(&other);
    }
}

/* What the first pass says that it kept in a column is seen in that column. */
static void first_pass_keeps_what_it_says(void **unused) {
    (void)unused;
    Source source = relief_new(SMOOTH, 50, 20, 0.2, 1);
    Destination destination = destination_create(37, 11, v2(-0.25, 0.1), v2(1.5, 0.9), true);
    Eye eye = far_eye(50, 200);
    PrewarpFactors factors = prewarp_factors(&source.plane, eye);
    float kept[37 * 20];
    int columns = 0;
    warp_two_pass(&source, &factors, &destination, kept);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 37; x++) {
            double u = kept[37 * y + x], along = clamp(u * 50 - 0.5, 0, 49 - 1e-6), h;
            if (isnan(u) || u < 0.01 || u > 0.99) continue;
            int left = (int)along;
            h = level_height(&source, left, y) * (left + 1 - along) +
                level_height(&source, left + 1, y) * (along - left);
            Vec2 at;
            assert_true(seen_at(&source, &destination, eye, point_of(&source, u, (y + 0.5) / 20, h), &at));
            near(at.x, x, 1e-3);
            columns++;
        }
    assert_true(columns > 300);
    source_destroy(&source);
    destination_destroy(&destination);
}

/* ---- The inverse ---- */

/* The ray through a destination's point on a plane: from the eye, or from above the relief. */
static Ray ray_through(Eye eye, Vec3 point) {
    if (eye.w > 0) return (Ray){eye.at, vec3_normalize(vec3_sub(point, eye.at))};
    return (Ray){vec3_add(point, vec3_scale(eye.at, 2 / eye.at.z)), vec3_normalize(vec3_scale(eye.at, -1))};
}

static Image heights_of(const Source *source) {
    Image image = image_create(source->width, source->height, 1);
    for (int i = 0; i < source->width * source->height; i++)
        image.pixels[i] = (float)(source->levels[i] / 65535.0);
    return image;
}

/* The exact ray's hits in the form of a warp's. */
static Destination exact_of(const Source *source, Eye eye, const Plane *plane, const Destination *shape,
                            ReliefExtent extent) {
    Image heights = heights_of(source);
    Relief relief = {&heights, 1, source->aspect, source->scale, source->base, extent};
    Destination exact = destination_create(shape->width, shape->height, shape->low, shape->high, true);
    for (int i = 0; i < shape->width * shape->height; i++) {
        double u = shape->low.x + (shape->high.x - shape->low.x) * (i % shape->width + 0.5) / shape->width;
        double v = shape->low.y + (shape->high.y - shape->low.y) * (i / shape->width + 0.5) / shape->height;
        Vec3 point = vec3_add(plane->origin, vec3_add(vec3_scale(plane->a, u), vec3_scale(plane->b, v)));
        Sample hit = truth_relief(&relief, ray_through(eye, point));
        if (!hit.hit) continue;
        double h;
        image_sample(&heights, hit.u, hit.v, &h);
        exact.texels[i].colour[3] = 255;
        exact.lookup[3 * i] = (float)hit.u, exact.lookup[3 * i + 1] = (float)hit.v;
        exact.lookup[3 * i + 2] = (float)h;
    }
    image_destroy(&heights);
    return exact;
}

/* Eyes above the relief, and within its volume: over the polygon at its bottom, a little above the surface.
 */
static void inverse_is_the_exact_ray(void **unused) {
    (void)unused;
    double bad = 0, all = 0, empty = 0;
    for (int e = 0; e < 4 * EYES; e++) {
        bool within = e % 4 == 3;
        Source source = within ? relief_new(SMOOTH, 30, 20, 0.2, 0) : random_relief(e % 3 / 2.0);
        Destination destination = destination_of(&source);
        Eye eye = eye_number(e % EYES);
        if (within) {
            double u = uniform(0.1, 0.9), v = uniform(0.1, 0.9);
            eye = (Eye){point_of(&source, u, v, height_of(SMOOTH, u, v) + 0.1), 1};
        }
        warp(INVERSE, &source, eye, &destination);
        Destination exact = exact_of(&source, eye, &source.plane, &destination, RELIEF_CUT);
        double count = (double)destination.width * destination.height;
        bad += disagreement(&source, &destination, &exact, 1e-3, false) * count;
        for (int i = 0; i < count; i++) empty += is_empty(&exact, i);
        all += count;
        source_destroy(&source);
        destination_destroy(&destination);
        destination_destroy(&exact);
    }
    assert_true(empty > all / 100 && empty < all / 2);
    assert_true(bad <= all * 1e-3);
}

/* ---- What every way owes ---- */

/* An eye behind sees the relief from below; so does the mirrored eye see the relief mirrored in its polygon,
 * of heights 1 - h and base 1 - base. */
static void from_behind_is_the_mirrored_relief(void **unused) {
    (void)unused;
    for (int e = 0; e < EYES; e++) {
        Source source = random_relief(uniform(0, 1)), other = source;
        Eye eye = eye_number(e);
        size_t count = (size_t)source.width * source.height;
        other.levels = malloc(count * sizeof *other.levels);
        for (size_t i = 0; i < count; i++) other.levels[i] = (uint16_t)(65535 - source.levels[i]);
        other.base = 1 - source.base;
        Destination one = destination_of(&source), two = destination_of(&source);
        for (Way way = 0; way < WAYS; way++) {
            warp(way, &source, mirrored(eye), &one);
            warp(way, &other, eye, &two);
            double differ = disagreement(&source, &one, &two, 1e-3, true) * (double)count;
            if (differ > 2 + 0.02 * (double)count) fail_msg("way %d: %g of %zu texels", way, differ, count);
        }
        free(other.levels);
        source_destroy(&source);
        destination_destroy(&one);
        destination_destroy(&two);
    }
}

/* From straight above at infinity, and a flat relief in the polygon from anywhere: each texel stays. */
static void nothing_moves_that_need_not(void **unused) {
    (void)unused;
    for (int flat = 0; flat < 2; flat++)
        for (int e = 0; e < EYES; e++) {
            Source source = random_relief(0);
            size_t count = (size_t)source.width * source.height;
            for (size_t i = 0; flat && i < count; i++) source.levels[i] = 0;
            Destination destination = destination_of(&source);
            for (Way way = 0; way < WAYS; way++) {
                warp(way, &source, flat ? eye_number(e) : far_eye(0, 0), &destination);
                for (size_t i = 0; i < count; i++) {
                    assert_int_equal(destination.texels[i].colour[3], 255);
                    for (int c = 0; c < 3; c++) {
                        near(destination.texels[i].colour[c], source.texels[i].colour[c], 1);
                        near(destination.texels[i].normal[c], source.texels[i].normal[c], 1);
                    }
                }
            }
            source_destroy(&source);
            destination_destroy(&destination);
        }
}

/* An eye in the plane: empty, whatever was there. And an eye within the relief: what is shown is in front. */
static void hard_eyes_have_pictures(void **unused) {
    (void)unused;
    int shown = 0;
    for (int e = 0; e < EYES; e++) {
        Source source = random_relief(e % 3 / 2.0);
        Destination destination = destination_of(&source);
        for (Way way = 0; way < WAYS; way++) {
            memset(destination.texels, 77, sizeof(Texel) * source.width * source.height);
            warp(way, &source, (Eye){{uniform(-1, 1), uniform(-1, 1), 0}, e % 2}, &destination);
            for (int i = 0; i < source.width * source.height; i++)
                assert_int_equal(destination.texels[i].colour[3], 0);
            double z = source.scale * (uniform(0, 1) - source.base);
            Eye within = {v3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), e % 7 ? z : 1e-5), 1};
            PrewarpFactors factors = prewarp_factors(&source.plane, within);
            warp(way, &source, within, &destination);
            for (int i = 0; i < source.width * source.height; i++) {
                const float *lookup = &destination.lookup[3 * i];
                assert_true(isfinite(lookup[0]) && isfinite(lookup[1]) && isfinite(lookup[2]));
                if (is_empty(&destination, i)) continue;
                double d = source.scale * (lookup[2] - source.base);
                assert_true(1 + factors.k3 * d > LANDING_W_MIN - 1e-3);
                shown++;
            }
        }
        source_destroy(&source);
        destination_destroy(&destination);
    }
    assert_true(shown > 1000);
}

/* ---- Overflow ---- */

/* Beyond which edges points are seen, of a grid whose u and v are 0 and 1 and whose d are many. */
static void seen_beyond(const PrewarpFactors *k, Displacements d, bool over[EDGES]) {
    for (int edge = 0; edge < EDGES; edge++) over[edge] = false;
    for (int i = 0; i <= 2000; i++)
        for (int s = 0; s <= 1; s++) {
            double at = d.low + (d.high - d.low) * i / 2000, w = 1 + k->k3 * at;
            if (w < LANDING_W_MIN) continue;
            double u = (s + k->k1 * at) / w, v = (s + k->k2 * at) / w;
            over[EDGE_LEFT] |= u<-1e-9, over[EDGE_RIGHT] |= u> 1 + 1e-9;
            over[EDGE_BOTTOM] |= v<-1e-9, over[EDGE_TOP] |= v> 1 + 1e-9;
        }
}

static void edges_overflow_as_they_say(void **unused) {
    (void)unused;
    Plane plane = {{-0.5, -0.35, 0}, {1, 0, 0}, {0, 0.7, 0}, {0, 0, 1}};
    int four = 0, two = 0;
    for (int i = 0; i < 4000; i++) {
        double scale = uniform(0.01, 0.3), base = i % 4 == 0 ? 0 : i % 4 == 1 ? 1 : uniform(-0.5, 1.5);
        Displacements d = {-scale * base, scale * (1 - base)};
        Eye eye = {v3(uniform(-1, 1), uniform(-1, 1), uniform(0.02, 1)), i % 5 != 0};
        bool behind = i % 3 == 0, over[EDGES];
        if (behind) eye = mirrored(eye);
        PrewarpFactors k = prewarp_factors(&plane, eye);
        seen_beyond(&k, d, over);
        int count = 0;
        for (Edge edge = 0; edge < EDGES; edge++) {
            assert_int_equal(overflow_can(&k, d, edge), over[edge]);
            count += over[edge];
        }
        bool over_polygon = eye.w > 0 && fabs(eye.at.x) < 0.5 && fabs(eye.at.y) < 0.35;
        if (base == 1 && !behind) {
            assert_true(count <= 2 && !(over[EDGE_LEFT] && over[EDGE_RIGHT]) &&
                        !(over[EDGE_BOTTOM] && over[EDGE_TOP]));
            assert_true(!over_polygon || count == 0);
            two += count == 2;
        }
        if (base == 0 && !behind && over_polygon) assert_int_equal(count, 4);
        four += base == 0 && count == 4;
    }
    assert_true(two > 100 && four > 50);
}

static void bounds_hold_the_image(void **unused) {
    (void)unused;
    int enlarged = 0;
    for (int e = 0; e < 2 * EYES; e++) {
        Source source = random_relief(e % 3 / 2.0);
        Eye eye = eye_number(e / 2);
        if (e % 2) eye = mirrored(eye);
        PrewarpFactors k = prewarp_factors(&source.plane, eye);
        Displacements d = overflow_displacements(&source);
        Bounds bounds = overflow_bounds(&source, &k, 100);
        Vec2 low = v2(0, 0), high = v2(1, 1);
        assert_true(bounds.whole);
        for (int i = 0; i < 3000; i++) {
            bool corner = i < 8; /* where the extremes must be */
            double u = corner ? i & 1 : uniform(0, 1), v = corner ? i >> 1 & 1 : uniform(0, 1);
            double at = corner ? (i & 4 ? d.high : d.low) : uniform(d.low, d.high), w = 1 + k.k3 * at;
            Vec2 p = v2((u + k.k1 * at) / w, (v + k.k2 * at) / w);
            assert_true(p.x >= bounds.low.x - 1e-6 && p.x <= bounds.high.x + 1e-6);
            assert_true(p.y >= bounds.low.y - 1e-6 && p.y <= bounds.high.y + 1e-6);
            low = v2(fmin(low.x, p.x), fmin(low.y, p.y)), high = v2(fmax(high.x, p.x), fmax(high.y, p.y));
        }
        assert_true(low.x - bounds.low.x < 1.0 / source.width && bounds.high.x - high.x < 1.0 / source.width);
        assert_true(low.y - bounds.low.y < 1.0 / source.height &&
                    bounds.high.y - high.y < 1.0 / source.height);
        Destination destination = overflow_destination(&source, &k, 100, false);
        near(destination.width, (bounds.high.x - bounds.low.x) * source.width, 1e-6);
        near(destination.height, (bounds.high.y - bounds.low.y) * source.height, 1e-6);
        enlarged += destination.width > source.width;
        destination_destroy(&destination);
        source_destroy(&source);
    }
    assert_true(enlarged > EYES / 2);
}

/* An eye down in the relief: its image is cut at the limit, and says so. */
static void bounds_are_limited(void **unused) {
    (void)unused;
    Source source = relief_new(SMOOTH, 16, 16, 0.2, 0);
    PrewarpFactors k = prewarp_factors(&source.plane, (Eye){{0.1, 0, 0.1}, 1});
    Bounds bounds = overflow_bounds(&source, &k, 0.5);
    assert_false(bounds.whole);
    assert_true(bounds.low.x == -0.5 && bounds.high.x == 1.5 && bounds.low.y == -0.5 && bounds.high.y == 1.5);
    Source large = relief_new(SMOOTH, 9000, 1, 0.2, 0);
    Destination destination = overflow_destination(&large, &k, 1000, false);
    assert_int_equal(destination.width, 9000); /* no room for a width more */
    destination_destroy(&destination);
    source_destroy(&source);
    source_destroy(&large);
}

/* A destination that holds all shows beyond the polygon what exact rays see there through the relief's sides.
 */
static void enlarged_destinations_show_the_overflow(void **unused) {
    (void)unused;
    for (int e = 0; e < EYES; e++) {
        Source source = relief_new(e % KINDS, 30, 20, 0.15, e % 3 / 2.0);
        Eye eye = eye_number(e);
        PrewarpFactors k = prewarp_factors(&source.plane, eye);
        Destination destination = overflow_destination(&source, &k, 2, true);
        warp_inverse(&source, &k, &destination);
        Destination exact = exact_of(&source, eye, &source.plane, &destination, RELIEF_SLAB);
        assert_true(disagreement(&source, &destination, &exact, 1e-3, false) < 0.005);
        source_destroy(&source);
        destination_destroy(&destination);
        destination_destroy(&exact);
    }
}

/* Each texel of an auxiliary polygon against the ray from the eye through its centre: 2.5 % differ, nearly
 * all of them on noise, whose cells are not two triangles each. */
static void auxiliaries_show_what_rays_see(void **unused) {
    (void)unused;
    double bad = 0, all = 0, shown = 0;
    for (int e = 0; e < EYES; e++) {
        Source source = relief_new(e % KINDS, 40, 28, 0.15, e % 4 / 3.0);
        Eye eye = eye_number(e);
        PrewarpFactors k = prewarp_factors(&source.plane, eye);
        for (Edge edge = 0; edge < EDGES; edge++) {
            if (!overflow_can(&k, overflow_displacements(&source), edge)) continue;
            Auxiliary auxiliary = auxiliary_create(&source, edge, true);
            auxiliary_warp(&source, eye, &auxiliary);
            Destination *destination = &auxiliary.destination;
            Destination exact = exact_of(&source, eye, &auxiliary.plane, destination, RELIEF_SLAB);
            double count = (double)destination->width * destination->height;
            for (int i = 0; i < count; i++) shown += !is_empty(&exact, i);
            bad += disagreement(&source, destination, &exact, 0.3, false) * count;
            all += count;
            destination_destroy(&exact);
            auxiliary_destroy(&auxiliary);
        }
        source_destroy(&source);
    }
    assert_true(shown > all / 4 && shown < all * 0.95);
    assert_true(bad < all * 0.031);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_survive_linear_light),
        cmocka_unit_test(depth_buffer_keeps_the_nearest),
        cmocka_unit_test(splats_are_composited),
        cmocka_unit_test(near_spots_lie_over_far_ones),
        cmocka_unit_test(two_pass_shows_what_is_there),
        cmocka_unit_test(two_pass_is_exact_in_a_line),
        cmocka_unit_test(the_piece_below_the_eye_comes_last),
        cmocka_unit_test(two_pass_is_the_inverse_without_folds),
        cmocka_unit_test(first_pass_keeps_what_it_says),
        cmocka_unit_test(inverse_is_the_exact_ray),
        cmocka_unit_test(from_behind_is_the_mirrored_relief),
        cmocka_unit_test(nothing_moves_that_need_not),
        cmocka_unit_test(hard_eyes_have_pictures),
        cmocka_unit_test(edges_overflow_as_they_say),
        cmocka_unit_test(bounds_hold_the_image),
        cmocka_unit_test(bounds_are_limited),
        cmocka_unit_test(enlarged_destinations_show_the_overflow),
        cmocka_unit_test(auxiliaries_show_what_rays_see),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson 16, ways to warp", tests, NULL, NULL);
}
