/* The forward warp: the order of its sheets against rays walked through the source image, where texels land
 * and which stays against brute force in doubles, filled cells against exact rays; and that each of these
 * notices sheets painted the wrong way, swapped factors and a wrong sign. */
#include "forward.h"
#include "truth.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- Reliefs and eyes ---- */

static uint64_t state = 0x9E3779B97F4A7C15u;

/* xorshift64*: the same numbers in every run. */
static double uniform(double low, double high) {
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return low + (high - low) * (double)(uint32_t)(state * 0x2545F4914F6CDD1Du >> 32) / 4294967296.0;
}

typedef enum { FLAT, WAVES, CLIFFS, NOISE, KINDS } Kind;

static double height_of(Kind kind, double u, double v) {
    if (kind == FLAT) return 1;
    if (kind == NOISE) return uniform(0, 1);
    if (kind == CLIFFS) return sin(2 * PI * 3 * u) * sin(2 * PI * (2 * v + u)) > 0.1 ? 0.95 : 0.2;
    return 0.5 + 0.25 * sin(2 * PI * (u + 0.1)) + 0.25 * cos(2 * PI * (u + v));
}

/* Heights for the truth, in 16 bits as the source has them, and the source made from them. */
typedef struct {
    Image heights;
    Source source;
} Sculpture;

static Sculpture sculpture_new(Kind kind, int width, int height, double scale, double base) {
    Image colour = image_create(width, height, 3), normals = image_create(width, height, 3);
    Sculpture s = {.heights = image_create(width, height, 1)};
    for (int i = 0; i < width * height; i++) {
        double h = height_of(kind, (i % width + 0.5) / width, (i / width + 0.5) / height);
        s.heights.pixels[i] = (float)(floor(65535 * h + 0.5) / 65535);
        for (int c = 0; c < 3; c++) {
            colour.pixels[3 * i + c] = (float)uniform(0, 1);
            normals.pixels[3 * i + c] = (float)uniform(-0.5, 0.5);
        }
    }
    s.source = source_create(&colour, &s.heights, &normals, scale, base);
    image_destroy(&colour);
    image_destroy(&normals);
    return s;
}

static void sculpture_free(Sculpture *s) {
    image_destroy(&s->heights);
    source_destroy(&s->source);
}

/* An eye at up to so many degrees from the normal: near ones 1 to 3 widths away, every other one at infinity.
 */
static Eye random_eye(double degrees, bool near) {
    double theta = radians(uniform(0, degrees)), phi = uniform(0, 2 * PI);
    Vec3 toward = v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
    return near ? (Eye){vec3_scale(toward, uniform(1, 3)), 1} : (Eye){toward, 0};
}

/* ---- The order ---- */

/* When the sheets come to each of columns x rows items; every item once. */
static int *visits(Sheets sheets, int columns, int rows) {
    int *when = calloc((size_t)columns * (size_t)rows, sizeof *when), count = 0;
    for (int i = 0; i < 4; i++) {
        Run row = sheets.rows[i / 2], column = sheets.columns[i % 2];
        for (int y = row.first; y != row.end; y += row.step)
            for (int x = column.first; x != column.end; x += column.step) {
                assert_true(x >= 0 && x < columns && y >= 0 && y < rows);
                assert_int_equal(when[y * columns + x], 0);
                when[y * columns + x] = ++count;
            }
    }
    assert_int_equal(count, columns * rows);
    return when;
}

/* How often a ray from the epipole through the image, in small steps, comes to an item that was painted later
 * than one nearer to the epipole. */
static int disorder(const int *when, int columns, int rows, Vec2 epipole, Vec2 through) {
    Vec2 way = v2(through.x - epipole.x, through.y - epipole.y);
    double length = hypot(way.x, way.y), reach = length + columns + rows;
    int last = 0, bad = 0;
    for (double t = fmax(0, length - columns - rows); t < reach; t += 0.01) {
        double x = floor(epipole.x + t * way.x / length), y = floor(epipole.y + t * way.y / length);
        if (x < 0 || x >= columns || y < 0 || y >= rows) continue;
        int now = when[(int)y * columns + (int)x];
        bad += last != 0 && now > last;
        last = now;
    }
    return bad;
}

