/* Meshes: what every vertex and triangle must keep in every shape, then each shape's own places. */
#define _POSIX_C_SOURCE 200809L /* fdopen */
#include "mesh.h"
#include "vec.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef enum { PLANE, PRISM, CYLINDER, SPHERE, BOX } Kind;

/* Odd counts, and the smallest, are where seams and poles go wrong. */
static const struct {
    const char *name;
    Kind kind;
    double a, b, c; /* width, height, depth; or radius, height */
    int columns, rows, triangles;
    int rim; /* edges that belong to one triangle alone */
} shapes[] = {
    {"the smallest plane", PLANE, 2.0, 1.0, 0.0, 1, 1, 2, 4},
    {"a plane", PLANE, 0.7, 3.1, 0.0, 7, 5, 70, 24},
    {"the smallest prism", PRISM, 1.3, 2.0, 0.0, 3, 1, 6, 6},
    {"a prism", PRISM, 0.37, 0.9, 0.0, 11, 1, 22, 22},
    {"the smallest cylinder", CYLINDER, 1.3, 2.0, 0.0, 3, 1, 6, 6},
    {"a cylinder", CYLINDER, 0.37, 0.9, 0.0, 24, 1, 48, 48},
    {"the smallest sphere", SPHERE, 1.0, 0.0, 0.0, 3, 2, 6, 0},
    {"a sphere", SPHERE, 1.7, 0.0, 0.0, 13, 9, 208, 0},
    {"a finer sphere", SPHERE, 0.3, 0.0, 0.0, 16, 16, 480, 0},
    {"a box", BOX, 0.7, 1.1, 2.3, 0, 0, 12, 0},
};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static Mesh meshes[SHAPES];

static int make_all(void **state) {
    (void)state;
    for (int i = 0; i < SHAPES; i++) {
        double a = shapes[i].a, b = shapes[i].b;
        switch (shapes[i].kind) {
        case PLANE: meshes[i] = mesh_plane(a, b, shapes[i].columns, shapes[i].rows); break;
        case PRISM: meshes[i] = mesh_prism(a, b, shapes[i].columns); break;
        case CYLINDER: meshes[i] = mesh_cylinder(a, b, shapes[i].columns); break;
        case SPHERE: meshes[i] = mesh_sphere(a, shapes[i].columns, shapes[i].rows); break;
        case BOX: meshes[i] = mesh_box(a, b, shapes[i].c); break;
        }
    }
    return 0;
}

static int destroy_all(void **state) {
    (void)state;
    for (int i = 0; i < SHAPES; i++) mesh_destroy(&meshes[i]);
    return 0;
}

static Vec3 vector(const float *p) { return v3(p[0], p[1], p[2]); }

static Vec3 normal_of(const Vertex *vertex) { return vector(vertex->normal); }
static Vec3 tangent_of(const Vertex *vertex) { return vector(vertex->tangent); }
static Vec3 bitangent_of(const Vertex *vertex) {
    return vec3_scale(vec3_cross(normal_of(vertex), tangent_of(vertex)), vertex->tangent[3]);
}

/* The corners of triangle t, and its edges from the first. */
typedef struct {
    const Vertex *corners[3];
    Vec3 edges[2];
} Triangle;

static Triangle triangle(const Mesh *mesh, int t) {
    Triangle result;
    for (int k = 0; k < 3; k++) result.corners[k] = &mesh->vertices[mesh->indices[3 * t + k]];
    for (int k = 0; k < 2; k++)
        result.edges[k] =
            vec3_sub(vector(result.corners[k + 1]->position), vector(result.corners[0]->position));
    return result;
}

static void indices_are_in_range(void **state) {
    (void)state;
    for (int i = 0; i < SHAPES; i++) {
        if (meshes[i].index_count != 3 * shapes[i].triangles)
            fail_msg("%s: %d indices for %d triangles", shapes[i].name, meshes[i].index_count,
                     shapes[i].triangles);
        for (int k = 0; k < meshes[i].index_count; k++)
            if (meshes[i].indices[k] >= (uint32_t)meshes[i].vertex_count)
                fail_msg("%s: index %d is %u of %d vertices", shapes[i].name, k, meshes[i].indices[k],
                         meshes[i].vertex_count);
    }
}

