/* Rays against meshes: held against every triangle in doubles, and sent through edges and corners, where a
 * closed mesh must let none by. Then the files that meshes come from. */
#define _DEFAULT_SOURCE /* mkstemp */
#include "mesh_file.h"
#include "mesh_rays.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <float.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "random.h" /* behind cmocka.h */

static Vec3 position(const Mesh *mesh, int triangle, int k) {
    const float *p = mesh->vertices[mesh->indices[3 * triangle + k]].position;
    return v3(p[0], p[1], p[2]);
}

static double volume(Vec3 a, Vec3 b, Vec3 c) { return vec3_dot(a, vec3_cross(b, c)); }

/* A crossing, and its barycentric coordinates. */
typedef struct {
    double depth, weights[3];
    int triangle;
} Found;

/* Every triangle: the ray passes within if the volumes that it spans with the three sides have one sign. */
static Found brute(const Mesh *mesh, Ray ray) {
    Found first = {.depth = INFINITY, .triangle = -1};
    for (int i = 0; i < mesh->index_count / 3; i++) {
        Vec3 p[3];
        for (int k = 0; k < 3; k++) p[k] = vec3_sub(position(mesh, i, k), ray.origin);
        double sum = 0, depth = 0, within = INFINITY, weights[3];
        for (int k = 0; k < 3; k++) {
            weights[k] = volume(ray.direction, p[(k + 1) % 3], p[(k + 2) % 3]);
            sum += weights[k];
        }
        for (int k = 0; k < 3; k++) {
            weights[k] /= sum;
            within = fmin(within, weights[k]);
            depth += weights[k] * vec3_dot(p[k], ray.direction);
        }
        if (!(within >= 0 && depth >= 0 && depth < first.depth)) continue;
        first = (Found){.depth = depth, .triangle = i};
        memcpy(first.weights, weights, sizeof weights);
    }
    return first;
}

/* A closed mesh of triangles of all sizes: a sphere whose vertices are moved at random, the same where they
 * are in one place. */
static Mesh lumpy(void) {
    Mesh mesh = mesh_sphere(1, 24, 16);
    for (int i = 0; i < mesh.vertex_count; i++) {
        float *p = mesh.vertices[i].position;
        float lump = 1 + 0.3f * (float)sin(5 * p[0] + 7 * p[1] * p[2]) * (float)cos(9 * p[2] - 4 * p[1]);
        for (int k = 0; k < 3; k++) p[k] *= lump;
    }
    return mesh;
}

/* Rays that begin at `distance` from where they are aimed; brute force sees them from near by, so that it
 * does not lose the digits. */
static void check_against_brute(double distance, double bound) {
    const double ahead = fmax(distance - 5, 0);
    Mesh mesh = lumpy();
    MeshRays *rays = mesh_rays_create(&mesh);
    int hits = 0;
    for (int n = 0; n < 20000; n++) {
        Vec3 to = random_vector(-1.2, 1.2), way = random_direction();
        Ray ray = {vec3_sub(to, vec3_scale(way, distance)), way};
        Found found = brute(&mesh, (Ray){ray_at(ray, ahead), way});
        MeshHit hit = {.triangle = -1};
        bool met = mesh_rays_hit(rays, ray, &hit);
        assert_true(met == (hit.triangle >= 0));
        assert_int_equal(hit.triangle, found.triangle);
        if (!met) continue;
        hits++;
        near(hit.depth, ahead + found.depth, bound);
        Vec3 normal = {0};
        for (int k = 0; k < 3; k++) {
            const float *c = mesh.vertices[mesh.indices[3 * hit.triangle + k]].normal;
            normal = vec3_add(normal, vec3_scale(v3(c[0], c[1], c[2]), found.weights[k]));
        }
        near(vec3_length(vec3_sub(hit.normal, vec3_normalize(normal))), 0, 100 * bound);
    }
    assert_true(hits > 8000);
    mesh_rays_destroy(rays);
    mesh_destroy(&mesh);
}

static void test_against_brute(void **state) {
    (void)state;
    check_against_brute(5, 1e-12);
    check_against_brute(0.5, 1e-12); /* many begin inside */
    check_against_brute(1e6, 1e-8);  /* where floats are 0.06 apart, doubles 1e-10: and some rays graze */
}

/* From inside a closed mesh no ray gets out: not through an edge, not through a corner. */
static void check_no_leaks(Mesh mesh) {
    MeshRays *rays = mesh_rays_create(&mesh);
    for (int n = 0; n < 500000; n++) {
        int triangle = (int)random_in(0, mesh.index_count / 3.0), k = n % 3;
        Vec3 a = position(&mesh, triangle, k), b = position(&mesh, triangle, (k + 1) % 3);
        Vec3 from = random_vector(-0.2, 0.2), to = vec3_mix(a, b, n % 4 ? random_in(0, 1) : 0);
        Ray ray = {from, vec3_normalize(vec3_sub(to, from))};
        MeshHit hit;
        assert_true(mesh_rays_hit(rays, ray, &hit));
        assert_true(hit.depth < vec3_length(vec3_sub(to, from)) + 1e-6);
        near(vec3_length(hit.normal), 1, 1e-12);
    }
    mesh_rays_destroy(rays);
    mesh_destroy(&mesh);
}