static void test_sheets_paint_toward_the_epipole(void **unused) {
    (void)unused;
    const int columns = 9, rows = 7;
    for (int i = 0; i < 400; i++) {
        /* Inside, on edges between items, outside on each side, far away. */
        double reach = i % 4 == 3 ? 1e6 : 12;
        Vec2 epipole = v2(uniform(-reach, columns + reach), uniform(-reach, rows + reach));
        if (i % 4 == 1) epipole = v2(floor(epipole.x), floor(epipole.y));
        Sheets sheets = sheets_toward(epipole, columns, rows), away = sheets;
        int *when = visits(sheets, columns, rows);
        for (int k = 0; k < 2; k++) { /* the same sheets, painted the wrong way */
            Run *runs[] = {&away.rows[k], &away.columns[k]};
            for (int n = 0; n < 2; n++)
                if (runs[n]->first != runs[n]->end)
                    *runs[n] =
                        (Run){runs[n]->end - runs[n]->step, runs[n]->first - runs[n]->step, -runs[n]->step};
        }
        int *backward = visits(away, columns, rows), wrong = 0;
        for (int n = 0; n < 20; n++) {
            Vec2 through = v2(uniform(0, columns), uniform(0, rows));
            assert_int_equal(disorder(when, columns, rows, epipole, through), 0);
            wrong += disorder(backward, columns, rows, epipole, through);
        }
        assert_true(wrong > 20);
        free(when);
        free(backward);
    }
    const Vec2 infinite[] = {{INFINITY, -INFINITY}, {-INFINITY, 0}, {0, INFINITY}, {0, 0}};
    for (int i = 0; i < 4; i++) free(visits(sheets_toward(infinite[i], columns, rows), columns, rows));
}

/* The epipole is where the line through the eye along f meets the plane; seen from infinity, the eye's side.
 */
static void test_epipole(void **unused) {
    (void)unused;
    for (int i = 0; i < 100; i++) {
        Plane plane = {v3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)), v3(1, uniform(-0.3, 0.3), 0),
                       v3(uniform(-0.3, 0.3), 1, 0.2),
                       vec3_normalize(v3(uniform(-0.4, 0.4), 0.3, i % 2 ? 1 : -1))};
        double u = uniform(-2, 3), v = uniform(-2, 3), d = uniform(0.5, 4) * (i % 4 < 2 ? 1 : -1);
        Vec3 foot = vec3_add(plane.origin, vec3_add(vec3_scale(plane.a, u), vec3_scale(plane.b, v)));
        PrewarpFactors k = prewarp_factors(&plane, (Eye){vec3_add(foot, vec3_scale(plane.f, d)), 1});
        Vec2 epipole = sheets_epipole(&k);
        assert_true(fabs(epipole.x - u) < 1e-9 && fabs(epipole.y - v) < 1e-9);
        Vec3 toward =
            vec3_add(vec3_scale(plane.f, d), vec3_add(vec3_scale(plane.a, u), vec3_scale(plane.b, v)));
        k = prewarp_factors(&plane, (Eye){vec3_normalize(toward), 0});
        epipole = sheets_epipole(&k);
        assert_true(epipole.x == (u > 0 ? INFINITY : -INFINITY) &&
                    epipole.y == (v > 0 ? INFINITY : -INFINITY));
    }
}

/* ---- Texels one by one, against brute force ---- */

/* Where the line from the eye through a point meets the plane, as u and v; false if the point is not in
 * front. */
static bool project(const Plane *plane, Eye eye, Vec3 point, Vec2 *out, double *distance) {
    Vec3 n = vec3_cross(plane->a, plane->b);
    Vec3 way = eye.w > 0 ? vec3_sub(point, eye.at) : vec3_scale(eye.at, -1);
    double side = vec3_dot(vec3_sub(plane->origin, point), n), slope = vec3_dot(way, n);
    if (eye.w > 0) {
        double all = vec3_dot(vec3_sub(plane->origin, eye.at), n); /* the plane is at t = all / slope */
        if (slope * all <= 0) return false;
        *distance = slope / all;
        if (*distance <= LANDING_W_MIN) return false;
    } else
        *distance = -side / slope; /* less is nearer, up to a constant, along one line */
    Vec3 q = vec3_sub(vec3_add(point, vec3_scale(way, side / slope)), plane->origin);
    double aa = vec3_dot(plane->a, plane->a), ab = vec3_dot(plane->a, plane->b),
           bb = vec3_dot(plane->b, plane->b);
    double qa = vec3_dot(q, plane->a), qb = vec3_dot(q, plane->b), det = aa * bb - ab * ab;
    *out = v2((qa * bb - qb * ab) / det, (qb * aa - qa * ab) / det);
    return true;
}