static void frames_are_orthonormal(void **state) {
    (void)state;
    for (int i = 0; i < SHAPES; i++)
        for (int k = 0; k < meshes[i].vertex_count; k++) {
            const Vertex *vertex = &meshes[i].vertices[k];
            Vec3 normal = normal_of(vertex), tangent = tangent_of(vertex);
            if (!(fabs(vec3_length(normal) - 1.0) < 2e-7 && fabs(vec3_length(tangent) - 1.0) < 2e-7 &&
                  fabs(vec3_dot(normal, tangent)) < 2e-7 && fabs(vertex->tangent[3]) == 1.0f))
                fail_msg("%s: vertex %d: lengths %.9g and %.9g, cosine %g, w %g", shapes[i].name, k,
                         vec3_length(normal), vec3_length(tangent), vec3_dot(normal, tangent),
                         vertex->tangent[3]);
        }
}

static void triangles_face_outward(void **state) {
    (void)state;
    for (int i = 0; i < SHAPES; i++)
        for (int t = 0; t < meshes[i].index_count / 3; t++) {
            Triangle at = triangle(&meshes[i], t);
            Vec3 cross = vec3_cross(at.edges[0], at.edges[1]);
            if (!(vec3_length(cross) > 1e-6)) fail_msg("%s: triangle %d has no area", shapes[i].name, t);
            for (int k = 0; k < 3; k++)
                if (!(vec3_dot(cross, normal_of(at.corners[k])) > 0.0))
                    fail_msg("%s: triangle %d turns from the normal of its corner %d", shapes[i].name, t, k);
        }
}

/* On flat patches the tangents are the derivatives. On round ones the triangle is a chord: the mean of its
 * corners' tangents then leans from it by no more than a column and a row turn, and each stays on its side.
 */
static void tangents_are_derivatives(void **state) {
    (void)state;
    for (int i = 0; i < SHAPES; i++)
        for (int t = 0; t < meshes[i].index_count / 3; t++) {
            Triangle at = triangle(&meshes[i], t);
            double du[2], dv[2];
            for (int k = 0; k < 2; k++) {
                du[k] = (double)at.corners[k + 1]->uv[0] - at.corners[0]->uv[0];
                dv[k] = (double)at.corners[k + 1]->uv[1] - at.corners[0]->uv[1];
            }
            /* edges[k] = du[k] dP/du + dv[k] dP/dv, solved for the two derivatives by Cramer's rule. */
            double determinant = du[0] * dv[1] - du[1] * dv[0];
            if (!(determinant > 0.0)) fail_msg("%s: triangle %d is mirrored in uv", shapes[i].name, t);
            Vec3 by_u = vec3_sub(vec3_scale(at.edges[0], dv[1]), vec3_scale(at.edges[1], dv[0]));
            Vec3 by_v = vec3_sub(vec3_scale(at.edges[1], du[0]), vec3_scale(at.edges[0], du[1]));
            bool flat = shapes[i].kind == PLANE || shapes[i].kind == PRISM || shapes[i].kind == BOX;
            double least = flat ? 1.0 - 1e-6 : 0.0;
            for (int k = 0; k < 3; k++) {
                double along_u = vec3_dot(vec3_normalize(by_u), tangent_of(at.corners[k]));
                double along_v = vec3_dot(vec3_normalize(by_v), bitangent_of(at.corners[k]));
                if (!(along_u > least && along_v > least))
                    fail_msg("%s: triangle %d, corner %d: cosines %g to dP/du, %g to dP/dv", shapes[i].name,
                             t, k, along_u, along_v);
            }
        }
}

/* ---- Closedness: vertices are one where their positions are the same floats ---- */

