/* The rasterizer: which pixels it draws, and what it draws there, held against arithmetic of the test's own.
 */
#include "joints.h"
#include "raster.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- Tools ---- */

static uint64_t state = 0x9E3779B97F4A7C15u;

/* xorshift64*: the same numbers in every run. */
static uint32_t random_bits(void) {
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return (uint32_t)(state * 0x2545F4914F6CDD1Du >> 32);
}
static double uniform(double low, double high) { return low + (high - low) * random_bits() / 4294967296.0; }
static int whole(int low, int high) { return low + (int)(random_bits() % (uint32_t)(high - low + 1)); }

static Image image_new(int width, int height, int channels) {
    Image image = {width, height, channels, .bits = 32,
                   .pixels = calloc((size_t)width * height * channels, 4)};
    assert_non_null(image.pixels);
    return image;
}

/* A vertex that is seen at (x, y), in pixels, of a picture of that size. */
static ClipVertex vertex_at(int width, int height, double x, double y, double w) {
    return (ClipVertex){.x = (2 * x / width - 1) * w, .y = (2 * y / height - 1) * w, .w = w};
}

/* A plane with s, t = 0 at `origin`, growing by 1 along u and along v. */
typedef struct {
    Vec3 origin, u, v;
} Plane;

static Vec3 plane_point(const Plane *plane, double s, double t) {
    return vec3_add(plane->origin, vec3_add(vec3_scale(plane->u, s), vec3_scale(plane->v, t)));
}

/* A ray through a pixel's centre meets a plane: s, t, and the distance along the ray, which is negative
 * behind the eye. In doubles, by Cramer's rule; not by way of clip space. */
typedef struct {
    double s, t, distance;
} Hit;

static Hit exact_hit(const Camera *camera, int width, int height, const Plane *plane, int x, int y) {
    Vec3 forward = vec3_normalize(vec3_sub(camera->target, camera->eye));
    Vec3 right = vec3_normalize(vec3_cross(forward, camera->up)), up = vec3_cross(right, forward);
    double half = tan(radians(camera->fov_y_degrees) / 2);
    double across = (2 * (x + 0.5) / width - 1) * half * width / height,
           rise = (2 * (y + 0.5) / height - 1) * half;
    Vec3 ray = vec3_normalize(vec3_add(forward, vec3_add(vec3_scale(right, across), vec3_scale(up, rise))));
    Vec3 from = vec3_sub(camera->eye, plane->origin), normal = vec3_cross(plane->u, plane->v);
    double distance = -vec3_dot(from, normal) / vec3_dot(ray, normal);
    Vec3 p = vec3_add(from, vec3_scale(ray, distance));
    double size = vec3_dot(normal, normal);
    return (Hit){vec3_dot(vec3_cross(p, plane->v), normal) / size,
                 vec3_dot(vec3_cross(plane->u, p), normal) / size, distance};
}

static void plane_corners(const Camera *camera, int width, int height, const Plane *plane, double s_scale,
                          double t_scale, ClipVertex corner[4]) {
    static const double at[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; i++)
        corner[i] = clip_vertex(camera, width, height, plane_point(plane, at[i][0], at[i][1]),
                                at[i][0] * s_scale, at[i][1] * t_scale);
}

static Vec3 random_direction(void) {
    Vec3 d;
    do d = v3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    while (vec3_length(d) > 1 || vec3_length(d) < 0.1);
    return vec3_normalize(d);
}

/* A unit square tilted by that angle against the view, about any axis, and a camera that sees it large. */
static void tilted_view(double degrees, Camera *camera, Plane *plane) {
    double a = uniform(0, 2 * PI), c = cos(radians(degrees)), s = sin(radians(degrees));
    Vec3 axis = v3(cos(a), sin(a), 0), across = v3(-sin(a), cos(a), 0);
    Vec3 eye = vec3_add(vec3_scale(across, s), v3(0, 0, c)); /* the normal z, turned about the axis */
    *plane = (Plane){v3(-0.5, -0.5, 0), v3(1, 0, 0), v3(0, 1, 0)};
    *camera = (Camera){.eye = vec3_scale(eye, uniform(1.0, 2.0)),
                       .target = v3(uniform(-0.1, 0.1), uniform(-0.1, 0.1), 0),
                       .up = vec3_add(vec3_scale(axis, uniform(-1, 1)), vec3_cross(eye, axis)),
                       .fov_y_degrees = uniform(40, 60),
                       .near = 0.05,
                       .far = 100};
}

/* What one picture's lookup errs, in texels, where the exact hit is inside the plane's unit square. */
typedef struct {
    double max, ulps,
        bound_ratio; /* ulps: of the largest |s| or |t| seen; ratio: error over raster's bound */
    double depth;    /* relative */
    int pixels;
} Errors;

static double ulp(double x) { return nextafterf((float)x, INFINITY) - (float)x; }

static Errors lookup_errors(const Raster *raster, const Camera *camera, const Plane *plane, double s_scale,
                            double t_scale) {
    Errors errors = {0};
    double largest = 0, error_s = 0;
    for (int y = 0; y < raster->height; y++)
        for (int x = 0; x < raster->width; x++) {
            const float *found = image_at(raster->lookup, x, y);
            Hit hit = exact_hit(camera, raster->width, raster->height, plane, x, y);
            if (hit.distance <= 0 || hit.s < 0 || hit.s > 1 || hit.t < 0 || hit.t > 1 || found[3] == 0)
                continue;
            double ds = fabs(found[0] - hit.s * s_scale), dt = fabs(found[1] - hit.t * t_scale);
            double error = hypot(ds * raster->texture->width, dt * raster->texture->height);
            errors.pixels++;
            errors.max = fmax(errors.max, error);
            errors.depth = fmax(errors.depth, fabs(found[2] / hit.distance - 1));
            largest = fmax(largest, fmax(hit.s * s_scale, hit.t * t_scale));
            error_s = fmax(error_s, fmax(ds, dt));
            if (raster->bound) {
                double bound = raster->bound[(size_t)y * raster->width + x];
                errors.bound_ratio = fmax(errors.bound_ratio, error / bound);
            }
        }
    errors.ulps = largest > 0 ? error_s / ulp(largest) : 0;
    return errors;
}