static Vec3 point_of(const Source *source, int x, int y) {
    double d = source->scale * (source->levels[y * source->width + x] / 65535.0 - source->base);
    const Plane *p = &source->plane;
    Vec3 foot = vec3_add(p->origin, vec3_add(vec3_scale(p->a, (x + 0.5) / source->width),
                                             vec3_scale(p->b, (y + 0.5) / source->height)));
    return vec3_add(foot, vec3_scale(p->f, d));
}

/* The greatest step from a texel's level to a neighbour's. */
static int rise_of(const Source *source, int x, int y) {
    int most = 0, here = source->levels[y * source->width + x];
    for (int k = 0; k < 9; k++) {
        int i = x + k % 3 - 1, j = y + k / 3 - 1;
        if (i < 0 || j < 0 || i >= source->width || j >= source->height) continue;
        int step = abs(source->levels[j * source->width + i] - here);
        most = step > most ? step : most;
    }
    return most;
}

typedef struct {
    int filled, strangers,
        hidden;          /* of the destination's texels: with something that did not land there, and with
                            something that a texel nearer to the eye by more than their rises hides */
    int behind, outside; /* texels of the source */
} Verdict;

static Verdict judge(const Source *source, Eye eye, const Destination *destination) {
    int width = source->width, height = source->height, count = destination->width * destination->height;
    Verdict verdict = {0};
    int *nearest = malloc((size_t)count * sizeof *nearest);
    double *least = malloc((size_t)count * sizeof *least);
    int *landed = calloc((size_t)width * (size_t)height, sizeof *landed);
    for (int i = 0; i < count; i++) nearest[i] = -1;
    for (int i = 0; i < width * height; i++) {
        Vec2 at;
        double distance;
        landed[i] = -1;
        if (!project(&source->plane, eye, point_of(source, i % width, i / width), &at, &distance)) {
            verdict.behind++;
            continue;
        }
        double x = floor((at.x - destination->low.x) / (destination->high.x - destination->low.x) *
                         destination->width);
        double y = floor((at.y - destination->low.y) / (destination->high.y - destination->low.y) *
                         destination->height);
        if (!(x >= 0 && x < destination->width && y >= 0 && y < destination->height)) {
            verdict.outside++;
            continue;
        }
        int to = landed[i] = (int)y * destination->width + (int)x;
        if (nearest[to] < 0 || distance < least[to]) nearest[to] = i, least[to] = distance;
    }
    for (int i = 0; i < count; i++) {
        if (destination->texels[i].colour[3] == 0) continue;
        verdict.filled++;
        const float *lookup = destination->lookup + 3 * i;
        int x = (int)(lookup[0] * (float)width), y = (int)(lookup[1] * (float)height), from = y * width + x;
        if (landed[from] != i || nearest[i] < 0) {
            verdict.strangers++;
            continue;
        }
        int gap = abs(source->levels[nearest[i]] - source->levels[from]);
        int rises = rise_of(source, x, y) + rise_of(source, nearest[i] % width, nearest[i] / width);
        verdict.hidden += gap > rises;
    }
    free(nearest);
    free(least);
    free(landed);
    return verdict;
}

/* Skew a, b and f, both bases, eyes near and infinitely far, in front and behind. In floats a texel in ten
 * thousand lands beside the border of two. */
static void test_texels_land_and_the_nearest_stays(void **unused) {
    (void)unused;
    int filled = 0, strangers = 0, hidden = 0, swapped = 0, mirrored = 0, texels = 0, lost = 0;
    for (int i = 0; i < 96; i++) {
        Sculpture s = sculpture_new(1 + i % 2, 61 + i % 5, 47, 0.1, i / 4 % 2);
        Plane *plane = &s.source.plane;
        if (i % 3 == 1)
            *plane = (Plane){v3(0.2, -0.5, 0.1), v3(1, 0.1, 0), v3(0.3, 0.9, 0.1),
                             vec3_normalize(v3(0.2, -0.3, i % 2 ? -1 : 1))};
        Eye eye = random_eye(60, i / 2 % 2);
        if (i % 7 == 6) eye.at = vec3_scale(eye.at, -1);
        PrewarpFactors k = prewarp_factors(plane, eye), swap = k, mirror = k;
        swap.k1 = k.k2, swap.k2 = k.k1;
        mirror.k1 = -k.k1;
        Destination d = destination_create(53, 59, v2(i % 5 ? 0 : -0.25, 0), v2(1, i % 5 ? 1 : 1.25), true);
        WarpCounts counts;
        warp_forward(&s.source, &k, VISIBILITY_OCCLUSION_ORDER, FILLING_NONE, &d, &counts);
        Verdict v = judge(&s.source, eye, &d);
        filled += v.filled, strangers += v.strangers, hidden += v.hidden,
            texels += s.source.width * s.source.height;
        lost += abs(counts.behind - v.behind) + abs(counts.outside - v.outside);
        warp_forward(&s.source, &swap, VISIBILITY_OCCLUSION_ORDER, FILLING_NONE, &d, NULL);
        swapped += judge(&s.source, eye, &d).strangers;
        warp_forward(&s.source, &mirror, VISIBILITY_OCCLUSION_ORDER, FILLING_NONE, &d, NULL);
        mirrored += judge(&s.source, eye, &d).strangers;
        destination_destroy(&d);
        sculpture_free(&s);
    }
    print_message(
        "# of %d: %d strangers, %d hidden; %d with k1 and k2 swapped, %d with k1 negative; lost %d of %d\n",
        filled, strangers, hidden, swapped, mirrored, lost, texels);
    assert_true(filled > 100000);
    assert_true(strangers <= filled / 10000);
    assert_true(hidden <= filled / 1000);
    assert_true(lost <= texels / 10000);
    assert_true(swapped > filled / 4 && mirrored > filled / 4);
}

