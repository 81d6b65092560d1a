/* A light field's parametrization against geometry: frames, places and angles there and back, the neighbours
 * of a point against where their centres lie, and the order in memory. */
#include "light_field.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "random.h" /* behind cmocka.h */

static const Field sphere = {.model = FIELD_SPHERE, .radius = 3.5, .u = 12, .v = 9, .s = 8, .t = 11};
static const Field can = {
    .model = FIELD_CYLINDER, .radius = 1.5, .height = 4, .u = 10, .v = 9, .s = 8, .t = 11};
static const Field room = {.model = FIELD_ROOM, .radius = 2.5, .u = 14, .v = 8, .s = 13, .t = 8};
static const Field *const models[] = {&sphere, &can, &room};

static void near_vector(Vec3 v, Vec3 expected, double bound) {
    near(v.x, expected.x, bound), near(v.y, expected.y, bound), near(v.z, expected.z, bound);
}

/* Eq. 4 as the paper writes it. */
static void test_frames(void **state) {
    (void)state;
    for (int m = 0; m < 3; m++)
        for (int i = 0; i < 1000; i++) {
            FieldFrame f = field_frame(models[m], random_in(0, 1), random_in(0.001, 0.999));
            Vec3 out = models[m]->model == FIELD_CYLINDER ? v3(f.at.x, 0, f.at.z) : f.at;
            near(vec3_length(out), models[m]->radius, 1e-12);
            Vec3 z = vec3_scale(vec3_normalize(out), models[m]->model == FIELD_ROOM ? -1 : 1);
            Vec3 x = vec3_normalize(vec3_cross(v3(0, 1, 0), z));
            near_vector(f.e_z, z, 1e-12), near_vector(f.e_x, x, 1e-12);
            near_vector(f.e_y, vec3_cross(z, x), 1e-12);
            near(vec3_dot(f.e_x, f.e_y), 0, 1e-12), near(vec3_length(f.e_y), 1, 1e-12);
            near_vector(vec3_cross(f.e_x, f.e_y), f.e_z, 1e-12); /* right-handed */
            assert_true(f.e_y.y > 0);
        }
}

/* At a pole the frame is the limit along its meridian. */
static void test_poles(void **state) {
    (void)state;
    for (int m = 0; m < 3; m += 2)
        for (int v = 0; v < 2; v++)
            for (double u = 0; u < 1; u += 0.125) {
                FieldFrame at = field_frame(models[m], u, v),
                           by = field_frame(models[m], u, v ? 1 - 1e-7 : 1e-7);
                near_vector(at.e_x, by.e_x, 1e-6), near_vector(at.e_y, by.e_y, 1e-6);
                near_vector(at.e_z, by.e_z, 1e-6);
            }
    near_vector(field_frame(&sphere, 0.5, 1).at, v3(0, 3.5, 0), 1e-12);
    near_vector(field_frame(&sphere, 0.5, 0.5).at, v3(0, 0, 3.5), 1e-12);  /* theta from +z ... */
    near_vector(field_frame(&sphere, 0.75, 0.5).at, v3(3.5, 0, 0), 1e-12); /* ... toward +x */
    near_vector(field_frame(&can, 0.5, 1).at, v3(0, 2, 1.5), 1e-12);
    Vec2 pole = field_place(&sphere, v3(0, 2, 0));
    near(pole.x, 0.5, 0), near(pole.y, 1, 0);
}

static void test_places(void **state) {
    (void)state;
    for (int m = 0; m < 3; m++)
        for (int i = 0; i < 1000; i++) {
            double u = random_in(0, 1), v = random_in(0, 1);
            Vec3 p = field_frame(models[m], u, v).at;
            if (models[m]->model != FIELD_CYLINDER) p = vec3_scale(p, pow(10, random_in(-6, 6)));
            Vec2 back = field_place(models[m], p);
            near(back.x, u, 1e-9), near(back.y, v, 1e-9);
        }
}

static void test_directions(void **state) {
    (void)state;
    for (int m = 0; m < 3; m++)
        for (int i = 0; i < 3000; i++) {
            Field field = *models[m];
            field.angles = (FieldAngles)(i % 3);
            FieldFrame frame = field_frame(&field, random_in(0, 1), random_in(0, 1));
            double s = random_in(0.001, 0.999), t = random_in(0.001, 0.999);
            Vec3 d = field_direction(&field, &frame, s, t);
            near(vec3_length(d), 1, 1e-12);
            assert_true(vec3_dot(d, frame.e_z) > 0);
            Vec2 back = field_angles(&field, &frame, d);
            near(back.x, s, 1e-9), near(back.y, t, 1e-9);
            /* The angles that Eq. 5 measures, from the stored ones by each scale's own inverse. */
            double x = vec3_dot(d, frame.e_x), y = vec3_dot(d, frame.e_y), z = vec3_dot(d, frame.e_z);
            double p = asin(x / hypot(x, z)), q = asin(y), limit = 0.5 * PI;
            const double linear[] = {p / PI + 0.5, q / PI + 0.5};
            const double sine[] = {sin(p) / 2 + 0.5, sin(q) / 2 + 0.5};
            const double half[] = {tan(p / 2) / 2 + 0.5, tan(q / 2) / 2 + 0.5};
            const double *expected = i % 3 == 0 ? linear : i % 3 == 1 ? sine : half;
            assert_true(fabs(p) < limit);
            near(s, expected[0], 1e-7), near(t, expected[1], 1e-7);
        }
    FieldFrame front = field_frame(&sphere, 0.5, 0.5);
    near_vector(field_direction(&sphere, &front, 0.5, 0.5), v3(0, 0, 1), 1e-12);
    near_vector(field_direction(&sphere, &front, 1, 0.5), v3(1, 0, 0), 1e-12);
    near_vector(field_direction(&sphere, &front, 0.5, 1), v3(0, 1, 0), 1e-12);
}

