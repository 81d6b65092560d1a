/* The pre-warp's equations against what they stand for: the line from the eye to a displaced point, met with
 * the plane on which the point is to be shown. Nothing here uses k1, k2 and k3 but to compare them. */
#include "prewarp.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static uint64_t state = 0x9E3779B97F4A7C15u;

/* xorshift64*: the same numbers in every run. */
static double uniform(double low, double high) {
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return low + (high - low) * (double)(state * 0x2545F4914F6CDD1Du >> 32) / 4294967296.0;
}

static Vec3 random_direction(void) {
    Vec3 d;
    do d = v3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    while (vec3_length(d) > 1 || vec3_length(d) < 0.1);
    return vec3_normalize(d);
}

static void near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound * (1 + fabs(expected))))
        fail_msg("got %.17g, expected %.17g within %g", value, expected, bound);
}

/* The rotation that takes x and z to two directions at right angles: columns of a frame. */
typedef struct {
    Vec3 x, y, z;
} Frame;

static Frame random_frame(void) {
    Vec3 z = random_direction(), x = vec3_normalize(vec3_cross(z, random_direction()));
    return (Frame){x, vec3_cross(z, x), z};
}

static Vec3 in_frame(const Frame *frame, double x, double y, double z) {
    return vec3_add(vec3_add(vec3_scale(frame->x, x), vec3_scale(frame->y, y)), vec3_scale(frame->z, z));
}

/* A plane with a and b of any lengths, 30 to 150 degrees apart, and f at most 60 degrees from its normal, on
 * either side. right_angles: a, b and f are orthogonal. */
static Plane random_plane(const Frame *frame, bool right_angles) {
    double angle = radians(right_angles ? 90 : uniform(30, 150)), length = uniform(0.3, 2);
    double tilt = radians(right_angles ? 0 : uniform(0, 60)), turn = uniform(0, 2 * PI);
    double side = uniform(-1, 1) < 0 ? -1 : 1;
    return (Plane){
        .origin = v3(uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)),
        .a = vec3_scale(frame->x, uniform(0.3, 2)),
        .b = in_frame(frame, length * cos(angle), length * sin(angle), 0),
        .f = in_frame(frame, sin(tilt) * cos(turn), sin(tilt) * sin(turn), side * cos(tilt)),
    };
}

/* An eye that far from the plane's origin, on either side, or infinitely far in that direction. */
static Eye random_eye(const Plane *plane, const Frame *frame, double low, double high, bool infinite) {
    double side = uniform(-1, 1) < 0 ? -1 : 1;
    Vec3 to = in_frame(frame, uniform(-1, 1), uniform(-1, 1), side * uniform(0.2, 1));
    if (infinite) return (Eye){vec3_scale(to, uniform(0.1, 10)), 0};
    double w = uniform(0.5, 2);
    return (Eye){vec3_scale(vec3_add(plane->origin, vec3_scale(to, uniform(low, high))), w), w};
}

static Vec3 displaced(const Plane *plane, double u, double v, double d) {
    Vec3 along = vec3_add(vec3_scale(plane->a, u), vec3_scale(plane->b, v));
    return vec3_add(plane->origin, vec3_add(along, vec3_scale(plane->f, d)));
}

/* The line from the eye through a point meets the plane: u, v there, and t, how far along it the plane lies
 * when the point is at 1 (for an eye infinitely far nothing but u and v). */
typedef struct {
    double u, v, t;
} Meeting;

static Meeting line_meets(const Plane *plane, Eye eye, Vec3 point) {
    Vec3 from = eye.w > 0 ? vec3_scale(eye.at, 1 / eye.w) : vec3_add(point, eye.at);
    Vec3 way = vec3_sub(point, from), normal = vec3_cross(plane->a, plane->b);
    double t = vec3_dot(vec3_sub(plane->origin, from), normal) / vec3_dot(way, normal);
    Vec3 q = vec3_sub(vec3_add(from, vec3_scale(way, t)), plane->origin);
    /* q = u a + v b: the reciprocal basis within the plane */
    Vec3 across_b = vec3_cross(plane->b, normal), across_a = vec3_cross(plane->a, normal);
    return (Meeting){vec3_dot(q, across_b) / vec3_dot(plane->a, across_b),
                     vec3_dot(q, across_a) / vec3_dot(plane->b, across_a), t};
}

static double linear(const double factor[4], double u, double v, double d) {
    return factor[0] * u + factor[1] * v + factor[2] * d + factor[3];
}