/* ---- Filled cells, against exact rays ---- */

typedef struct {
    int hits, holes, wrong; /* wrong: more than a texel from what the ray meets */
} Comparison;

static Comparison compare(const Sculpture *s, Eye eye, const Destination *d) {
    Relief relief = {&s->heights, 1, s->source.aspect, s->source.scale, s->source.base, RELIEF_CUT};
    Comparison c = {0};
    for (int i = 0; i < d->width * d->height; i++) {
        double u = (i % d->width + 0.5) / d->width, v = (i / d->width + 0.5) / d->height;
        Vec3 p = v3(u - 0.5, (v - 0.5) * s->source.aspect, 0);
        Ray ray = {vec3_add(p, vec3_scale(eye.at, 4)), vec3_scale(eye.at, -1)};
        if (eye.w > 0) ray = (Ray){eye.at, vec3_normalize(vec3_sub(p, eye.at))};
        Sample exact = truth_relief(&relief, ray);
        if (!exact.hit) continue;
        c.hits++;
        if (!d->texels[i].colour[3]) {
            c.holes++;
            continue;
        }
        const float *lookup = d->lookup + 3 * i;
        c.wrong +=
            hypot((lookup[0] - exact.u) * s->source.width, (lookup[1] - exact.v) * s->source.height) > 1;
    }
    return c;
}

static void test_cells_leave_no_holes(void **unused) {
    (void)unused;
    const int sizes[][2] = {{48, 48}, {37, 53}, {1, 40}, {40, 1}, {1, 1}, {2, 2}, {9, 200}};
    Comparison all = {0}, swapped = {0};
    for (int i = 0; i < 7 * KINDS * 4; i++) {
        const int *size = sizes[i % 7];
        Sculpture s = sculpture_new(i / 7 % KINDS, size[0], size[1], i / 28 % 2 ? 0.1 : 0.05, i / 56 % 2);
        Eye eye = random_eye(75, i % 2);
        PrewarpFactors k = prewarp_factors(&s.source.plane, eye);
        Destination d = destination_create(size[0] + i % 3, size[1], v2(0, 0), v2(1, 1), true);
        warp_forward(&s.source, &k, VISIBILITY_OCCLUSION_ORDER, FILLING_LINEAR, &d, NULL);
        Comparison c = compare(&s, eye, &d);
        all.hits += c.hits, all.holes += c.holes, all.wrong += c.wrong;
        double k1 = k.k1;
        k.k1 = k.k2, k.k2 = k1;
        warp_forward(&s.source, &k, VISIBILITY_OCCLUSION_ORDER, FILLING_LINEAR, &d, NULL);
        swapped.wrong += compare(&s, eye, &d).wrong;
        destination_destroy(&d);
        sculpture_free(&s);
    }
    print_message("# of %d hits: %d holes, %d wrong; %d wrong with k1 and k2 swapped\n", all.hits, all.holes,
                  all.wrong, swapped.wrong);
    assert_true(all.hits > 50000);
    assert_int_equal(all.holes, 0);
    assert_true(all.wrong <= all.hits / 100);
    assert_true(swapped.wrong > all.hits / 4);
}