static bool same_place(const float *p, const float *q) {
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/* Corner k (mod 3) of triangle t. */
static const float *corner(const Mesh *mesh, int t, int k) {
    return mesh->vertices[mesh->indices[3 * t + k % 3]].position;
}

/* How often the mesh has the edge from p to q, in that direction. */
static int count_edge(const Mesh *mesh, const float *p, const float *q) {
    int count = 0;
    for (int t = 0; t < mesh->index_count / 3; t++)
        for (int k = 0; k < 3; k++)
            count += same_place(corner(mesh, t, k), p) && same_place(corner(mesh, t, k + 1), q);
    return count;
}

/* Whether the edge from p to q lies where the plane, prism or cylinder ends. */
static bool on_rim(int shape, const float *p, const float *q) {
    float x = (float)(shapes[shape].a / 2.0), y = (float)(shapes[shape].b / 2.0);
    bool level = fabsf(p[1]) == y && p[1] == q[1];
    if (shapes[shape].kind == PLANE) return level || (fabsf(p[0]) == x && p[0] == q[0]);
    return level;
}

static void edges_meet_exactly(void **state) {
    (void)state;
    for (int i = 0; i < SHAPES; i++) {
        int rim = 0;
        for (int t = 0; t < meshes[i].index_count / 3; t++)
            for (int k = 0; k < 3; k++) {
                const float *p = corner(&meshes[i], t, k), *q = corner(&meshes[i], t, k + 1);
                int forth = count_edge(&meshes[i], p, q), back = count_edge(&meshes[i], q, p);
                if (forth != 1 || back > 1 || (back == 0 && !on_rim(i, p, q)))
                    fail_msg("%s: edge %d of triangle %d occurs %d times, its reverse %d times",
                             shapes[i].name, k, t, forth, back);
                rim += back == 0;
            }
        if (rim != shapes[i].rim)
            fail_msg("%s: %d edges on the rim, not %d", shapes[i].name, rim, shapes[i].rim);
    }
}

/* ---- Each shape's own places ---- */

/* Where the triangles put (u, v): the point and normal, by barycentric coordinates. On a box, of the face
 * whose normal is toward. */
static void at_uv(const Mesh *mesh, double u, double v, Vec3 toward, Vec3 *position, Vec3 *normal) {
    for (int t = 0; t < mesh->index_count / 3; t++) {
        Triangle at = triangle(mesh, t);
        const float *p = at.corners[0]->uv, *q = at.corners[1]->uv, *r = at.corners[2]->uv;
        double area =
            ((double)q[0] - p[0]) * ((double)r[1] - p[1]) - ((double)r[0] - p[0]) * ((double)q[1] - p[1]);
        double b = ((u - p[0]) * ((double)r[1] - p[1]) - ((double)r[0] - p[0]) * (v - p[1])) / area;
        double c = (((double)q[0] - p[0]) * (v - p[1]) - (u - p[0]) * ((double)q[1] - p[1])) / area;
        if (b < -1e-6 || c < -1e-6 || b + c > 1.0 + 1e-6) continue;
        if (vec3_dot(normal_of(at.corners[0]), toward) < 0.5) continue;
        *position = vec3_add(vector(at.corners[0]->position),
                             vec3_add(vec3_scale(at.edges[0], b), vec3_scale(at.edges[1], c)));
        *normal = normal_of(at.corners[0]);
        return;
    }
    fail_msg("no triangle at u %g, v %g", u, v);
}

static void expect_near(const char *what, Vec3 got, Vec3 expected) {
    if (!(vec3_length(vec3_sub(got, expected)) < 1e-6))
        fail_msg("%s: (%g, %g, %g), not (%g, %g, %g)", what, got.x, got.y, got.z, expected.x, expected.y,
                 expected.z);
}

static void plane_is_where_its_uv_say(void **state) {
    (void)state;
    Mesh mesh = mesh_plane(4.0, 2.0, 3, 5);
    assert_int_equal(mesh.vertex_count, 4 * 6);
    for (int k = 0; k < mesh.vertex_count; k++) {
        const Vertex *vertex = &mesh.vertices[k];
        expect_near("position", vector(vertex->position),
                    v3(4.0 * (vertex->uv[0] - 0.5), 2.0 * (vertex->uv[1] - 0.5), 0.0));
        expect_near("normal", normal_of(vertex), v3(0, 0, 1));
        expect_near("tangent", tangent_of(vertex), v3(1, 0, 0));
        expect_near("bitangent", bitangent_of(vertex), v3(0, 1, 0));
    }
    mesh_destroy(&mesh);
    assert_null(mesh.vertices);
}

static void prism_and_cylinder_agree_with_theta(void **state) {
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        Mesh mesh = kind ? mesh_cylinder(2.0, 3.0, 7) : mesh_prism(2.0, 3.0, 7);
        assert_int_equal(mesh.vertex_count, kind ? 8 * 2 : 7 * 4);
        for (int k = 0; k < mesh.vertex_count; k++) {
            const Vertex *vertex = &mesh.vertices[k];
            double theta = 2.0 * PI * vertex->uv[0] - PI;
            expect_near("corner", vector(vertex->position),
                        v3(2.0 * sin(theta), 3.0 * (vertex->uv[1] - 0.5), 2.0 * cos(theta)));
            if (kind) expect_near("normal", normal_of(vertex), v3(sin(theta), 0.0, cos(theta)));
        }
        for (int t = 0; t < mesh.index_count / 3 && !kind; t++) {
            Triangle at = triangle(&mesh, t); /* a face: its normal is the one across its middle */
            double theta = 2.0 * PI * (t / 2 + 0.5) / 7.0 - PI;
            for (int k = 0; k < 3; k++)
                expect_near("face", normal_of(at.corners[k]), v3(sin(theta), 0.0, cos(theta)));
        }
        mesh_destroy(&mesh);
    }
}

