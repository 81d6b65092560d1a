/* Where rays meet solids: against points chosen on them first, against a brute march through functions that
 * only say inside or outside, and at the places where textbook formulas break. */
#include "solid.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdint.h>

#include "random.h" /* behind cmocka.h */

static Solid random_solid(SolidKind kind) {
    return (Solid){.kind = kind,
                   .size = random_vector(0.2, 2),
                   .centre = random_vector(-3, 3),
                   .turn_degrees = random_vector(-180, 180)};
}

/* ---- Turning, written once more: Rodrigues' formula about each axis in its turn ---- */

static Vec3 turned_about(Vec3 p, Vec3 axis, double degrees) {
    double c = cos(radians(degrees)), s = sin(radians(degrees));
    Vec3 along = vec3_scale(axis, vec3_dot(axis, p) * (1 - c));
    return vec3_add(vec3_add(vec3_scale(p, c), vec3_scale(vec3_cross(axis, p), s)), along);
}

static Vec3 turned(const Solid *solid, Vec3 p) {
    p = turned_about(p, v3(1, 0, 0), solid->turn_degrees.x);
    p = turned_about(p, v3(0, 1, 0), solid->turn_degrees.y);
    return turned_about(p, v3(0, 0, 1), solid->turn_degrees.z);
}

static Vec3 turned_back(const Solid *solid, Vec3 p) {
    p = turned_about(p, v3(0, 0, 1), -solid->turn_degrees.z);
    p = turned_about(p, v3(0, 1, 0), -solid->turn_degrees.y);
    return turned_about(p, v3(1, 0, 0), -solid->turn_degrees.x);
}

static bool is_inside(const Solid *solid, Vec3 world) {
    Vec3 p = turned_back(solid, vec3_sub(world, solid->centre)), half = vec3_scale(solid->size, 0.5);
    switch (solid->kind) {
    case SOLID_SPHERE: return vec3_length(p) <= half.x;
    case SOLID_CYLINDER: return hypot(p.x, p.z) <= half.x && fabs(p.y) <= half.y;
    case SOLID_BOX: return fabs(p.x) <= half.x && fabs(p.y) <= half.y && fabs(p.z) <= half.z;
    }
    return false;
}

/* ---- Points chosen first ---- */

/* A random point of the surface, not quite at an edge, and the normal there, in the solid's own axes. */
static void random_surface(const Solid *solid, Vec3 *point, Vec3 *normal) {
    Vec3 half = vec3_scale(solid->size, 0.5), p = random_vector(-0.999, 0.999);
    double theta = random_in(-PI, PI), side = random_in(-1, 1) < 0 ? -1 : 1;
    int face = (int)random_in(0, 3);
    switch (solid->kind) {
    case SOLID_SPHERE:
        *normal = random_direction();
        *point = vec3_scale(*normal, half.x);
        return;
    case SOLID_CYLINDER:
        *normal = face ? v3(sin(theta), 0, cos(theta)) : v3(0, side, 0);
        *point = vec3_scale(v3(sin(theta), 0, cos(theta)), half.x * (face ? 1 : fabs(p.x)));
        point->y = half.y * (face ? p.y : side);
        return;
    case SOLID_BOX:
        *normal = v3(face == 0 ? side : 0, face == 1 ? side : 0, face == 2 ? side : 0);
        if (face == 0) p.x = side;
        if (face == 1) p.y = side;
        if (face == 2) p.z = side;
        *point = vec3_multiply(p, half);
        return;
    }
}

/* From outside, at `distance`, the first point met is the one aimed at; from there on inward it is seen again
 * from inside. A crossing at the angle asin(cosine) to the surface magnifies errors of position by 1 /
 * cosine. */
static void check_points(double distance, double bound) {
    for (int i = 0; i < 30000; i++) {
        Solid solid = random_solid((SolidKind)(i % 3));
        Vec3 point, normal, way = random_direction();
        random_surface(&solid, &point, &normal);
        point = vec3_add(turned(&solid, point), solid.centre), normal = turned(&solid, normal);
        if (vec3_dot(way, normal) > 0) way = vec3_scale(way, -1);
        double cosine = -vec3_dot(way, normal);
        if (cosine < 0.01) continue;

        SolidHit hit;
        Ray ray = {vec3_sub(point, vec3_scale(way, distance)), way};
        assert_true(solids_hit(&solid, 1, ray, &hit));
        near(hit.depth, distance, bound / cosine);
        near(vec3_length(vec3_sub(hit.normal, normal)), 0,
             bound / cosine / 0.1); /* 0.1: the smallest radius */

        Ray away = {vec3_add(point, vec3_scale(way, distance)), way}; /* it has left every solid of ours */
        if (distance > 4) assert_false(solids_hit(&solid, 1, away, &hit));
    }
}