/* Behind the horizon the linear scale goes on, the others end at theirs. */
static void test_horizon(void **state) {
    (void)state;
    Field field = sphere;
    FieldFrame front = field_frame(&field, 0.5, 0.5);
    Vec3 behind = vec3_normalize(v3(1, 0, -1));
    near(field_angles(&field, &front, behind).x, 1.25, 1e-12);
    for (int k = 1; k < 3; k++) {
        field.angles = (FieldAngles)k;
        near(field_angles(&field, &front, behind).x, 1, 1e-12);
        near(field_angles(&field, &front, vec3_normalize(v3(-1, 0, -1))).x, 0, 1e-12);
    }
}

/* Each neighbour's centre lies where the plane (u, v), gone on over a pole, says. */
static void test_cells(void **state) {
    (void)state;
    for (int m = 0; m < 3; m++)
        for (int i = 0; i < 4000; i++) {
            const Field *field = models[m];
            double u = random_in(0, 1), v = random_in(0, 1);
            if (i % 4 == 0) v = random_in(0, 0.5 / field->v);
            if (i % 4 == 1) v = 1 - random_in(0, 0.5 / field->v);
            if (i % 8 < 2) u = i % 16 < 8 ? random_in(0, 0.5 / field->u) : 1 - random_in(0, 0.5 / field->u);
            FieldCell cell = field_cell(field, u, v);
            double sum = 0, mean_u = 0, mean_v = 0;
            for (int k = 0; k < 4; k++) {
                assert_true(cell.u[k] >= 0 && cell.u[k] < field->u && cell.v[k] >= 0 && cell.v[k] < field->v);
                assert_true(cell.weight[k] >= 0);
                double x = floor(u * field->u - 0.5) + (k & 1), y = floor(v * field->v - 0.5) + (k >> 1);
                if (field->model == FIELD_CYLINDER) y = clamp(y, 0, field->v - 1);
                Vec3 stored =
                    field_frame(field, (cell.u[k] + 0.5) / field->u, (cell.v[k] + 0.5) / field->v).at;
                double theta = 2 * PI * (x + 0.5) / field->u - PI, phi = PI * (y + 0.5) / field->v - PI / 2;
                Vec3 centre = v3(cos(phi) * sin(theta), sin(phi), cos(phi) * cos(theta));
                centre = vec3_scale(centre, field->radius);
                if (field->model == FIELD_CYLINDER)
                    centre = v3(field->radius * sin(theta), field->height * ((y + 0.5) / field->v - 0.5),
                                field->radius * cos(theta));
                near_vector(stored, centre, 1e-12);
                sum += cell.weight[k], mean_u += cell.weight[k] * (x + 0.5),
                    mean_v += cell.weight[k] * (y + 0.5);
            }
            near(sum, 1, 1e-12), near(mean_u, u * field->u, 1e-9);
            if (field->model != FIELD_CYLINDER) near(mean_v, v * field->v, 1e-9);
        }
}

static void test_refused(void **state) {
    (void)state;
    Field field = {.u = 8, .v = 8, .s = 8, .t = 8};
    assert_null(field_refused(&field));
    field = (Field){.u = 1024, .v = 1024, .s = 256, .t = 256};
    assert_null(field_refused(&field));
    int *const sides[] = {&field.u, &field.v, &field.s, &field.t};
    const int most[] = {1024, 1024, 256, 256};
    for (int i = 0; i < 4; i++) {
        const int wrong[] = {7, 0, -8, most[i] + 2, 1 << 30};
        for (int k = 0; k < 5; k++) {
            field = (Field){.u = 8, .v = 8, .s = 8, .t = 8};
            *sides[i] = wrong[k];
            assert_non_null(field_refused(&field));
        }
        field = (Field){.u = 8, .v = 8, .s = 8, .t = 8};
        *sides[i] = 9;
        assert_true(!field_refused(&field) == (i > 0)); /* only u must be even */
    }
}

static void test_memory(void **state) {
    (void)state;
    assert_int_equal(field_block(&sphere), 3 * 8 * 11);
    assert_int_equal(field_row(&sphere), 3 * 8 * 11 * 12);
    assert_int_equal(field_bytes(&sphere), 3 * 8 * 11 * 12 * 9);
    Field large = {.u = 1024, .v = 512, .s = 128, .t = 128};
    assert_true(field_bytes(&large) == 25769803776u);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames),     cmocka_unit_test(test_poles),   cmocka_unit_test(test_places),
        cmocka_unit_test(test_directions), cmocka_unit_test(test_horizon), cmocka_unit_test(test_cells),
        cmocka_unit_test(test_refused),    cmocka_unit_test(test_memory),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("light_field", tests, NULL, NULL);
}
