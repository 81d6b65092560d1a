/* The light of a scene along rays whose answer is known by hand, and where the scenes' solids lie. */
#include "light_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <string.h>

#include "random.h" /* behind cmocka.h */

static const Solid ball = {SOLID_SPHERE, {2, 2, 2}, {0, 0, 0}, {0, 0, 0}, {0.5, 0.25, 1}};

static Solid ball_at(double x, double y, double z, Vec3 colour) {
    Solid solid = ball;
    solid.centre = v3(x, y, z), solid.colour = colour;
    return solid;
}

/* The light back from `from` along `way` must be base * colour + white. */
static void expect(const LightScene *scene, Vec3 from, Vec3 way, Vec3 colour, double base, double white) {
    SolidHit hit;
    bool met;
    Vec3 light = light_along(scene, (Ray){from, way}, &hit, &met);
    assert_true(met);
    near(light.x, base * colour.x + white, 1e-12), near(light.y, base * colour.y + white, 1e-12);
    near(light.z, base * colour.z + white, 1e-12);
}

/* A ball of radius 1, lit from +x. */
static void test_ball(void **state) {
    (void)state;
    LightScene scene = {.count = 1, .solids = {ball}, .toward_light = {1, 0, 0}};
    Vec3 c = ball.colour, in = {0, 0, -1};
    expect(&scene, v3(5, 0, 0), v3(-1, 0, 0), c, 0.7, 0.3); /* N = L = V = R */
    expect(&scene, v3(0, 0, 5), in, c, 0.15, 0);            /* N.L = 0 */
    expect(&scene, v3(-5, 0, 0), v3(1, 0, 0), c, 0.15, 0);  /* behind */
    expect(&scene, v3(-0.6, 0, 5), in, c, 0.15, 0);         /* N.L = -0.6 */
    double r = sqrt(0.5);                                   /* 45 degrees: R = (0, 0, 1) = V */
    expect(&scene, v3(r, 0, 5), in, c, 0.15 + 0.55 * r, 0.3);
    expect(&scene, v3(0.6, 0, 5), in, c, 0.15 + 0.55 * 0.6, 0.3 * pow(0.96, 32)); /* R = (-0.28, 0, 0.96) */
    expect(&scene, v3(0.28, 0.96, 5), in, c, 0.15 + 0.55 * 0.28, 0);              /* R.V = 0 */
    SolidHit hit;
    bool met = true;
    Vec3 light = light_along(&scene, (Ray){{0, 2, 5}, in}, &hit, &met);
    assert_false(met);
    near(vec3_length(light), 0, 0);
}

static void test_shadow(void **state) {
    (void)state;
    Vec3 red = {1, 0, 0};
    for (int before = 0; before < 2; before++) {
        LightScene scene = {.count = 2, .toward_light = {1, 0, 0}};
        scene.solids[before] = ball, scene.solids[!before] = ball_at(10, 0, 0, red);
        Vec3 from = {0.6, 0, 5}, in = {0, 0, -1}; /* the lit point is (0.6, 0, 0.8), behind the red ball */
        double lit = 0.55 * 0.6, highlight = 0.3 * pow(0.96, 32);
        expect(&scene, from, in, ball.colour, 0.15 + lit, highlight); /* no effects: no shadow */
        scene.effects = true;
        expect(&scene, from, in, ball.colour, 0.15, 0);
        scene.clear[!before] = 0.25;
        expect(&scene, from, in, ball.colour, 0.15 + 0.25 * lit, 0.25 * highlight);
        scene.solids[!before].centre.x = -10; /* on the far side of the light */
        expect(&scene, from, in, ball.colour, 0.15 + lit, highlight);
        scene.solids[!before].centre = v3(10, 0, 2.5); /* beside */
        expect(&scene, from, in, ball.colour, 0.15 + lit, highlight);
    }
}

/* A white ball mirrors a red one behind the ray's origin, once. Both show sides where N.L = 0. */
static void test_mirror(void **state) {
    (void)state;
    LightScene scene = {.count = 2, .toward_light = {1, 0, 0}, .effects = true};
    scene.solids[0] = ball_at(0, 0, 0, v3(1, 1, 1)), scene.solids[1] = ball_at(0, 0, 8, v3(1, 0, 0));
    scene.mirror[0] = 0.6, scene.mirror[1] = 0.9; /* of what is mirrored nothing is mirrored again */
    expect(&scene, v3(0, 0, 4), v3(0, 0, -1), v3(1, 0.4, 0.4), 0.15, 0);
    /* At N = (0.6, 0, 0.8), 0.28 of the way goes back and 0.96 toward +x: nothing is there. */
    expect(&scene, v3(0.6, 0, 4), v3(0, 0, -1), v3(1, 1, 1), 0.4 * (0.15 + 0.55 * 0.6),
           0.4 * 0.3 * pow(0.96, 32));
    scene.solids[1] = ball_at(0.6 + 9.6, 0, 0.8 + 2.8, v3(0, 1, 0)); /* ... until it is, its unlit side */
    expect(&scene, v3(0.6, 0, 4), v3(0, 0, -1), v3(0, 0.6, 0), 0.15,
           0.4 * (0.15 + 0.55 * 0.6 + 0.3 * pow(0.96, 32)));
}