static void test_points(void **state) {
    (void)state;
    check_points(5, 1e-14);
    check_points(1e6, 1e-9);
}

/* A point inside sees the surface all around, where the surface is. */
static void test_from_inside(void **state) {
    (void)state;
    for (int i = 0; i < 30000; i++) {
        Solid solid = random_solid((SolidKind)(i % 3));
        Vec3 half = vec3_scale(solid.size, 0.5), at = vec3_multiply(random_vector(-0.5, 0.5), half);
        if (solid.kind == SOLID_SPHERE) at = vec3_scale(random_vector(-0.5, 0.5), half.x);
        if (solid.kind == SOLID_CYLINDER) at.z *= half.x / half.z;
        Ray ray = {vec3_add(turned(&solid, at), solid.centre), random_direction()};
        SolidHit hit;
        assert_true(is_inside(&solid, ray.origin));
        assert_true(solids_hit(&solid, 1, ray, &hit));
        assert_true(vec3_dot(hit.normal, ray.direction) > 0);
        assert_true(is_inside(&solid, ray_at(ray, hit.depth - 1e-10)));
        assert_false(is_inside(&solid, ray_at(ray, hit.depth + 1e-10 / vec3_dot(hit.normal, ray.direction))));
        near(vec3_length(hit.normal), 1, 1e-15);
    }
}

/* Where a wire, a million times as long as thick, is met far from its middle, it is thin there too. */
static void test_wire(void **state) {
    (void)state;
    const Solid wire = {.kind = SOLID_CYLINDER, .size = {2, 2e6, 0}};
    for (int i = 0; i < 1000; i++) {
        double theta = random_in(-PI, PI), distance = 10;
        Vec3 point = v3(sin(theta), random_in(-1e6, 1e6), cos(theta));
        Vec3 way = vec3_normalize(v3(-sin(theta), random_in(-1, 1), -cos(theta)));
        SolidHit hit;
        assert_true(solids_hit(&wire, 1, (Ray){vec3_sub(point, vec3_scale(way, distance)), way}, &hit));
        near(hit.depth, distance, 1e-9); /* 1e6 is stored within 1e-10 */
    }
}

/* ---- A march that knows nothing of spans ---- */

enum { SOLIDS = 5, STEPS = 2000 };

/* The solid that the ray, which begins outside all, first gets into, and where: steps, then halving. -1:
 * none. */
static int march(const Solid *solids, Ray ray, double step, double *depth) {
    for (int k = 1; k <= STEPS; k++)
        for (int i = 0; i < SOLIDS; i++) {
            if (!is_inside(&solids[i], ray_at(ray, k * step))) continue;
            double low = (k - 1) * step, high = k * step;
            for (int n = 0; n < 50; n++) {
                double middle = (low + high) / 2;
                if (is_inside(&solids[i], ray_at(ray, middle)))
                    high = middle;
                else
                    low = middle;
            }
            *depth = high;
            return i;
        }
    return -1;
}

/* Where they differ, the ray must be one that no march of this step can decide: inside a solid for less than
 * a step, or into two of them within one step. */