/* Eyes from a tenth of a unit to a thousand units away, on either side, and at infinity. */
static Eye any_eye(const Plane *plane, const Frame *frame, int i) {
    static const double far[] = {0.1, 1, 3, 1000};
    return random_eye(plane, frame, far[i % 4] * 0.5, far[i % 4], i % 5 == 4);
}

enum { ROUNDS = 20000 };

static void factors_are_the_projection(void **unused) {
    (void)unused;
    int seen = 0;
    for (int i = 0; i < ROUNDS; i++) {
        Frame frame = random_frame();
        Plane plane = random_plane(&frame, i % 3 == 0);
        Eye eye = any_eye(&plane, &frame, i);
        PrewarpFactors k = prewarp_factors(&plane, eye);
        assert_true(k.possible);
        double u = uniform(0, 1), v = uniform(0, 1), d = uniform(-0.5, 0.5), w = 1 + k.k3 * d;
        Meeting meeting = line_meets(&plane, eye, displaced(&plane, u, v, d));
        /* 1 + k3 d is how much farther than the plane the point is, and so negative behind the eye. */
        if (eye.w > 0) near(w, 1 / meeting.t, 1e-9);
        if (fabs(w) < 1e-3) continue;
        near((u + k.k1 * d) / w, meeting.u, 1e-8);
        near((v + k.k2 * d) / w, meeting.v, 1e-8);
        seen++;
    }
    assert_true(seen > ROUNDS * 99 / 100);
}

/* k1 = f.(b x c) / a.(b x c), k2 = f.(c x a) / a.(b x c), and where f is orthogonal k3 = 1 / (c.f). */
static void factors_are_the_papers(void **unused) {
    (void)unused;
    for (int i = 0; i < ROUNDS; i++) {
        Frame frame = random_frame();
        Plane plane = random_plane(&frame, i % 2 == 0);
        Eye eye = any_eye(&plane, &frame, i);
        Vec3 c = eye.w > 0 ? vec3_sub(plane.origin, vec3_scale(eye.at, 1 / eye.w)) : vec3_scale(eye.at, -1);
        Vec3 bc = vec3_cross(plane.b, c), ca = vec3_cross(c, plane.a);
        PrewarpFactors k = prewarp_factors(&plane, eye);
        near(k.k1, vec3_dot(plane.f, bc) / vec3_dot(plane.a, bc), 1e-9);
        near(k.k2, vec3_dot(plane.f, ca) / vec3_dot(plane.a, bc), 1e-9);
        if (eye.w == 0) near(k.k3, 0, 0);
        if (eye.w > 0 && i % 2 == 0) near(k.k3, 1 / vec3_dot(c, plane.f), 1e-9);
    }
}

/* An eye over the unit square at (0.8, 0.3), two above: by hand. What is sunk by 1 (d = -1) below the origin
 * lies on the line from (0.8, 0.3, 2) to (0, 0, -1), which meets the plane two thirds of the way. */
static void factors_by_hand(void **unused) {
    (void)unused;
    Plane plane = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    PrewarpFactors k = prewarp_factors(&plane, (Eye){{0.8, 0.3, 2}, 1});
    near(k.k1, -0.4, 1e-15);
    near(k.k2, -0.15, 1e-15);
    near(k.k3, -0.5, 1e-15);
    near(-k.k1 / (1 - k.k3), 0.8 / 3, 1e-15);
    near(-k.k2 / (1 - k.k3), 0.1, 1e-15);
}

/* On one ray the point nearer to the eye has the greater d, or for an eye behind the plane the smaller. */
static void behind_tells_what_is_nearer(void **unused) {
    (void)unused;
    int behind = 0;
    for (int i = 0; i < ROUNDS; i++) {
        Frame frame = random_frame();
        Plane plane = random_plane(&frame, false);
        Eye eye = any_eye(&plane, &frame, i);
        PrewarpFactors k = prewarp_factors(&plane, eye);
        Vec3 point = displaced(&plane, uniform(0, 1), uniform(0, 1), 0);
        Vec3 to_eye = eye.w > 0 ? vec3_sub(vec3_scale(eye.at, 1 / eye.w), point) : eye.at;
        Vec3 nearer = vec3_scale(to_eye, 0.25); /* from the point, a part of the way to the eye */
        Vec3 normal = vec3_cross(plane.a, plane.b);
        double d = vec3_dot(nearer, normal) / vec3_dot(plane.f, normal);
        assert_true(k.behind == (d < 0));
        assert_true(eye.w == 0 || k.behind == (k.k3 > 0));
        behind += k.behind;
    }
    assert_true(behind > ROUNDS / 4 && behind < ROUNDS * 3 / 4);
}