static void prism_u_is_linear_along_a_face(void **state) {
    (void)state;
    Mesh mesh = mesh_prism(1.0, 2.0, 4); /* corners at u = 0, 1/4, ..: toward -z, -x, +z, +x */
    Vec3 position, normal;
    at_uv(&mesh, 0.0625, 0.5, v3(-1, 0, -1), &position, &normal);
    expect_near("a quarter along", position, v3(-0.25, 0.0, -0.75));
    expect_near("its normal", normal, v3(-sqrt(0.5), 0.0, -sqrt(0.5)));
    at_uv(&mesh, 0.6875, 1.0, v3(1, 0, 1), &position, &normal);
    expect_near("three quarters along, at the top", position, v3(0.75, 1.0, 0.25));
    mesh_destroy(&mesh);
}

static void sphere_is_where_its_uv_say(void **state) {
    (void)state;
    Mesh mesh = mesh_sphere(2.0, 9, 6);
    int poles = 0;
    for (int k = 0; k < mesh.index_count; k++) { /* by the indices: those vertices that a triangle uses */
        const Vertex *vertex = &mesh.vertices[mesh.indices[k]];
        double theta = 2.0 * PI * vertex->uv[0] - PI, latitude = PI * (vertex->uv[1] - 0.5);
        Vec3 out = v3(sin(theta) * cos(latitude), sin(latitude), cos(theta) * cos(latitude));
        expect_near("position", vector(vertex->position), vec3_scale(out, 2.0));
        expect_near("normal", normal_of(vertex), out);
        expect_near("tangent", tangent_of(vertex), v3(cos(theta), 0.0, -sin(theta)));
        if (vertex->uv[1] != 0.0f && vertex->uv[1] != 1.0f) continue;
        poles++;
        assert_true(vertex->position[0] == 0.0f && vertex->position[2] == 0.0f);
        Triangle at = triangle(&mesh, k / 3); /* u is the middle of the two other corners' */
        double sum = (double)at.corners[0]->uv[0] + at.corners[1]->uv[0] + at.corners[2]->uv[0];
        assert_true(fabs(sum - 3.0 * vertex->uv[0]) < 1e-6);
    }
    assert_int_equal(poles, 2 * 9);
    mesh_destroy(&mesh);
}