/* Seen straight on from infinity, or where all is in the plane, texels stay where they are, to the byte. */
static void test_what_does_not_move(void **unused) {
    (void)unused;
    for (int i = 0; i < 12; i++) {
        bool flat = i % 2;
        Sculpture s = sculpture_new(flat ? FLAT : NOISE, 1 + i * 5, 1 + i % 4 * 9, 0.1, 1);
        PrewarpFactors k =
            prewarp_factors(&s.source.plane, flat ? random_eye(75, i % 4 == 1) : (Eye){{0, 0, 1}, 0});
        Destination d = destination_create(s.source.width, s.source.height, v2(0, 0), v2(1, 1), false);
        for (Filling filling = FILLING_NONE; filling <= FILLING_LINEAR; filling++) {
            warp_forward(&s.source, &k, VISIBILITY_OCCLUSION_ORDER, filling, &d, NULL);
            int worst = 0;
            for (int n = 0; n < d.width * d.height; n++)
                for (int c = 0; c < 4; c++) {
                    int colour = abs(d.texels[n].colour[c] - s.source.texels[n].colour[c]);
                    int normal = abs(d.texels[n].normal[c] - s.source.texels[n].normal[c]);
                    worst = colour > worst ? colour : normal > worst ? normal : worst;
                }
            /* In floats an origin may be 1/256 of a texel off, and so a byte one. */
            assert_true(worst <= (filling == FILLING_NONE ? 0 : 2));
        }
        destination_destroy(&d);
        sculpture_free(&s);
    }
}

/* ---- Bad eyes ---- */

/* A destination in the middle of memory that must stay as it is. */
static void test_nothing_outside_is_written(void **unused) {
    (void)unused;
    enum { SIDE = 24, BEFORE = 4096 };
    Texel *memory = malloc((SIDE * SIDE + 2 * BEFORE) * sizeof *memory);
    memset(memory, 0x5a, (SIDE * SIDE + 2 * BEFORE) * sizeof *memory);
    for (int i = 0; i < 300; i++) {
        Sculpture s = sculpture_new(i % KINDS, 33, 21, i % 5 ? 0.1 : 3, i / 2 % 2);
        double height = i % 3 == 0 ? uniform(0, 0.1) : i % 3 == 1 ? pow(10, uniform(-9, 0)) : uniform(-2, 2);
        Eye eye = {v3(uniform(-0.6, 0.6), uniform(-0.4, 0.4), height), i % 4 == 3 ? 0 : 1};
        PrewarpFactors k = prewarp_factors(&s.source.plane, eye);
        Destination d = {SIDE, SIDE, v2(0.1, 0.2), v2(0.9, 1.1), memory + BEFORE, NULL};
        for (int way = 0; way < 4; way++) {
            warp_forward(&s.source, &k, way % 2 ? VISIBILITY_DEPTH_BUFFER : VISIBILITY_OCCLUSION_ORDER,
                         way / 2 ? FILLING_LINEAR : FILLING_NONE, &d, NULL);
            for (int n = 0; n < SIDE * SIDE; n++)
                assert_true(d.texels[n].colour[3] == 0 || d.texels[n].colour[3] == 255);
        }
        sculpture_free(&s);
    }
    for (int i = 0; i < 2 * BEFORE; i++) {
        const uint8_t *bytes = memory[i < BEFORE ? i : i + SIDE * SIDE].colour;
        for (int c = 0; c < 8; c++) assert_int_equal(bytes[c], 0x5a);
    }
    free(memory);
}

static void test_an_eye_in_the_plane_sees_nothing(void **unused) {
    (void)unused;
    Sculpture s = sculpture_new(NOISE, 8, 8, 0.1, 1);
    Destination d = destination_create(8, 8, v2(0, 0), v2(1, 1), true);
    PrewarpFactors k = prewarp_factors(&s.source.plane, (Eye){{3, 1, 0}, 1});
    assert_false(k.possible);
    for (Filling filling = FILLING_NONE; filling <= FILLING_LINEAR; filling++) {
        memset(d.texels, 0xff, 64 * sizeof *d.texels);
        WarpCounts counts = {1, 1};
        warp_forward(&s.source, &k, VISIBILITY_OCCLUSION_ORDER, filling, &d, &counts);
        assert_int_equal(counts.behind, 64);
        assert_int_equal(counts.outside, 0);
        for (int i = 0; i < 64; i++) assert_int_equal(d.texels[i].colour[3], 0);
    }
    destination_destroy(&d);
    sculpture_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sheets_paint_toward_the_epipole),
        cmocka_unit_test(test_epipole),
        cmocka_unit_test(test_texels_land_and_the_nearest_stays),
        cmocka_unit_test(test_cells_leave_no_holes),
        cmocka_unit_test(test_what_does_not_move),
        cmocka_unit_test(test_nothing_outside_is_written),
        cmocka_unit_test(test_an_eye_in_the_plane_sees_nothing),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson 16: the forward warp", tests, NULL, NULL);
}