static void test_march(void **state) {
    (void)state;
    const double step = 20.0 / STEPS;
    int hits = 0, misses = 0, undecided = 0;
    for (int n = 0; n < 1000; n++) {
        Solid solids[SOLIDS];
        for (int i = 0; i < SOLIDS; i++) solids[i] = random_solid((SolidKind)random_in(0, 3));
        Vec3 from = vec3_scale(random_direction(), 8),
             to = vec3_add(solids[n % SOLIDS].centre, random_vector(-0.7, 0.7));
        Ray ray = {from, vec3_normalize(vec3_sub(to, from))};
        double depth = 0;
        int index = march(solids, ray, step, &depth);
        SolidHit hit = {.index = -1};
        assert_true(solids_hit(solids, SOLIDS, ray, &hit) == (hit.index >= 0));
        if (hit.index == index && index >= 0) {
            near(hit.depth, depth, 1e-9);
            hits++;
        } else if (hit.index == index) {
            misses++;
        } else {
            /* What was found must be there, and no later than what the march found. */
            assert_true(hit.index >= 0 && (index < 0 || hit.depth < depth + step));
            Vec3 within = vec3_sub(ray_at(ray, hit.depth), vec3_scale(hit.normal, 1e-10));
            assert_true(is_inside(&solids[hit.index], within));
            undecided++;
        }
    }
    assert_true(hits > 500 && misses > 250 && undecided < 5);
}

/* ---- The special cases ---- */

static SolidHit met(Solid solid, Vec3 origin, Vec3 direction) {
    SolidHit hit;
    assert_true(solids_hit(&solid, 1, (Ray){origin, direction}, &hit));
    return hit;
}

static void passed(Solid solid, Vec3 origin, Vec3 direction) {
    SolidHit hit = {.index = 7};
    assert_false(solids_hit(&solid, 1, (Ray){origin, direction}, &hit));
    assert_int_equal(hit.index, 7); /* as it was */
}

static const Solid ball = {.kind = SOLID_SPHERE, .size = {2, 0, 0}};
static const Solid can = {.kind = SOLID_CYLINDER, .size = {2, 3, 0}};
static const Solid brick = {.kind = SOLID_BOX, .size = {2, 3, 4}};

static void test_along_axes(void **state) {
    (void)state;
    near(met(ball, v3(0, 0, 5), v3(0, 0, -1)).depth, 4, 0);
    near(met(can, v3(0, 5, 0), v3(0, -1, 0)).depth, 3.5, 0); /* along its axis */
    near(met(can, v3(0.5, 5, 0.5), v3(0, -1, 0)).normal.y, 1, 0);
    near(met(can, v3(5, 1, 0), v3(-1, 0, 0)).depth, 4, 0);
    near(met(can, v3(0, 0, 0), v3(0, 1, 0)).depth, 1.5, 0); /* from inside */
    near(met(brick, v3(0.3, 5, 0), v3(0, -1, 0)).depth, 3.5, 0);
    near(met(brick, v3(0.3, 0.2, 0), v3(0, 0, 1)).depth, 2, 0);
    near(met(brick, v3(0.3, 0.2, 9), v3(0, 0, -1)).normal.z, 1, 0);
    passed(ball, v3(0, 0, 5), v3(0, 0, 1)); /* behind */
    passed(can, v3(0, 5, 0), v3(0, 1, 0));
    passed(brick, v3(0.3, 5, 0), v3(0, 1, 0));
    passed(can, v3(1.0001, 5, 0), v3(0, -1, 0)); /* beside, along the axis */
    passed(brick, v3(1.0001, 5, 0), v3(0, -1, 0));
    passed(can, v3(5, 1.5001, 0), v3(-1, 0, 0)); /* above */
}

/* Directions all but along an axis, whose a is 1e-20 down to what underflows: caps, not the side, are met. */
static void test_all_but_parallel(void **state) {
    (void)state;
    for (double tilt = 1e-10; tilt > 0; tilt *= 1e-5) {
        near(met(can, v3(0.5, 5, 0), v3(tilt, -1, tilt)).depth, 3.5, 1e-9);
        near(met(can, v3(0.5, 5, 0), v3(tilt, -1, tilt)).normal.y, 1, 0);
        near(met(brick, v3(0.5, 5, 0), v3(tilt, -1, -tilt)).depth, 3.5, 1e-9);
        near(met(brick, v3(0, 0, 0), v3(tilt, -1, -tilt)).depth, 1.5, 1e-9);
        near(met(can, v3(5, 0, 0), v3(-1, tilt, 0)).depth, 4, 1e-9);
        passed(can, v3(1.5, 5, 0), v3(tilt, -1, 0));
        passed(brick, v3(1.5, 5, 0), v3(-tilt, -1, tilt));
    }
    /* Turned by a quarter, its axis lies along z but for 6e-17. */
    Solid lying = can;
    lying.turn_degrees = v3(90, 0, 0);
    near(met(lying, v3(0.3, 0.4, 9), v3(0, 0, -1)).depth, 7.5, 1e-15);
    near(met(lying, v3(0.3, 0.4, 9), v3(0, 0, -1)).normal.z, 1, 1e-15);
}