static void box_faces_read_upright(void **state) {
    (void)state;
    static const struct {
        const char *name;
        Vec3 normal, quarter; /* where u = 1/4 and v = 1/8 are, in a box of 2 x 4 x 8 */
    } faces[] = {
        {"toward +z", {0, 0, 1}, {-0.5, -1.5, 4}},  {"toward +x", {1, 0, 0}, {1, -1.5, 2}},
        {"toward -z", {0, 0, -1}, {0.5, -1.5, -4}}, {"toward -x", {-1, 0, 0}, {-1, -1.5, -2}},
        {"the top", {0, 1, 0}, {-0.5, 2, 3}},       {"the bottom", {0, -1, 0}, {-0.5, -2, -3}},
    };
    Mesh mesh = mesh_box(2.0, 4.0, 8.0);
    assert_int_equal(mesh.vertex_count, 24);
    for (int i = 0; i < 6; i++) {
        Vec3 position, normal;
        at_uv(&mesh, 0.25, 0.125, faces[i].normal, &position, &normal);
        expect_near(faces[i].name, position, faces[i].quarter);
        expect_near(faces[i].name, normal, faces[i].normal);
    }
    mesh_destroy(&mesh);
}

/* ---- What must not be asked for ---- */

static void ask_plane_of_no_column(void) { mesh_plane(1.0, 1.0, 0, 1); }
static void ask_plane_of_no_width(void) { mesh_plane(0.0, 1.0, 1, 1); }
static void ask_prism_of_two(void) { mesh_prism(1.0, 1.0, 2); }
static void ask_cylinder_of_nan(void) { mesh_cylinder(NAN, 1.0, 3); }
static void ask_sphere_of_one_row(void) { mesh_sphere(1.0, 3, 1); }
static void ask_box_of_no_depth(void) { mesh_box(1.0, 1.0, -1.0); }
static void ask_too_much(void) { mesh_plane(1.0, 1.0, 2000000000, 2000000000); }

static void bad_arguments_end_the_program(void **state) {
    (void)state;
    static const struct {
        void (*ask)(void);
        const char *expected;
    } cases[] = {
        {ask_plane_of_no_column, "mesh_plane: no plane has 1 x 1 in 0 x 1 cells"},
        {ask_plane_of_no_width, "mesh_plane: no plane has 0 x 1 in 1 x 1 cells"},
        {ask_prism_of_two, "mesh_prism: no prism has radius 1, height 1 and 2 sides"},
        {ask_cylinder_of_nan, "mesh_cylinder: no cylinder has radius nan, height 1 and 3 sides"},
        {ask_sphere_of_one_row, "mesh_sphere: no sphere has radius 1 in 3 x 1 cells"},
        {ask_box_of_no_depth, "mesh_box: no box has 1 x 1 x -1"},
        {ask_too_much, "mesh: 1 x 2000000000 x 2000000000 cells are too many"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int ends[2], status;
        assert_int_equal(pipe(ends), 0);
        fflush(NULL);
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            dup2(ends[1], STDERR_FILENO);
            cases[i].ask();
            _exit(0);
        }
        close(ends[1]);
        char said[256] = "";
        FILE *stream = fdopen(ends[0], "r");
        assert_non_null(stream);
        if (!fgets(said, sizeof said, stream)) said[0] = '\0';
        assert_int_equal(fgetc(stream), EOF); /* one line */
        fclose(stream);
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 1);
        if (!strstr(said, cases[i].expected)) fail_msg("said \"%s\", not \"%s\"", said, cases[i].expected);
    }
}

int main(void) {
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(indices_are_in_range),
        cmocka_unit_test(frames_are_orthonormal),
        cmocka_unit_test(triangles_face_outward),
        cmocka_unit_test(tangents_are_derivatives),
        cmocka_unit_test(edges_meet_exactly),
        cmocka_unit_test(plane_is_where_its_uv_say),
        cmocka_unit_test(prism_and_cylinder_agree_with_theta),
        cmocka_unit_test(prism_u_is_linear_along_a_face),
        cmocka_unit_test(sphere_is_where_its_uv_say),
        cmocka_unit_test(box_faces_read_upright),
        cmocka_unit_test(bad_arguments_end_the_program),
    };
    return cmocka_run_group_tests_name("mesh", tests, make_all, destroy_all);
}