static void test_clear(void **state) {
    (void)state;
    LightScene scene = {.count = 2, .toward_light = {1, 0, 0}, .effects = true};
    scene.solids[0] = ball_at(0, 0, 0, v3(1, 1, 1));
    scene.solids[1] = (Solid){SOLID_BOX, {1, 1, 1}, {0, 0, 5}, {0, 0, 0}, {1, 1, 0}};
    scene.clear[1] = 0.5;
    expect(&scene, v3(0, 0, 9), v3(0, 0, -1), v3(1, 1, 0.5), 0.15, 0);
    /* What is mirrored behind something clear is that, and through it nothing: mirrored rays see it as well.
     */
    scene.mirror[0] = 0.5; /* white: half its own, half the box's back, which is half clear onto nothing */
    Vec3 mixed = {0.5 + 0.5 * (0.5 + 0.5 * 0.5), 0.5 + 0.5 * (0.5 + 0.5 * 0.5), 0.5 * 0.5};
    expect(&scene, v3(0, 0, 9), v3(0, 0, -1), mixed, 0.15, 0);
    scene.effects = false;
    expect(&scene, v3(0, 0, 9), v3(0, 0, -1), v3(1, 1, 0), 0.15, 0);
}

/* Each solid, sampled: a point in one is in no other, and on the right side of the model of radius 3.5. */
static bool is_in(const Solid *solid, Vec3 p) {
    p = vec3_sub(p, solid->centre);
    double a = radians(-solid->turn_degrees.x);
    p = v3(p.x, cos(a) * p.y - sin(a) * p.z, sin(a) * p.y + cos(a) * p.z);
    assert_true(solid->turn_degrees.y == 0 && solid->turn_degrees.z == 0);
    Vec3 half = vec3_scale(solid->size, 0.5);
    if (solid->kind == SOLID_SPHERE) return vec3_length(p) < half.x;
    if (solid->kind == SOLID_CYLINDER) return hypot(p.x, p.z) < half.x && fabs(p.y) < half.y;
    return fabs(p.x) < half.x && fabs(p.y) < half.y && fabs(p.z) < half.z;
}

static void test_apart(void **state) {
    (void)state;
    const LightScene *const scenes[] = {&light_composed, &light_effects, &light_aliasing, &light_placements,
                                        &light_around};
    const char *const names[] = {"composed", "effects", "aliasing", "placements", "around"};
    for (int k = 0; k < 5; k++) {
        assert_ptr_equal(light_scene_named(names[k]), scenes[k]);
        for (int i = 0; i < scenes[k]->count; i++)
            for (int n = 0, inside = 0; n < 40000; n++) {
                Vec3 p = vec3_add(scenes[k]->solids[i].centre, random_vector(-1.05, 1.05));
                if (!is_in(&scenes[k]->solids[i], p)) continue;
                inside++;
                for (int j = 0; j < scenes[k]->count; j++)
                    if (j != i && is_in(&scenes[k]->solids[j], p))
                        fail_msg("%s: solids %d and %d overlap at %g %g %g", names[k], i, j, p.x, p.y, p.z);
                if (k < 3) assert_true(vec3_length(p) < 3.5);
                if (k == 4) assert_true(vec3_length(p) > 3.5);
                if (n > 39000) assert_true(inside > 1000);
            }
    }
    assert_null(light_scene_named("none"));
}

/* The composed scene, solid by solid, as its table has it. */
static void test_composed(void **state) {
    (void)state;
    static const Solid table[] = {
        {SOLID_SPHERE, {1, 1, 1}, {0, 0, 0}, {0, 0, 0}, {1, 1, 1}},
        {SOLID_SPHERE, {1, 1, 1}, {0, 0, -1.87}, {0, 0, 0}, {1, 0, 0}},
        {SOLID_CYLINDER, {1, 2, 1}, {2.62, 0, 0}, {0, 0, 0}, {0.5, 0, 0.5}},
        {SOLID_CYLINDER, {1, 2, 1}, {-1.07, -0.41, 1.81}, {90, 0, 0}, {0, 0, 1}},
        {SOLID_CYLINDER, {1, 2, 1}, {0.87, 0.76, 2.06}, {0, 0, 0}, {0, 0, 0}},
        {SOLID_BOX, {1, 1, 1}, {-1.2, 0.71, -0.68}, {0, 0, 0}, {0, 1, 0}},
        {SOLID_BOX, {1, 1, 1}, {1.47, -1.05, 0.93}, {0, 0, 0}, {1, 1, 0}},
    };
    const LightScene *const both[] = {&light_composed, &light_effects};
    for (int k = 0; k < 2; k++) {
        assert_int_equal(both[k]->count, 7);
        assert_memory_equal(&both[k]->toward_light, &((Vec3){1, 0, 0}), sizeof(Vec3));
        assert_int_equal(both[k]->effects, k);
        for (int i = 0; i < 7; i++) {
            const Solid *solid = &both[k]->solids[i], *own = &table[i];
            assert_int_equal(solid->kind, own->kind);
            assert_memory_equal(&solid->size, &own->size, sizeof(Vec3));
            assert_memory_equal(&solid->centre, &own->centre, sizeof(Vec3));
            assert_memory_equal(&solid->turn_degrees, &own->turn_degrees, sizeof(Vec3));
            assert_memory_equal(&solid->colour, &own->colour, sizeof(Vec3));
        }
    }
    /* The aliasing cylinder stands on one side, within the sphere of diameter 7. */
    const Solid *alone = &light_aliasing.solids[0];
    assert_true(light_aliasing.count == 1 && alone->kind == SOLID_CYLINDER);
    assert_memory_equal(&alone->size, &((Vec3){1, 2, 1}), sizeof(Vec3));
    assert_true(alone->centre.x == 0 && alone->centre.y == 0 && alone->centre.z > 2);
    assert_true(hypot(alone->centre.z + 0.5, 1) < 3.5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ball),  cmocka_unit_test(test_shadow), cmocka_unit_test(test_mirror),
        cmocka_unit_test(test_clear), cmocka_unit_test(test_apart),  cmocka_unit_test(test_composed),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("light_scene", tests, NULL, NULL);
}