/* A ray that grazes is met just inside the edge and passes just outside, by hundredths of a millionth. */
static void test_tangents(void **state) {
    (void)state;
    const double in = 1 - 1e-12, out = 1 + 1e-12;
    near(met(ball, v3(in, 0, 5), v3(0, 0, -1)).depth, 5 - sqrt((1 - in) * (1 + in)), 1e-10);
    passed(ball, v3(out, 0, 5), v3(0, 0, -1));
    near(met(can, v3(in, 0, 5), v3(0, 0, -1)).normal.x, 1, 1e-5);
    passed(can, v3(out, 0, 5), v3(0, 0, -1));
    near(met(can, v3(in, 5, 0), v3(0, -1, 0)).depth, 3.5, 0); /* down along the side, onto the cap */
    passed(can, v3(out, 5, 0), v3(0, -1, 0));
    near(met(can, v3(5, 1.5 * in, 0), v3(-1, 0, 0)).depth, 4, 1e-15); /* just below the cap */
    passed(can, v3(5, 1.5 * out, 0), v3(-1, 0, 0));
    near(met(brick, v3(5, 1.5, 0), v3(-1, 0, 0)).depth, 4, 0); /* within the plane of a face */
    near(met(brick, v3(1, 5, 0), v3(0, -1, 0)).depth, 3.5, 0);
    near(met(can, v3(5, 1.5, 0), v3(-1, 0, 0)).depth, 4, 0);
    passed(brick, v3(5, 1.5 * out, 0), v3(-1, 0, 0));
    Vec3 shallow = vec3_normalize(v3(-1, -1e-9, 0)); /* onto the cap at a thousandth of a second of arc */
    near(met(can, v3(5, 1.5 + 4.5e-9, 0), shallow).normal.y, 1, 1e-15);
    near(met(can, v3(5, 1.5 + 3.5e-9, 0), shallow).normal.x, 1, 1e-5);
}

/* From on the surface: leaving, it is met there or nowhere; entering, there or on the far side. */
static void test_on_surface(void **state) {
    (void)state;
    const Solid solids[] = {ball, can, brick};
    for (int i = 0; i < 3; i++) {
        near(met(solids[i], v3(1, 0, 0), v3(-1, 0, 0)).depth, 0, 0);
        near(met(solids[i], v3(1, 0, 0), v3(1, 0, 0)).depth, 0, 0);
        near(met(solids[i], v3(1 - 1e-9, 0, 0), v3(-1, 0, 0)).depth, 2 - 1e-9, 1e-15);
        near(met(solids[i], v3(1 + 1e-9, 0, 0), v3(-1, 0, 0)).depth, 1e-9, 1e-15);
        passed(solids[i], v3(1 + 1e-9, 0, 0), v3(1, 0, 0));
    }
}

static void test_nearest_of_many(void **state) {
    (void)state;
    Solid row[3] = {ball, can, brick};
    row[0].centre.z = -10, row[1].centre.z = 10, row[2].centre.z = 0;
    SolidHit hit;
    assert_true(solids_hit(row, 3, (Ray){{0, 0, 20}, {0, 0, -1}}, &hit));
    assert_int_equal(hit.index, 1);
    assert_true(solids_hit(row, 3, (Ray){{0, 0, 5}, {0, 0, -1}}, &hit));
    assert_int_equal(hit.index, 2);
    assert_true(solids_hit(row, 3, (Ray){{0, 0, -5}, {0, 0, -1}}, &hit));
    assert_int_equal(hit.index, 0);
    assert_false(solids_hit(row, 0, (Ray){{0, 0, 5}, {0, 0, -1}}, &hit));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points),
        cmocka_unit_test(test_from_inside),
        cmocka_unit_test(test_wire),
        cmocka_unit_test(test_march),
        cmocka_unit_test(test_along_axes),
        cmocka_unit_test(test_tangents),
        cmocka_unit_test(test_all_but_parallel),
        cmocka_unit_test(test_on_surface),
        cmocka_unit_test(test_nearest_of_many),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("solid", tests, NULL, NULL);
}
