/* The relief textures of the two objects: what lies where a texel says, found again without any of the code
 * that made it, by a march through functions that only say inside or outside, and by every triangle in turn.
 */
#include "image.h"
#include "object.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdint.h>
#include <stdio.h>

#include "random.h" /* behind cmocka.h */

static void same_place(Vec3 a, Vec3 b, double bound) { near(vec3_length(vec3_sub(a, b)), 0, bound); }

static const char *const faces[] = {"left", "right", "bottom", "top", "back", "front"};
static const Vec3 outward[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
enum { FACES = 6 };

/* ---- The toy as a function that says inside or outside ---- */

static Vec3 turned_about(Vec3 p, Vec3 axis, double degrees) {
    if (degrees == 0) return p;
    double c = cos(radians(degrees)), s = sin(radians(degrees));
    Vec3 along = vec3_scale(axis, vec3_dot(axis, p) * (1 - c));
    return vec3_add(vec3_add(vec3_scale(p, c), vec3_scale(vec3_cross(axis, p), s)), along);
}

static bool is_inside(const Solid *solid, Vec3 world) {
    Vec3 p = vec3_sub(world, solid->centre), half = vec3_scale(solid->size, 0.5);
    p = turned_about(p, v3(0, 0, 1), -solid->turn_degrees.z);
    p = turned_about(p, v3(0, 1, 0), -solid->turn_degrees.y);
    p = turned_about(p, v3(1, 0, 0), -solid->turn_degrees.x);
    if (solid->kind == SOLID_SPHERE) return vec3_length(p) <= half.x;
    if (solid->kind == SOLID_CYLINDER) return hypot(p.x, p.z) <= half.x && fabs(p.y) <= half.y;
    return fabs(p.x) <= half.x && fabs(p.y) <= half.y && fabs(p.z) <= half.z;
}

/* The first solid that holds the point; -1: none. */
static int inside(Vec3 p) {
    for (int i = 0; i < TOY_SOLIDS; i++)
        if (is_inside(&toy_solids[i], p)) return i;
    return -1;
}

/* Follows a ray for `length`: whether it gets into a solid, where (steps, then halving), and into which. */
static bool march(Ray ray, double length, double *depth, int *solid) {
    enum { STEPS = 600 };
    double low = 0, high = 0;
    for (int k = 1; k <= STEPS && inside(ray_at(ray, high)) < 0; k++) low = high, high = length * k / STEPS;
    if (inside(ray_at(ray, high)) < 0) return false;
    for (int n = 0; n < 40; n++) {
        double middle = (low + high) / 2;
        if (inside(ray_at(ray, middle)) < 0)
            low = middle;
        else
            high = middle;
    }
    *depth = high, *solid = inside(ray_at(ray, high));
    return true;
}

/* A random point where a solid's surface is the toy's: on the way out of the solid, from within; and the
 * unit vector back into it. */
static Vec3 random_surface(Vec3 *into) {
    for (;;) {
        const Solid *solid = &toy_solids[(int)random_in(0, TOY_SOLIDS)];
        double z = random_in(-1, 1), theta = random_in(-PI, PI), ring = sqrt(1 - z * z);
        Vec3 way = v3(ring * cos(theta), ring * sin(theta), z);
        double low = 0, high = 2;
        for (int n = 0; n < 50; n++) {
            double middle = (low + high) / 2;
            if (is_inside(solid, vec3_add(solid->centre, vec3_scale(way, middle))))
                low = middle;
            else
                high = middle;
        }
        Vec3 point = vec3_add(solid->centre, vec3_scale(way, high));
        if (inside(vec3_add(solid->centre, vec3_scale(way, high + 1e-9))) >= 0) continue;
        *into = vec3_scale(way, -1);
        return point;
    }
}

/* Rays begin a little beneath the surface, and ahead by a hundred times that: out of a surface that they
 * leave, but within a wall that they would run along, for what a face sees edge-on it does not see. */
static void test_nothing_hidden(void **state) {
    (void)state;
    int hidden = 0;
    for (int n = 0; n < 2000; n++) {
        Vec3 into, point = random_surface(&into), beneath = vec3_add(point, vec3_scale(into, 1e-5));
        bool seen = false;
        for (int i = 0; i < FACES && !seen; i++) {
            double depth;
            int solid;
            Ray ray = {vec3_add(beneath, vec3_scale(outward[i], 1e-3)), outward[i]};
            seen = !march(ray, 2.2, &depth, &solid);
        }
        hidden += !seen;
        if (!seen) print_message("# (%g, %g, %g) is seen from no face\n", point.x, point.y, point.z);
    }
    assert_in_range(hidden, 0, 1); /* the ring's share is one of 30,000 */
}

/* ---- The files ---- */

typedef struct {
    Image colour, height;
} Relief;

static Relief relief_load(const char *object, int face) {
    char path[64];
    snprintf(path, sizeof path, "build/assets/%s-%s.png", object, faces[face]);
    return (Relief){image_load(path, IMAGE_COLOUR), image_load(path, IMAGE_HEIGHT)};
}

static void relief_destroy(Relief *relief) {
    image_destroy(&relief->colour);
    image_destroy(&relief->height);
}

/* From a texel's centre in the face's rectangle, inward. */
static Ray texel_ray(const Image *height, int x, int y) {
    const Basis *basis = &height->basis;
    Vec3 across = vec3_scale(basis->a, (x + 0.5) / height->width);
    Vec3 up = vec3_scale(basis->b, (y + 0.5) / height->height);
    return (Ray){vec3_add(basis->origin, vec3_add(across, up)), vec3_scale(basis->f, -1)};
}

/* How far below the face's rectangle the texel's surface lies. */
static double texel_depth(const Image *height, int x, int y) {
    return height->scale * vec3_length(height->basis.a) * (height->base - *image_at(height, x, y));
}

/* Colours go on beyond the outline, so that a filter there mixes in no black. */
static void check_colours_beyond(const Relief *relief) {
    int beyond = 0;
    for (int y = 0; y < 256; y++)
        for (int x = 1; x < 256; x++) {
            if (*image_at(&relief->height, x, y) > 0 || *image_at(&relief->height, x - 1, y) <= 0) continue;
            const float *texel = image_at(&relief->colour, x, y);
            assert_true(texel[0] + texel[1] + texel[2] > 0.05f);
            beyond++;
        }
    assert_true(beyond > 50);
}

/* The faces lie, and their u and v run, as on a mesh_box of the box's size. */
static void check_faces(const char *object, Vec3 box) {
    Mesh mesh = mesh_box(box.x, box.y, box.z);
    for (int i = 0; i < FACES; i++) {
        Relief relief = relief_load(object, i);
        const Basis *basis = &relief.height.basis;
        assert_int_equal(relief.height.width, 256);
        assert_int_equal(relief.height.height, 256);
        assert_int_equal(relief.height.bits, 16);
        assert_true(relief.height.hollow);
        near(relief.height.base, 1, 0);
        same_place(basis->f, outward[i], 0);
        int corners = 0;
        for (int k = 0; k < mesh.vertex_count; k++) {
            const Vertex *vertex = &mesh.vertices[k];
            if (vec3_dot(v3(vertex->normal[0], vertex->normal[1], vertex->normal[2]), outward[i]) < 0.5)
                continue;
            Vec3 across = vec3_scale(basis->a, vertex->uv[0]), up = vec3_scale(basis->b, vertex->uv[1]);
            same_place(vec3_add(basis->origin, vec3_add(across, up)),
                       v3(vertex->position[0], vertex->position[1], vertex->position[2]), 1e-6);
            corners++;
        }
        assert_int_equal(corners, 4);
        check_colours_beyond(&relief);
        relief_destroy(&relief);
    }
    mesh_destroy(&mesh);
}

/* Half a step of 16 bits, and the float that holds it. */
static double step(const Image *height) {
    return 0.51 / 65535 * height->scale * vec3_length(height->basis.a);
}

static void test_toy(void **state) {
    (void)state;
    check_faces("solids", toy_box);
    for (int i = 0; i < FACES; i++) {
        Relief relief = relief_load("solids", i);
        int met = 0, missed = 0, undecided = 0;
        for (int n = 0; n < 600; n++) {
            int x = (int)random_in(0, 256), y = (int)random_in(0, 256), solid;
            Ray ray = texel_ray(&relief.height, x, y);
            double depth;
            if (!march(ray, 2.2, &depth, &solid)) {
                if (*image_at(&relief.height, x, y) > 0)
                    undecided++; /* it may be thinner there than a step */
                else
                    missed++;
                continue;
            }
            met++;
            assert_true(*image_at(&relief.height, x, y) > 0);
            near(texel_depth(&relief.height, x, y), depth, step(&relief.height));
            Vec3 colour = toy_colour(&toy_solids[solid], ray_at(ray, depth));
            const float *texel = image_at(&relief.colour, x, y);
            same_place(v3(texel[0], texel[1], texel[2]), colour, 1e-4);
        }
        assert_true(met > 240 && missed > 180 && undecided < 4);
        relief_destroy(&relief);
    }
}

/* ---- The bunny ---- */

static Vec3 position(const Mesh *mesh, uint32_t index) {
    const float *p = mesh->vertices[index].position;
    return v3(p[0], p[1], p[2]);
}

/* The depth of the first triangle in the ray's way; infinite: none. The ray passes within a triangle if the
 * volumes that it spans with the three sides have one sign. */
static double brute(const Mesh *mesh, Ray ray) {
    double first = INFINITY;
    for (int i = 0; i < mesh->index_count; i += 3) {
        Vec3 a = vec3_sub(position(mesh, mesh->indices[i]), ray.origin), d = ray.direction;
        Vec3 b = vec3_sub(position(mesh, mesh->indices[i + 1]), ray.origin);
        Vec3 c = vec3_sub(position(mesh, mesh->indices[i + 2]), ray.origin);
        double p = vec3_dot(d, vec3_cross(b, c)), q = vec3_dot(d, vec3_cross(c, a));
        double r = vec3_dot(d, vec3_cross(a, b)), sum = p + q + r;
        if (!(p / sum >= 0 && q / sum >= 0 && r / sum >= 0)) continue;
        first = fmin(first, (p * vec3_dot(a, d) + q * vec3_dot(b, d) + r * vec3_dot(c, d)) / sum);
    }
    return first;
}

static void test_bunny(void **state) {
    (void)state;
    Vec3 box;
    Mesh mesh = bunny_load("build/assets/bunny.obj", &box);
    check_faces("bunny", box);
    for (int i = 0; i < FACES; i++) {
        Relief relief = relief_load("bunny", i);
        int met = 0, missed = 0;
        for (int n = 0; n < 100; n++) {
            int x = (int)random_in(0, 256), y = (int)random_in(0, 256);
            Ray ray = texel_ray(&relief.height, x, y);
            double depth = brute(&mesh, ray);
            if (depth == INFINITY) {
                near(*image_at(&relief.height, x, y), 0, 0);
                missed++;
                continue;
            }
            met++;
            near(texel_depth(&relief.height, x, y), depth, step(&relief.height));
            const float *texel = image_at(&relief.colour, x, y);
            same_place(v3(texel[0], texel[1], texel[2]), bunny_colour(ray_at(ray, depth)), 1e-4);
        }
        assert_true(met > 35 && missed > 25);
        relief_destroy(&relief);
    }
    mesh_destroy(&mesh);
}

/* Its two ends are at x = -1 and 1, and its middle is the origin. */
static void test_bunny_place(void **state) {
    (void)state;
    Vec3 box, low = v3(9, 9, 9), high = v3(-9, -9, -9);
    Mesh mesh = bunny_load("build/assets/bunny.obj", &box);
    assert_int_equal(mesh.vertex_count, 34835);
    assert_int_equal(mesh.index_count, 3 * 69666);
    for (int i = 0; i < mesh.vertex_count; i++) {
        Vec3 p = position(&mesh, (uint32_t)i);
        low = v3(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = v3(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    near(low.x, -1, 1e-6);
    near(high.x, 1, 1e-6);
    same_place(vec3_add(low, high), v3(0, 0, 0), 1e-6);
    same_place(vec3_sub(high, low), vec3_sub(box, v3(0.06, 0.06, 0.06)), 1e-6);
    mesh_destroy(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_hidden),
        cmocka_unit_test(test_toy),
        cmocka_unit_test(test_bunny_place),
        cmocka_unit_test(test_bunny),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("object", tests, NULL, NULL);
}