static void test_no_leaks(void **state) {
    (void)state;
    check_no_leaks(lumpy());
    check_no_leaks(mesh_box(1.1, 0.7, 0.9)); /* whose triangles' boxes are flat */
}

/* What is met is decided in doubles, also where floats are coarse: a millionth within and without the border
 * of a rectangle a hundred units away from the origin, where floats are eight millionths apart. */
static void test_borders(void **state) {
    (void)state;
    Mesh mesh = mesh_plane(1, 1, 3, 3);
    const Vec3 place = v3(100, 200, -100);
    for (int i = 0; i < mesh.vertex_count; i++) {
        float *p = mesh.vertices[i].position;
        p[0] += (float)place.x, p[1] += (float)place.y, p[2] += (float)place.z;
    }
    MeshRays *rays = mesh_rays_create(&mesh);
    for (int n = 0; n < 20000; n++) {
        double beyond = n % 2 ? 1e-6 : -1e-6, edge = (n % 4 < 2 ? 0.5 + beyond : -0.5 - beyond);
        double along = random_in(-0.5, 0.5);
        Vec3 to = vec3_add(place, n % 8 < 4 ? v3(edge, along, 0) : v3(along, edge, 0));
        Vec3 from = vec3_add(to, v3(random_in(-1, 1), random_in(-1, 1), random_in(0.5, 2)));
        MeshHit hit;
        bool met = mesh_rays_hit(rays, (Ray){from, vec3_normalize(vec3_sub(to, from))}, &hit);
        assert_true(met == (beyond < 0));
    }
    mesh_rays_destroy(rays);
    mesh_destroy(&mesh);
}

/* From either side, not behind, and within the corners' depths though it is seen all but edge-on. */
static void test_one_triangle(void **state) {
    (void)state;
    Vertex corners[3] = {{.position = {-1, -1, 0}, .normal = {0, 0, 1}},
                         {.position = {1, -1, 0}, .normal = {0, 0, 1}},
                         {.position = {0, 1, 0}, .normal = {0, 1, 0}}};
    uint32_t indices[3] = {0, 1, 2};
    const Mesh mesh = {3, 3, corners, indices};
    MeshRays *rays = mesh_rays_create(&mesh);
    MeshHit hit = {.triangle = 7};
    assert_false(mesh_rays_hit(rays, (Ray){{0, 0, 3}, {0, 0, 1}}, &hit));
    assert_false(mesh_rays_hit(rays, (Ray){{2, 0, 3}, {0, 0, -1}}, &hit));
    assert_int_equal(hit.triangle, 7); /* as it was */
    assert_true(mesh_rays_hit(rays, (Ray){{0, 0, 3}, {0, 0, -1}}, &hit));
    near(hit.depth, 3, 0);
    near(hit.normal.y, sqrt(0.5), 1e-15); /* half of it from the third corner */
    assert_true(mesh_rays_hit(rays, (Ray){{0, 0, -3}, {0, 0, 1}}, &hit));
    near(hit.depth, 3, 0);
    near(hit.normal.z, sqrt(0.5), 1e-15); /* the mesh's own, also from behind */
    for (double height = 1e-3; height > 1e-12; height /= 2) {
        Ray ray = {{0, -5, 5 * height}, vec3_normalize(v3(0, 1, -height))}; /* to (0, 0, 0) */
        if (!mesh_rays_hit(rays, ray, &hit)) continue;
        near(hit.depth, 5, 1 + 1e-9);
        assert_true(isfinite(hit.normal.x + hit.normal.y + hit.normal.z));
    }
    mesh_rays_destroy(rays);
}

/* ---- Files ---- */

/* What mesh_read says of a file of these bytes. */
static const char *read_bytes(Mesh *mesh, const char *bytes, size_t count) {
    char path[] = "/tmp/texel-mesh-XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, bytes, count), (ssize_t)count);
    close(descriptor);
    const char *refused = mesh_read(mesh, path);
    unlink(path);
    return refused;
}