/* A raster of everything but a colour. raster_free frees what it made. */
static Raster raster_new(int width, int height, const Camera *camera, Filling filling, int every) {
    static Image texture = {.width = 256, .height = 256, .channels = 3};
    Image *lookup = malloc(sizeof *lookup);
    assert_non_null(lookup);
    *lookup = image_new(width, height, 4);
    double half = tan(radians(camera->fov_y_degrees) / 2);
    return (Raster){.width = width,
                    .height = height,
                    .texture = &texture,
                    .filling = filling,
                    .every = every,
                    .lookup = lookup,
                    .eye_x = half * width / height,
                    .eye_y = half,
                    .drawn = calloc((size_t)width * height, sizeof(uint16_t)),
                    .bound = calloc((size_t)width * height, sizeof(float))};
}

static void raster_free(Raster *raster) {
    free(raster->lookup->pixels);
    free(raster->lookup);
    free(raster->drawn);
    free(raster->bound);
}

/* ---- Which pixels ---- */

enum { TINY_WIDTH = 16, TINY_HEIGHT = 8, FANS = 100000, RIM_MAX = 8 };

/* Whether a pixel's centre is inside an outline of corners in 1/256 pixel, by the even-odd rule. A centre on
 * an edge is taken to lie a little to the right and much less down: that is the top-left rule. */
static bool outline_holds(int64_t corner[][2], int corners, int x, int y) {
    int64_t px = 256 * x + 128, py = 256 * y + 128;
    bool inside = false;
    for (int i = 0; i < corners; i++) {
        const int64_t *a = corner[i], *b = corner[(i + 1) % corners];
        if ((a[1] >= py) == (b[1] >= py)) continue;
        if (a[1] > b[1]) {
            const int64_t *swap = a;
            a = b, b = swap;
        }
        /* Left of the upward edge a, b: not when on it, for the point lies a little to the right. */
        inside ^= (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]) > 0;
    }
    return inside;
}