static void map_of_a_plane_onto_itself_is_the_factors(void **unused) {
    (void)unused;
    for (int i = 0; i < ROUNDS; i++) {
        Frame frame = random_frame();
        Plane plane = random_plane(&frame, false);
        Eye eye = any_eye(&plane, &frame, i);
        PrewarpFactors k = prewarp_factors(&plane, eye);
        PrewarpMap map = prewarp_map(&plane, &plane, eye);
        assert_true(map.possible);
        const double u[] = {1, 0, k.k1, 0}, v[] = {0, 1, k.k2, 0}, w[] = {0, 0, k.k3, 1};
        for (int j = 0; j < 4; j++) {
            near(map.u[j], u[j], 1e-9);
            near(map.v[j], v[j], 1e-9);
            near(map.w[j], w[j], 1e-9);
        }
    }
}

/* Two planes that have nothing to do with one another: the texel of the target is where the line meets it,
 * and W tells whether the point lies on the eye's side of a plane through the eye along the target. */
static void map_between_planes_is_the_projection(void **unused) {
    (void)unused;
    int seen = 0, unseen = 0;
    for (int i = 0; i < ROUNDS; i++) {
        Frame source_frame = random_frame(), target_frame = random_frame();
        Plane source = random_plane(&source_frame, false), target = random_plane(&target_frame, false);
        Eye eye = any_eye(&target, &target_frame, i);
        PrewarpMap map = prewarp_map(&source, &target, eye);
        assert_true(map.possible);
        double u = uniform(0, 1), v = uniform(0, 1), d = uniform(-0.5, 0.5);
        double w = linear(map.w, u, v, d);
        if (fabs(w) < 1e-2) continue;
        Meeting meeting = line_meets(&target, eye, displaced(&source, u, v, d));
        near(linear(map.u, u, v, d) / w, meeting.u, 1e-7);
        near(linear(map.v, u, v, d) / w, meeting.v, 1e-7);
        if (eye.w > 0) assert_true((w > 0) == (meeting.t > 0));
        seen += w > 0;
        unseen += w < 0;
    }
    assert_true(seen > ROUNDS / 4 && unseen > ROUNDS / 20);
}

/* An eye in the plane sees no area of it: refused, at any distance and at infinity, and near it not. */
static void eye_in_the_plane_is_refused(void **unused) {
    (void)unused;
    for (int i = 0; i < 1000; i++) {
        Frame frame = random_frame();
        Plane plane = random_plane(&frame, false);
        Vec3 across = in_frame(&frame, uniform(-1, 1), uniform(-1, 1), 0);
        Vec3 above = vec3_scale(frame.z, 1e-6 * vec3_length(across));
        Eye point = {vec3_add(plane.origin, across), 1}, far = {across, 0};
        assert_false(prewarp_factors(&plane, point).possible);
        assert_false(prewarp_factors(&plane, far).possible);
        assert_false(prewarp_map(&plane, &plane, point).possible);
        assert_true(prewarp_factors(&plane, (Eye){vec3_add(point.at, above), 1}).possible);
        assert_true(prewarp_factors(&plane, (Eye){vec3_add(far.at, above), 0}).possible);
    }
    Plane plane = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    assert_false(prewarp_factors(&plane, (Eye){{0, 0, 0}, 1}).possible); /* on the origin itself */
    assert_false(prewarp_factors(&plane, (Eye){{0, 0, 0}, 0}).possible); /* no direction */
    assert_false(prewarp_factors(&plane, (Eye){{0, 0, INFINITY}, 1}).possible);
    assert_false(prewarp_factors(&plane, (Eye){{0, 0, NAN}, 1}).possible);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(factors_are_the_projection),
        cmocka_unit_test(factors_are_the_papers),
        cmocka_unit_test(factors_by_hand),
        cmocka_unit_test(behind_tells_what_is_nearer),
        cmocka_unit_test(map_of_a_plane_onto_itself_is_the_factors),
        cmocka_unit_test(map_between_planes_is_the_projection),
        cmocka_unit_test(eye_in_the_plane_is_refused),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("prewarp", tests, NULL, NULL);
}