static void test_file(void **state) {
    (void)state;
    const char *square = "# a square, and one more triangle that stands on it, twice as large\n"
                         "mtllib none.mtl\r\n"
                         "v -1 -1 0\nv 1 -1 0.0 1.0\nv  1 1 0 \nv -1 1e0 0\n\n"
                         "vt 0 0\nvn 0 0 1\ns off\n"
                         "f 1/1/1 2//1 3 4/2\n"
                         "v 1 -1 4\nf -4 -3 -1"; /* no newline */
    Mesh mesh;
    assert_null(read_bytes(&mesh, square, strlen(square)));
    assert_int_equal(mesh.vertex_count, 5);
    assert_int_equal(mesh.index_count, 9);
    const uint32_t expected[] = {0, 1, 2, 0, 2, 3, 1, 2, 4};
    assert_memory_equal(mesh.indices, expected, sizeof expected);
    near(mesh.vertices[3].position[1], 1, 0);
    near(mesh.vertices[0].normal[2], 1, 0);
    /* At vertex 1 meet a triangle of area 2 toward +z and one of area 4 toward +x. */
    near(mesh.vertices[1].normal[0], 2 / sqrt(5), 1e-7);
    near(mesh.vertices[1].normal[2], 1 / sqrt(5), 1e-7);
    mesh_destroy(&mesh);
}

static void refused(const char *bytes, size_t count, const char *reason) {
    Mesh mesh = {.vertex_count = 7};
    const char *said = read_bytes(&mesh, bytes, count);
    assert_non_null(said);
    assert_string_equal(said, reason);
    assert_int_equal(mesh.vertex_count, 7); /* as it was */
}

#define REFUSED(bytes, reason) refused(bytes, sizeof bytes - 1, reason)
#define VERTICES "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

static void test_absurd_files(void **state) {
    (void)state;
    REFUSED("", "line 1: the end, and no triangle so far");
    REFUSED(VERTICES, "line 4: the end, and no triangle so far");
    REFUSED("v 0 0", "line 1: a vertex without three numbers");
    REFUSED("v 0 zero 0\n", "line 1: a vertex without three numbers");
    REFUSED("v 0 0 1x\n", "line 1: a vertex without three numbers");
    REFUSED("v 0 0 nan\n", "line 1: a vertex that is not finite");
    REFUSED("v 0 0 -inf\n", "line 1: a vertex that is not finite");
    REFUSED("v 0 0 1e39\n", "line 1: a vertex that is not finite"); /* as a float */
    REFUSED(VERTICES "f 1 2", "line 4: a face of fewer than three corners");
    REFUSED(VERTICES "f \n", "line 4: a face of fewer than three corners");
    REFUSED(VERTICES "f 1 2 4\n", "line 4: a corner that names no vertex so far");
    REFUSED(VERTICES "f 1 2 0\n", "line 4: a corner that names no vertex so far");
    REFUSED(VERTICES "f 1 2 -4\n", "line 4: a corner that names no vertex so far");
    REFUSED(VERTICES "f 1 2 99999999999999999999\n", "line 4: a corner that names no vertex so far");
    REFUSED(VERTICES "f 1 2 -99999999999999999999\n", "line 4: a corner that names no vertex so far");
    REFUSED(VERTICES "f 1 2 3.5\n", "line 4: a corner that is no number");
    REFUSED(VERTICES "f 1 2 x\n", "line 4: a corner that is no number");
    REFUSED("v 0 0 0\0\nv 1 0 0\n", "line 1: too long, or no text");
    char *line = malloc(1000000);
    assert_non_null(line);
    memset(line, 'f', 1000000);
    refused(line, 1000000, "line 1: too long, or no text");
    free(line);

    Mesh mesh;
    assert_string_equal(mesh_read(&mesh, "/nowhere/at/all.obj"), "No such file or directory");
    assert_non_null(mesh_read(&mesh, "/tmp"));
}

/* Cut anywhere, a file is refused or read as what is left of it; bytes changed at random likewise. */
static void test_damaged_files(void **state) {
    (void)state;
    const char whole[] = VERTICES "v 1 1 1\nf 1 2 3\nf 2/1 3/2/3 4\nf 1 2 3 4\n";
    char bytes[sizeof whole];
    for (int n = 0; n < 2000; n++) {
        memcpy(bytes, whole, sizeof whole);
        size_t count = n < (int)sizeof whole ? (size_t)n : sizeof whole - 1;
        if (n >= (int)sizeof whole)
            for (int k = 0; k < 3; k++) bytes[(size_t)random_in(0, (double)count)] = (char)random_in(0, 256);
        Mesh mesh;
        if (read_bytes(&mesh, bytes, count)) continue;
        assert_true(mesh.index_count > 0 && mesh.index_count % 3 == 0);
        for (int i = 0; i < mesh.index_count; i++) assert_true(mesh.indices[i] < (uint32_t)mesh.vertex_count);
        for (int i = 0; i < mesh.vertex_count; i++)
            for (int k = 0; k < 3; k++)
                assert_true(isfinite(mesh.vertices[i].position[k]) && fabsf(mesh.vertices[i].normal[k]) <= 1);
        mesh_destroy(&mesh);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_brute), cmocka_unit_test(test_no_leaks),
        cmocka_unit_test(test_borders),       cmocka_unit_test(test_one_triangle),
        cmocka_unit_test(test_file),          cmocka_unit_test(test_absurd_files),
        cmocka_unit_test(test_damaged_files),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("mesh_rays", tests, NULL, NULL);
}