static int64_t twice_area(const int64_t *a, const int64_t *b, const int64_t *c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Coordinates in 1/256 pixel; two of three fans on a coarse grid, so that centres lie on edges and vertices.
 * Of the largest fans, all vertices are far off the picture, and the edge to the first passes near it. */
static void random_fan(int64_t centre[2], int64_t rim[][2], int corners) {
    static const int grids[3] = {1, 64, 128};
    static const double reaches[4] = {2, 10, 100, 40000};
    int grid = grids[whole(0, 2)], size = whole(0, 3);
    double reach = reaches[size] * 256 / grid, away = size == 3 ? 0.5 * reach : 0, turn = uniform(0, 2 * PI);
    centre[0] = (whole(0, 256 * TINY_WIDTH / grid) + (int64_t)(away * cos(turn))) * grid;
    centre[1] = (whole(0, 256 * TINY_HEIGHT / grid) + (int64_t)(away * sin(turn))) * grid;
    for (int i = 0; i < corners; i++) {
        double corner = i == 0 && away > 0 ? uniform(-2e-4, 2e-4) : i + uniform(0, 0.9);
        double angle = turn + PI + corner * 2 * PI / corners,
               radius = uniform(away > 0 ? 0.9 : 0.01, 1) * reach;
        rim[i][0] = centre[0] + (int64_t)floor(radius * cos(angle)) * grid;
        rim[i][1] = centre[1] + (int64_t)floor(radius * sin(angle)) * grid;
    }
}

static ClipVertex tiny_vertex(const int64_t *corner) {
    return vertex_at(TINY_WIDTH, TINY_HEIGHT, corner[0] / 256.0, corner[1] / 256.0, 1);
}

/* Draws the triangle in one of its six orders. */
static void draw_triangle(const Raster *raster, ClipVertex a, ClipVertex b, ClipVertex c) {
    ClipVertex v[5] = {a, b, c, a, b}, reversed[3] = {c, b, a};
    raster_polygon(raster, whole(0, 1) ? v + whole(0, 2) : reversed, 3);
}

/* Whether exactly the pixels of an outline are drawn, each once. */
static void check_drawn(const uint16_t *drawn, int64_t corner[][2], int corners) {
    for (int i = 0; i < TINY_WIDTH * TINY_HEIGHT; i++) {
        int x = i % TINY_WIDTH, y = i / TINY_WIDTH, expected = outline_holds(corner, corners, x, y);
        if (drawn[i] != expected)
            fail_msg("pixel %d, %d is drawn %d times, not %d", x, y, drawn[i], expected);
    }
}

/* Of each fan first one triangle alone, then all. */
static void test_fans(void **context) {
    (void)context;
    uint16_t drawn[TINY_WIDTH * TINY_HEIGHT];
    Raster raster = {TINY_WIDTH, TINY_HEIGHT, .filling = FILL_PERSPECTIVE, .drawn = drawn};
    for (int fans = 0; fans < FANS;) {
        int64_t centre[2], rim[RIM_MAX][2];
        int corners = whole(3, RIM_MAX);
        random_fan(centre, rim, corners);
        bool folded = false;
        for (int i = 0; i < corners; i++) folded |= twice_area(centre, rim[i], rim[(i + 1) % corners]) < 0;
        if (folded) continue;
        fans++;
        memset(drawn, 0, sizeof drawn);
        for (int i = 0; i < corners; i++) {
            draw_triangle(&raster, tiny_vertex(centre), tiny_vertex(rim[i]),
                          tiny_vertex(rim[(i + 1) % corners]));
            if (i > 0) continue;
            int64_t first[3][2] = {{centre[0], centre[1]}, {rim[0][0], rim[0][1]}, {rim[1][0], rim[1][1]}};
            check_drawn(drawn, first, 3);
        }
        check_drawn(drawn, rim, corners);
    }
}

/* A square whose edges run through pixel centres: its left and top ones are its own. */
static void test_top_left(void **context) {
    (void)context;
    uint16_t drawn[TINY_WIDTH * TINY_HEIGHT] = {0};
    Raster raster = {TINY_WIDTH, TINY_HEIGHT, .filling = FILL_PERSPECTIVE, .drawn = drawn};
    int64_t corner[4][2] = {{384, 384}, {1152, 384}, {1152, 1152}, {384, 1152}}; /* 1.5 and 4.5 */
    ClipVertex square[4];
    for (int i = 0; i < 4; i++) square[i] = tiny_vertex(corner[i]);
    raster_polygon(&raster, square, 4);
    for (int i = 0; i < TINY_WIDTH * TINY_HEIGHT; i++) {
        int x = i % TINY_WIDTH, y = i / TINY_WIDTH;
        assert_int_equal(drawn[i], x >= 1 && x < 4 && y >= 2 && y <= 4);
    }
}

/* Vertices snap to the nearest 1/256 pixel: an edge 1/520 pixel right of a centre passes through it, one
 * 1/500 pixel right of it does not. With dropped bits the grid is coarser. */
static void test_snapping(void **context) {
    (void)context;
    static const struct {
        double x;
        int dropped_bits, first;
    } cases[] = {{2.5 + 1 / 520.0, 0, 2},
                 {2.5 + 1 / 500.0, 0, 3},
                 {2.5 - 1 / 500.0, 0, 2},
                 {2.4, 8, 2},
                 {2.6, 8, 3},
                 {2.55, 7, 2},
                 {2.8, 7, 3},
                 {-16384.3, 0, 0},
                 {16384.3, 0, TINY_WIDTH}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint16_t drawn[TINY_WIDTH * TINY_HEIGHT] = {0};
        Raster raster = {TINY_WIDTH, TINY_HEIGHT, .filling = FILL_PERSPECTIVE, .drawn = drawn};
        raster.dropped_bits = cases[i].dropped_bits;
        ClipVertex quad[4] = {vertex_at(TINY_WIDTH, TINY_HEIGHT, cases[i].x, -1, 1),
                              vertex_at(TINY_WIDTH, TINY_HEIGHT, 20000, -1, 1),
                              vertex_at(TINY_WIDTH, TINY_HEIGHT, 20000, 20, 1),
                              vertex_at(TINY_WIDTH, TINY_HEIGHT, cases[i].x, 20, 1)};
        raster_polygon(&raster, quad, 4);
        for (int x = 0; x < TINY_WIDTH; x++) assert_int_equal(drawn[3 * TINY_WIDTH + x], x >= cases[i].first);
    }
}

/* ---- Near the eye and behind it ---- */

static int compare_vertices(const void *a, const void *b) { return memcmp(a, b, sizeof(ClipVertex)); }

/* The corners of a clipped polygon that came from its edge with r = 0, each once, in an order of their own.
 */
static int edge_corners(const ClipVertex *polygon, int corners, ClipVertex *out) {
    int count = 0, different = 0;
    for (int i = 0; i < corners; i++)
        if (polygon[i].r == 0) out[count++] = polygon[i];
    qsort(out, (size_t)count, sizeof *out, compare_vertices);
    for (int i = 0; i < count; i++)
        if (i == 0 || compare_vertices(&out[i], &out[different - 1]) != 0) out[different++] = out[i];
    return different;
}

static ClipVertex random_clip_vertex(double r) {
    return (ClipVertex){uniform(-2, 2), uniform(-2, 2), uniform(-1, 1), uniform(-1, 1),
                        uniform(0, 9),  uniform(0, 9),  .r = r};
}

/* Two triangles share an edge, and walk along it in opposite directions: cut, it is still one. */
static void test_shared_edge_cut(void **context) {
    (void)context;
    int cut = 0;
    for (int i = 0; i < 100000; i++) {
        ClipVertex a = random_clip_vertex(0), b = random_clip_vertex(0);
        ClipVertex c = random_clip_vertex(1), d = random_clip_vertex(-1);
        if (i % 10 == 0) a.w = 0;                      /* an end in the eye's plane */
        if (i % 10 == 1) a.z = -a.w;                   /* or on the near plane */
        if (i % 10 == 2) a.x = a.y = a.w = 0, a.z = 1; /* or in the eye itself, for all that the planes say */
        ClipVertex one[CLIPPED_CORNERS_MAX], other[CLIPPED_CORNERS_MAX];
        int corners = polygon_clip((ClipVertex[]){a, b, c}, 3, 640, 480, one);
        int count = edge_corners(one, corners, one);
        corners = polygon_clip((ClipVertex[]){d, b, a}, 3, 640, 480, other);
        int other_count = edge_corners(other, corners, other);
        if (count > 0 &&
            other_count > 0) { /* else one triangle is gone as a whole, with its end of the edge */
            assert_int_equal(count, other_count);
            assert_memory_equal(one, other, count * sizeof *one);
            for (int j = 0; j < count; j++)
                cut += compare_vertices(&one[j], &a) != 0 && compare_vertices(&one[j], &b) != 0;
        }
        for (int j = 0; j < count; j++) assert_true(one[j].w > 0.9e-6 && one[j].z >= -one[j].w - 1e-12);
    }
    assert_true(cut > 10000);
}

/* A floor as a fan around a point near the eye, its rim all around, much of it behind the eye; the camera
 * looks anywhere. Below the horizon every pixel is drawn once; no pixel, twice. */
static void test_floor_around_the_eye(void **context) {
    (void)context;
    enum { WIDTH = 64, HEIGHT = 48 };
    const Plane floor = {v3(0, 0, 0), v3(1, 0, 0), v3(0, 0, -1)};
    int drawn_pixels = 0;
    for (int i = 0; i < 500; i++) {
        Camera camera = {.eye = v3(0, 1, 0),
                         .target = vec3_add(v3(0, 1, 0), random_direction()),
                         .up = random_direction(),
                         .fov_y_degrees = uniform(30, 110),
                         .near = uniform(0.01, 0.9),
                         .far = 1000};
        uint16_t drawn[WIDTH * HEIGHT] = {0};
        Raster raster = {WIDTH, HEIGHT, .filling = FILL_PERSPECTIVE, .drawn = drawn};
        int corners = whole(3, 9);
        double turn = uniform(0, 6), near_radius = i % 2 ? 1 : 0;
        ClipVertex centre = clip_vertex(
            &camera, WIDTH, HEIGHT, v3(uniform(-1, 1) * near_radius, 0, uniform(-1, 1) * near_radius), 0, 0);
        ClipVertex rim[10];
        for (int j = 0; j < corners; j++) {
            double angle = turn + 2 * PI * j / corners;
            rim[j] = clip_vertex(&camera, WIDTH, HEIGHT, v3(1000 * cos(angle), 0, 1000 * sin(angle)), 0, 0);
        }
        for (int j = 0; j < corners; j++) draw_triangle(&raster, centre, rim[j], rim[(j + 1) % corners]);
        Vec3 forward = vec3_normalize(vec3_sub(camera.target, camera.eye));
        for (int j = 0; j < WIDTH * HEIGHT; j++) {
            Hit hit = exact_hit(&camera, WIDTH, HEIGHT, &floor, j % WIDTH, j / WIDTH);
            Vec3 seen = vec3_sub(plane_point(&floor, hit.s, hit.t), camera.eye);
            bool inside =
                hit.distance > 0 && hit.distance < 400 && vec3_dot(seen, forward) > 1.01 * camera.near;
            bool outside = hit.distance < 0 || vec3_dot(seen, forward) < 0.99 * camera.near;
            if (drawn[j] > 1 || (inside && drawn[j] != 1) || (outside && drawn[j] != 0))
                fail_msg("view %d: pixel %d, %d is drawn %d times", i, j % WIDTH, j / WIDTH, drawn[j]);
            drawn_pixels += drawn[j];
        }
    }
    assert_true(drawn_pixels > 100 * WIDTH * HEIGHT);
}

/* Triangles of any vertices at all, w = 0 and less among them: each pixel at most once, every value within
 * the bounds that raster.h promises. */
static void test_any_vertices(void **context) {
    (void)context;
    enum { WIDTH = 32, HEIGHT = 24 };
    Camera camera = {.fov_y_degrees = 90};
    for (int i = 0; i < 3000; i++) {
        Raster raster = raster_new(WIDTH, HEIGHT, &camera, (Filling)(i % 4), whole(0, 9));
        ClipVertex v[3];
        for (int j = 0; j < 3; j++) {
            v[j] = random_clip_vertex(0);
            if (whole(0, 3) == 0) v[j].w = 0;
            if (whole(0, 3) == 0) v[j].w = ldexp(1, -whole(0, 60));
            if (whole(0, 3) == 0) v[j].x = ldexp(v[j].x, whole(0, 20));
        }
        if (whole(0, 3) == 0) v[2] = clip_vertex_mix(&v[0], &v[1], uniform(0, 1)); /* without area */
        raster_polygon(&raster, v, 3);
        for (int j = 0; j < WIDTH * HEIGHT; j++) {
            const float *lookup = raster.lookup->pixels + 4 * j;
            assert_true(raster.drawn[j] <= 1);
            assert_true(lookup[3] == raster.drawn[j]);
            if (!(lookup[0] >= -9 && lookup[0] <= 18 && lookup[1] >= -9 && lookup[1] <= 18 &&
                  lookup[2] >= 0 && lookup[2] < 10))
                fail_msg("%d: s = %g, t = %g, depth = %g", i, lookup[0], lookup[1], lookup[2]);
        }
        raster_free(&raster);
    }
}

static void test_not_finite(void **context) {
    (void)context;
    static const double wrong[] = {NAN, INFINITY, -INFINITY, 1e300, -2e8};
    uint16_t drawn[TINY_WIDTH * TINY_HEIGHT] = {0};
    Raster raster = {TINY_WIDTH, TINY_HEIGHT, .filling = FILL_PERSPECTIVE, .drawn = drawn};
    for (int i = 0; i < 3 * 9 * 5; i++) {
        ClipVertex v[3] = {vertex_at(TINY_WIDTH, TINY_HEIGHT, -9, -9, 1),
                           vertex_at(TINY_WIDTH, TINY_HEIGHT, 99, -9, 1),
                           vertex_at(TINY_WIDTH, TINY_HEIGHT, 3, 99, 1)};
        double *const numbers[9] = {&v[i / 45].x, &v[i / 45].y, &v[i / 45].z, &v[i / 45].w, &v[i / 45].s,
                                    &v[i / 45].t, &v[i / 45].r, &v[i / 45].g, &v[i / 45].b};
        *numbers[i / 5 % 9] = wrong[i % 5];
        raster_polygon(&raster, v, 3);
        raster_polygon(&raster, v, 2);
        raster_polygon(&raster, v, -1);
    }
    for (int i = 0; i < TINY_WIDTH * TINY_HEIGHT; i++) assert_int_equal(drawn[i], 0);
}

/* ---- What is drawn there ---- */

/* At any tilt up to 80 degrees, `perspective` is within 1e-3 texel of doubles, and within its own bound. */
static void test_perspective_is_exact(void **context) {
    (void)context;
    double worst = 0, worst_depth = 0, worst_ratio = 0;
    for (int i = 0; i < 12; i++) {
        Camera camera;
        Plane plane;
        ClipVertex corner[4];
        tilted_view(i < 4 ? 80 : uniform(0, 80), &camera, &plane);
        plane_corners(&camera, 640, 480, &plane, 1, 1, corner);
        Raster raster = raster_new(640, 480, &camera, FILL_PERSPECTIVE, 0);
        if (i % 2)
            raster_polygon(&raster, corner, 4);
        else
            raster_parallelogram(&raster, corner, 1);
        Errors errors = lookup_errors(&raster, &camera, &plane, 1, 1);
        assert_true(errors.pixels > 10000);
        worst = fmax(worst, errors.max);
        worst_depth = fmax(worst_depth, errors.depth);
        worst_ratio = fmax(worst_ratio, errors.bound_ratio);
        raster_free(&raster);
    }
    print_message("# perspective: %.3g texel, %.3g of its bound; depth %.3g\n", worst, worst_ratio,
                  worst_depth);
    assert_true(worst < 1e-3);
    assert_true(worst_ratio <= 1);
    assert_true(worst_depth < 1e-6);
}

/* A floor that passes under the eye and behind it, with s and t up to 10,000, seen to its horizon. */
static void far_view(int i, Camera *camera, Plane *floor) {
    double pitch = uniform(0, 0.5), roll = i % 3 ? uniform(-1.5, 1.5) : 0, heading = uniform(0, 6.3);
    Vec3 ahead = v3(sin(heading) * cos(pitch), -sin(pitch), -cos(heading) * cos(pitch));
    Vec3 side = v3(cos(heading), 0, sin(heading));
    *floor = (Plane){v3(-uniform(0, 1e4), 0, uniform(0, 1e4)), v3(1e4, 0, 0), v3(0, 0, -1e4)};
    *camera = (Camera){.eye = v3(0, uniform(0.5, 3), 0),
                       .up = vec3_add(v3(0, cos(roll), 0), vec3_scale(side, sin(roll))),
                       .fov_y_degrees = uniform(40, 90),
                       .near = 0.1,
                       .far = 2e4};
    camera->target = vec3_add(camera->eye, ahead);
}

static void test_far_floor(void **context) {
    (void)context;
    double worst = 0, worst_ratio = 0, nearest_horizon = 0;
    for (int i = 0; i < 12; i++) {
        Camera camera;
        Plane floor;
        ClipVertex corner[4];
        far_view(i, &camera, &floor);
        plane_corners(&camera, 640, 480, &floor, 1e4, 1e4, corner);
        Raster raster = raster_new(640, 480, &camera, FILL_PERSPECTIVE, 0);
        raster_parallelogram(&raster, corner, i % 2 ? 1 : 7);
        Errors errors = lookup_errors(&raster, &camera, &floor, 1e4, 1e4);
        worst = fmax(worst, errors.ulps);
        worst_ratio = fmax(worst_ratio, errors.bound_ratio);
        for (int j = 0; j < 640 * 480; j++)
            nearest_horizon = fmax(nearest_horizon, raster.lookup->pixels[4 * j + 2]);
        raster_free(&raster);
    }
    print_message("# far floor: %.3g ulp, %.3g of its bound, as far as %.3g\n", worst, worst_ratio,
                  nearest_horizon);
    assert_true(worst < 16);
    assert_true(worst_ratio <= 1);
    assert_true(nearest_horizon > 5000);
}

/* `spans` obeys max|s''| n^2 / 8 plus the float term at every pixel, and comes near it somewhere. */
static void test_spans_bound(void **context) {
    (void)context;
    for (int every = 4; every <= 64; every *= 2) {
        double closest = 0, largest = 0;
        for (int i = 0; i < 4; i++) {
            Camera camera;
            Plane plane;
            ClipVertex corner[4];
            if (i < 2)
                tilted_view(i ? 80 : 60, &camera, &plane);
            else
                far_view(i, &camera, &plane);
            double scale = i < 2 ? 1 : 1e4;
            plane_corners(&camera, 320, 240, &plane, scale, scale, corner);
            Raster raster = raster_new(320, 240, &camera, FILL_SPANS, every);
            raster_parallelogram(&raster, corner, 1);
            Errors errors = lookup_errors(&raster, &camera, &plane, scale, scale);
            if (errors.bound_ratio > 1) fail_msg("every %d: %g of the bound", every, errors.bound_ratio);
            closest = fmax(closest, errors.bound_ratio);
            if (i < 2) largest = fmax(largest, errors.max);
            raster_free(&raster);
        }
        print_message("# spans %d: %.3g texel on the quad, at most %.3g of the bound\n", every, largest,
                      closest);
        assert_true(closest > 0.5);
    }
}

/* `spans` is `perspective` itself at both ends of each span, and everywhere for n = 1. */
static void test_spans_nodes(void **context) {
    (void)context;
    for (int i = 0; i < 20; i++) {
        Camera camera;
        Plane plane;
        ClipVertex corner[4];
        tilted_view(uniform(20, 80), &camera, &plane);
        plane_corners(&camera, 160, 120, &plane, 1, 1, corner);
        int every = i == 0 ? 1 : whole(2, 70);
        Raster exact = raster_new(160, 120, &camera, FILL_PERSPECTIVE, 0);
        Raster spans = raster_new(160, 120, &camera, FILL_SPANS, every);
        raster_polygon(&exact, corner, 4);
        raster_polygon(&spans, corner, 4);
        for (int y = 0; y < 120; y++) {
            int begin = 0, end = 160;
            while (begin < end && !exact.drawn[160 * y + begin]) begin++;
            while (begin < end && !exact.drawn[160 * y + end - 1]) end--;
            for (int x = begin; x < end; x++) {
                const float *a = image_at(exact.lookup, x, y), *b = image_at(spans.lookup, x, y);
                bool node = x == begin || x == end - 1 || every == 1;
                if (node) assert_memory_equal(a, b, 4 * sizeof *a);
            }
        }
        raster_free(&exact);
        raster_free(&spans);
    }
}

/* `affine` is wrong by many texels, and as many splits each way make that smaller by their square. */
static void test_affine_and_subdivided(void **context) {
    (void)context;
    Camera camera = {.eye = v3(0, -1.2, 0.8), .up = v3(0, 0, 1), .fov_y_degrees = 50, .near = 0.1, .far = 10};
    Plane plane = {v3(-0.5, -0.5, 0), v3(1, 0, 0), v3(0, 1, 0)};
    double error[3];
    for (int i = 0; i < 3; i++) {
        static const int splits[3] = {1, 8, 64};
        ClipVertex corner[4];
        plane_corners(&camera, 320, 240, &plane, 1, 1, corner);
        Raster raster = raster_new(320, 240, &camera, FILL_AFFINE, 0);
        raster_parallelogram(&raster, corner, splits[i]);
        error[i] = lookup_errors(&raster, &camera, &plane, 1, 1).max;
        raster_free(&raster);
    }
    print_message("# affine: %.3g texel; 8 x 8: %.3g; 64 x 64: %.3g\n", error[0], error[1], error[2]);
    assert_true(error[0] > 20);
    assert_true(error[1] < error[0] / 16 && error[2] < error[1] / 16);
}

/* The classic: with w = 1, 1 and 3, 3 at the left and right, the middle of the screen is a quarter of the
 * way, not half. Colours go half of the way, for FILL_COLOUR is linear on the screen. */
static void test_middle(void **context) {
    (void)context;
    enum { WIDTH = 17, HEIGHT = 9 };
    for (int filling = FILL_COLOUR; filling <= FILL_PERSPECTIVE; filling++) {
        Image colour = image_new(WIDTH, HEIGHT, 3), lookup = image_new(WIDTH, HEIGHT, 4);
        Image texture = image_new(64, 4, 3);
        Raster raster = {WIDTH, HEIGHT, &texture, (Filling)filling, 8, 0, &colour, &lookup, 0, 0, NULL, NULL};
        ClipVertex corner[4];
        for (int i = 0; i < 4; i++) {
            bool right = i == 1 || i == 2;
            corner[i] = vertex_at(WIDTH, HEIGHT, right ? WIDTH : 0, i < 2 ? 0 : HEIGHT, right ? 3 : 1);
            corner[i].s = right, corner[i].t = i >= 2, corner[i].r = right, corner[i].g = 0.5;
        }
        for (int i = 0; i < 64 * 4; i++) texture.pixels[3 * i] = (i % 64 + 0.5f) / 64; /* red is s, */
        for (int i = 0; i < 64 * 4; i++) texture.pixels[3 * i + 1] = 0.5f;             /* green 1/2 */
        raster_polygon(&raster, corner, 4);
        bool divided = filling == FILL_PERSPECTIVE || filling == FILL_SPANS;
        const float *s = image_at(&lookup, WIDTH / 2, HEIGHT / 2),
                    *pixel = image_at(&colour, WIDTH / 2, HEIGHT / 2);
        assert_true(fabs(s[0] - (divided ? 0.25 : 0.5)) < 1e-6);
        assert_true(fabs(pixel[0] - s[0]) < 1e-6 && fabs(pixel[1] - 0.5) < 1e-6 && pixel[2] == 0);
        assert_true(fabs(s[2] - 1.5) < 1e-6 && s[3] == 1);
        free(colour.pixels);
        free(lookup.pixels);
        free(texture.pixels);
    }
}

/* Bilinear, repeated, row 0 at the bottom, and defined for any numbers at all. */
static void test_texture(void **context) {
    (void)context;
    Image texture = image_new(5, 3, 3);
    for (int i = 0; i < 5 * 3 * 3; i++) texture.pixels[i] = (float)uniform(0, 1);
    float colour[3];
    for (int i = 0; i < 10000; i++) {
        float s = (float)uniform(-3, 3), t = (float)uniform(-3, 3);
        texture_read(&texture, s, t, colour);
        double x = s * 5.0 - 0.5, y = t * 3.0 - 0.5, fx = x - floor(x), fy = y - floor(y);
        int x0 = ((int)floor(x) + 50) % 5, y0 = ((int)floor(y) + 30) % 3, x1 = (x0 + 1) % 5,
            y1 = (y0 + 1) % 3;
        for (int c = 0; c < 3; c++) {
            double low = image_at(&texture, x0, y0)[c] * (1 - fx) + image_at(&texture, x1, y0)[c] * fx;
            double high = image_at(&texture, x0, y1)[c] * (1 - fx) + image_at(&texture, x1, y1)[c] * fx;
            assert_true(fabs(colour[c] - (low * (1 - fy) + high * fy)) < 4e-6);
        }
    }
    texture_read(&texture, 3.5f / 5, 0.5f / 3, colour); /* the centre of the texel in column 3, row 0 */
    for (int c = 0; c < 3; c++) assert_true(fabsf(colour[c] - texture.pixels[9 + c]) < 1e-6f);
    static const float odd[] = {0, 1, -1e-9f, -1e-45f, 1e30f, -1e30f, INFINITY, NAN, 0.99999994f, 8388607.5f};
    for (int i = 0; i < 100; i++) {
        texture_read(&texture, odd[i / 10], odd[i % 10], colour);
        for (int c = 0; c < 3; c++) assert_true(colour[c] >= 0 && colour[c] <= 1);
    }
    free(texture.pixels);
}

/* ---- Hard cases ---- */

/* A level floor, its far edge less than 1/512 pixel below the horizon, which runs through a row of pixel
 * centres: snapped, the edge does too, and by the top-left rule that row is drawn. 1/w is 0 there. */
static void test_centre_on_the_horizon(void **context) {
    (void)context;
    enum { WIDTH = 31, HEIGHT = 21 };
    static const double distances[] = {1e4, 1e5, 1e6};
    for (int i = 0; i < 3 * 4; i++) {
        double far = distances[i / 4];
        Camera camera = {.eye = v3(0, 1, 0), .up = v3(0, 1, 0), .fov_y_degrees = 60, .near = 0.1, .far = 2e6};
        camera.target = v3(0, 1, -1);
        Plane floor = {v3(-far, 0, 1), v3(2 * far, 0, 0), v3(0, 0, -far - 1)};
        ClipVertex corner[4];
        plane_corners(&camera, WIDTH, HEIGHT, &floor, 1, far, corner);
        Raster raster = raster_new(WIDTH, HEIGHT, &camera, (Filling)(i % 4), 8);
        raster_polygon(&raster, corner, 4);
        for (int x = 0; x < WIDTH; x++) {
            const float *lookup = image_at(raster.lookup, x, HEIGHT / 2);
            assert_int_equal(raster.drawn[HEIGHT / 2 * WIDTH + x], 1);
            assert_int_equal(raster.drawn[(HEIGHT / 2 + 1) * WIDTH + x], 0);
            assert_true(lookup[0] >= -1 && lookup[0] <= 2 && lookup[1] >= -far && lookup[1] <= 2 * far);
            assert_true(lookup[2] > 0 && lookup[2] <= 2 * far * 1.3); /* 1.3: along the ray, not the view */
        }
        raster_free(&raster);
    }
}

/* Triangles smaller than a pixel draw the one whose centre they hold, or none; slivers draw what the same
 * outline in whole numbers holds. */
static void test_small_triangles(void **context) {
    (void)context;
    Camera camera = {.fov_y_degrees = 90};
    int drawn = 0;
    for (int i = 0; i < 20000; i++) {
        Raster raster = raster_new(TINY_WIDTH, TINY_HEIGHT, &camera, FILL_PERSPECTIVE, 0);
        double size = i % 2 ? 1 : 20, x = uniform(0, TINY_WIDTH), y = uniform(0, TINY_HEIGHT);
        double dx = uniform(-size, size), dy = uniform(-size, size), thin = i % 2 ? 1 : uniform(0, 0.01);
        double at[3][2] = {{x, y}, {x + dx, y + dy}, {x + dx * 0.4 - dy * thin, y + dy * 0.4 + dx * thin}};
        int64_t snapped[3][2];
        ClipVertex v[3];
        for (int j = 0; j < 3; j++) {
            v[j] = vertex_at(TINY_WIDTH, TINY_HEIGHT, at[j][0], at[j][1], uniform(1, 2));
            v[j].s = j == 1, v[j].t = j == 2;
            for (int k = 0; k < 2; k++) snapped[j][k] = (int64_t)floor(at[j][k] * 256 + 0.5);
        }
        draw_triangle(&raster, v[0], v[1], v[2]);
        for (int j = 0; j < TINY_WIDTH * TINY_HEIGHT; j++) {
            const float *lookup = raster.lookup->pixels + 4 * j;
            assert_int_equal(raster.drawn[j], outline_holds(snapped, 3, j % TINY_WIDTH, j / TINY_WIDTH));
            drawn += raster.drawn[j];
            assert_true(lookup[0] >= -1 && lookup[0] <= 2 && lookup[1] >= -1 && lookup[1] <= 2);
        }
        raster_free(&raster);
    }
    assert_true(drawn > 2000);
}

/* A sliver just below a row of pixel centres, 1/16,000 pixel thin: snapped, its long edge is on the centres.
 * Its planes would say t = -32 there. */
static void test_thin_sliver(void **context) {
    (void)context;
    Camera camera = {.fov_y_degrees = 90};
    for (int filling = FILL_COLOUR; filling <= FILL_PERSPECTIVE; filling++) {
        Raster raster = raster_new(TINY_WIDTH, TINY_HEIGHT, &camera, (Filling)filling, 8);
        ClipVertex v[3] = {vertex_at(TINY_WIDTH, TINY_HEIGHT, 1, 4.4981, 1),
                           vertex_at(TINY_WIDTH, TINY_HEIGHT, 15, 4.4981, 2),
                           vertex_at(TINY_WIDTH, TINY_HEIGHT, 8, 4.49804, 1.5)};
        v[1].s = v[2].t = 1;
        raster_polygon(&raster, v, 3);
        for (int x = 0; x < TINY_WIDTH; x++) {
            const float *lookup = image_at(raster.lookup, x, 4);
            assert_int_equal(raster.drawn[4 * TINY_WIDTH + x], x >= 1 && x < 15);
            assert_true(lookup[0] >= -1 && lookup[0] <= 2 && lookup[1] >= -1 && lookup[1] <= 2);
        }
        raster_free(&raster);
    }
}

/* A triangle of no area is seen as a line, and draws nothing. But where its corners snap to a triangle, its
 * neighbours leave those pixels to it: it draws them, with its mean. */
static void test_no_area(void **context) {
    (void)context;
    Camera camera = {.fov_y_degrees = 90};
    Raster raster = raster_new(TINY_WIDTH, TINY_HEIGHT, &camera, FILL_PERSPECTIVE, 0);
    ClipVertex line[3];
    for (int i = 0; i < 3; i++)
        line[i] = vertex_at(TINY_WIDTH, TINY_HEIGHT, i * 5, i * 1.5, 1), line[i].t = i;
    raster_polygon(&raster, (ClipVertex[]){line[1], line[1], line[1]}, 3);
    raster_polygon(&raster, (ClipVertex[]){line[0], line[2], line[0]}, 3);
    raster_polygon(&raster, line, 3);
    for (int i = 0; i < TINY_WIDTH * TINY_HEIGHT; i++) assert_int_equal(raster.drawn[i], 0);

    raster.dropped_bits = 8; /* the middle vertex goes up, from y = 1.5 to 2 */
    raster_polygon(&raster, line, 3);
    int drawn = 0;
    for (int i = 0; i < TINY_WIDTH * TINY_HEIGHT; i++) {
        drawn += raster.drawn[i];
        if (raster.drawn[i]) assert_true(raster.lookup->pixels[4 * i + 1] == 1);
    }
    assert_true(drawn > 0);
    raster_free(&raster);
}

/* ---- T-joints ---- */

typedef struct {
    Camera camera;
    int width, height;
    double bump;
} Ground;

static ClipVertex ground_point(const void *context, double s, double t) {
    const Ground *ground = context;
    Vec3 p = v3(2 * s - 1, ground->bump * sin(9 * s) * cos(14 * t), 1 - 2 * t);
    return clip_vertex(&ground->camera, ground->width, ground->height, p, s, t);
}

static Cracks ground_cracks(const Ground *ground, int left, int right, bool mended, int dropped_bits) {
    Joint joint = joint_create(left, right, mended, ground_point, ground);
    Cracks cracks = joint_cracks(&joint, ground->width, ground->height, dropped_bits);
    joint_destroy(&joint);
    return cracks;
}

/* Two halves of a flat quad, split differently, and two levels of detail of a hilly one, from many views. */
static void test_joints(void **context) {
    (void)context;
    enum { HALVES_FINE, HALVES_COARSE, LEVELS, KINDS };
    Cracks sum[KINDS] = {{0, 0, 0}};
    for (int i = 0; i < 40; i++) {
        double turn = uniform(0, 2 * PI), height = uniform(1.5, 2.5);
        Ground ground = {{.eye = v3(2 * sin(turn), height, 2 * cos(turn)),
                          .up = v3(uniform(-0.3, 0.3), 1, uniform(-0.3, 0.3)),
                          .fov_y_degrees = 60,
                          .near = 0.1,
                          .far = 10},
                         160,
                         120,
                         0};
        for (int kind = 0; kind < KINDS; kind++) {
            ground.width = kind == HALVES_FINE ? 640 : 160, ground.height = ground.width * 3 / 4;
            int left = kind == LEVELS ? 16 : whole(2, 12), right = kind == LEVELS ? 8 : whole(2, 12);
            int dropped_bits = kind == HALVES_COARSE ? 6 : 0;
            ground.bump = kind == LEVELS ? 0.05 : 0;
            Cracks cracks = ground_cracks(&ground, left, right, false, dropped_bits);
            sum[kind].missed += cracks.missed;
            sum[kind].doubled += cracks.doubled;
            cracks = ground_cracks(&ground, left, right, true, dropped_bits);
            assert_true(cracks.inside > 1000);
            if (cracks.missed + cracks.doubled > 0)
                fail_msg("mended %d | %d: %d missed, %d doubled", left, right, cracks.missed, cracks.doubled);
        }
    }
    print_message(
        "# cracks in 40 views: halves at 1/256 pixel %d + %d, at 1/4 pixel %d + %d, levels %d + %d\n",
        sum[0].missed, sum[0].doubled, sum[1].missed, sum[1].doubled, sum[2].missed, sum[2].doubled);
    assert_true(sum[HALVES_FINE].missed + sum[HALVES_FINE].doubled > 0);
    assert_true(sum[HALVES_COARSE].missed > 0 && sum[HALVES_COARSE].doubled > 0);
    assert_true(sum[LEVELS].missed > 40 && sum[LEVELS].doubled > 40);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fans),
        cmocka_unit_test(test_top_left),
        cmocka_unit_test(test_snapping),
        cmocka_unit_test(test_shared_edge_cut),
        cmocka_unit_test(test_floor_around_the_eye),
        cmocka_unit_test(test_any_vertices),
        cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_perspective_is_exact),
        cmocka_unit_test(test_far_floor),
        cmocka_unit_test(test_spans_bound),
        cmocka_unit_test(test_spans_nodes),
        cmocka_unit_test(test_affine_and_subdivided),
        cmocka_unit_test(test_middle),
        cmocka_unit_test(test_texture),
        cmocka_unit_test(test_centre_on_the_horizon),
        cmocka_unit_test(test_small_triangles),
        cmocka_unit_test(test_thin_sliver),
        cmocka_unit_test(test_no_area),
        cmocka_unit_test(test_joints),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
