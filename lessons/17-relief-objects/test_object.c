/* The box of reliefs against the object itself: six small reliefs, no two of one size, are made of three
 * solids, warped, and what lands on the faces is held against rays. A point's colour is its position, so a
 * colour says what was seen. */
#define _GNU_SOURCE /* mkdtemp */
#include "exhibit.h"

#include "fail.h"
#include "solid.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const Vec3 size = {2.0, 1.6, 1.2}; /* of the box around the origin */
/* Beside one another along x and y, so that along no axis one hides another; the last sticks in the second.
 */
static const Solid solids[] = {
    {SOLID_SPHERE, {0.8, 0.8, 0.8}, {-0.55, 0.35, 0.05}, {0, 0, 0}, {0, 0, 0}},
    {SOLID_BOX, {0.8, 0.6, 0.8}, {0.5, -0.4, 0.1}, {0, 0, 0}, {0, 0, 0}},
    {SOLID_CYLINDER, {0.4, 0.95, 0.4}, {0.5, -0.4, -0.1}, {90, 0, 0}, {0, 0, 0}},
};
enum { SOLIDS = 3, SIZE = 64 };

/* ---- Six reliefs of them ---- */

static const Vec3 outward[FACES] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, {0, -1, 0}};
static const int columns[FACES] = {60, 47, 61, 64, 52, 58}, rows[FACES] = {51, 63, 48, 57, 49, 46};

/* u and v as mesh_box has them. */
static Basis basis_of(int face) {
    static const Vec3 rights[FACES] = {{1, 0, 0}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    Vec3 f = outward[face], a = vec3_multiply(rights[face], size);
    Vec3 b = vec3_multiply(vec3_cross(f, rights[face]), size);
    Vec3 middle = vec3_scale(vec3_multiply(f, size), 0.5);
    return (Basis){vec3_sub(middle, vec3_scale(vec3_add(a, b), 0.5)), a, b, f, ""};
}

static Vec3 colour_at(Vec3 p) { return v3(p.x / size.x + 0.5, p.y / size.y + 0.5, p.z / size.z + 0.5); }

/* What is in a box: nothing, the solids, or a body that fills it but for a slope on its front, up to the
 * right. */
typedef enum { EMPTY, OBJECT, FULL } Content;

static float height_if_full(int face, int x) {
    return face == 0 ? 0.9f + 0.1f * (float)x / (float)(columns[face] - 1) : 1.0f;
}

static void write_face(const char *folder, int face, Content content) {
    Basis basis = basis_of(face);
    Image colour = image_create(columns[face], rows[face], 3),
          height = image_create(columns[face], rows[face], 1);
    double deep = fabs(vec3_dot(basis.f, size));
    height.basis = basis, height.hollow = true, height.base = 1.0, height.scale = deep / vec3_length(basis.a);
    for (int y = 0; y < rows[face] && content != EMPTY; y++) {
        for (int x = 0; x < columns[face]; x++) {
            if (content == FULL) {
                *image_at(&height, x, y) = height_if_full(face, x);
                continue;
            }
            Vec3 along = vec3_add(vec3_scale(basis.a, (x + 0.5) / columns[face]),
                                  vec3_scale(basis.b, (y + 0.5) / rows[face]));
            Ray ray = {vec3_add(basis.origin, along), vec3_scale(basis.f, -1.0)};
            SolidHit hit;
            if (!solids_hit(solids, SOLIDS, ray, &hit)) continue;
            Vec3 c = colour_at(ray_at(ray, hit.depth));
            float *texel = image_at(&colour, x, y);
            texel[0] = (float)c.x, texel[1] = (float)c.y, texel[2] = (float)c.z;
            *image_at(&height, x, y) = (float)(1.0 - hit.depth / deep);
        }
    }
    char *path = text("%s/%s.exr", folder, face_names[face]);
    const char *reason = image_write_relief(&colour, &height, path, 32);
    if (reason) fail_msg("%s: %s", path, reason);
    free(path);
    image_destroy(&colour);
    image_destroy(&height);
}

static Box make_box(Content content, Walls walls) {
    char folder[] = "/tmp/texel-17-XXXXXX";
    assert_non_null(mkdtemp(folder));
    for (int i = 0; i < FACES; i++) write_face(folder, i, content);
    char *front = text("%s/front.exr", folder);
    Box box;
    box_load(&box, front, walls);
    free(front);
    for (int i = 0; i < FACES; i++) {
        char *path = text("%s/%s.exr", folder, face_names[i]);
        unlink(path);
        free(path);
    }
    rmdir(folder);
    return box;
}

static double random_in(double low, double high) { return low + (high - low) * rand() / RAND_MAX; }

static Vec3 random_direction(void) {
    double z = random_in(-1, 1), theta = random_in(-PI, PI), ring = sqrt(1 - z * z);
    return v3(ring * cos(theta), ring * sin(theta), z);
}

/* ---- Which faces are looked through ---- */

static unsigned set_of(Seen seen) {
    unsigned set = 0;
    for (int i = 0; i < seen.count; i++) set |= 1u << seen.faces[i];
    return set;
}

/* From each of 26 directions the faces on whose side it is, near and infinitely far. */
static void test_faces_seen(void **state) {
    (void)state;
    Box box = make_box(EMPTY, WALLS_SHARED);
    for (int x = -1; x <= 1; x++)
        for (int y = -1; y <= 1; y++)
            for (int z = -1; z <= 1; z++) {
                Vec3 way = v3(x, y, z);
                if (!x && !y && !z) continue;
                unsigned expected = 0;
                for (int i = 0; i < FACES; i++) expected |= vec3_dot(outward[i], way) > 0.5 ? 1u << i : 0;
                Seen near = box_faces_seen(&box, (Eye){vec3_scale(way, 1.5), 1});
                Seen far = box_faces_seen(&box, (Eye){vec3_normalize(way), 0});
                assert_int_equal(set_of(near), expected);
                assert_int_equal(set_of(far), expected);
                assert_false(near.inside || far.inside);
            }
    /* In the planes of two faces; inside; on a face; and just outside of it. */
    assert_int_equal(set_of(box_faces_seen(&box, (Eye){{1.0, 0.8, 5}, 1})), 1u << 0);
    Seen inside = box_faces_seen(&box, (Eye){{0.3, -0.2, 0.5}, 1});
    assert_true(inside.inside && inside.count == 6);
    inside = box_faces_seen(&box, (Eye){{1.0, 0.1, 0.2}, 1});
    assert_true(inside.inside && set_of(inside) == (63u & ~(1u << 1)));
    assert_int_equal(set_of(box_faces_seen(&box, (Eye){{1.0 + 1e-3, 0.1, 0.2}, 1})), 1u << 1);
    box_destroy(&box);
}

/* ---- What lands there ---- */

/* The line of sight through a point of a face: from the eye, or from far outside for one infinitely far. */
static Ray line_through(Eye eye, Vec3 point) {
    if (eye.w > 0.0) return (Ray){eye.at, vec3_normalize(vec3_sub(point, eye.at))};
    return (Ray){vec3_add(point, vec3_scale(eye.at, 9.0)), vec3_scale(eye.at, -1.0)};
}

typedef struct {
    int count, misses, hits, wrong_cover, wrong_place;
} Tally;

/* The texel's centre and points a texel and a half around it: what rays say must be one thing for the texel
 * to count, be it nothing or places next to each other. */
static void check_texel(const Box *box, const Destination *destination, Eye eye, int x, int y, Tally *tally) {
    const Face *face = &box->faces[destination->face];
    SolidHit hits[9];
    Vec3 places[9];
    int met = 0;
    for (int k = 0; k < 9; k++) {
        double u = (x + 0.5 + 1.5 * (k % 3 - 1)) / SIZE, v = (y + 0.5 + 1.5 * (k / 3 - 1)) / SIZE;
        Ray ray = line_through(eye, face_point(face, u, v, 0.0));
        bool hit = solids_hit(solids, SOLIDS, ray, &hits[k]);
        if (hit) places[k] = ray_at(ray, hits[k].depth);
        met += hit;
    }
    const uint16_t *colour = destination->colour + 4 * ((size_t)y * SIZE + x);
    if (met == 0) {
        tally->misses++;
        tally->wrong_cover += colour[3] != 0;
    }
    if (met < 9) return;
    for (int k = 0; k < 9; k++)
        if (vec3_length(vec3_sub(places[k], places[4])) > 0.2 || hits[k].index != hits[4].index) return;
    tally->hits++;
    tally->wrong_cover += colour[3] != 65535;
    Vec3 expected = colour_at(places[4]);
    double difference =
        fmax(fabs(colour[0] / 65535.0 - expected.x),
             fmax(fabs(colour[1] / 65535.0 - expected.y), fabs(colour[2] / 65535.0 - expected.z)));
    tally->wrong_place += difference > 0.035; /* a texel and a half of the coarsest relief */
}

static Tally check_eye(const Box *box, Warp *warp, Eye eye) {
    Tally tally = {0};
    warp_box(warp, box, eye, (Parts){.sources = 63, .rims = true});
    for (int i = 0; i < warp->count; i++)
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++) check_texel(box, &warp->destinations[i], eye, x, y, &tally);
    return tally;
}

/* 40 eyes around the box, a third of them infinitely far. Colours must be right; a few texels may show what
 * is a rim away from its place, or be where no relief has seen. */
static void test_against_rays(void **state) {
    (void)state;
    Box box = make_box(OBJECT, WALLS_SHARED);
    Warp warp = warp_create(SIZE, 1);
    Tally sum = {0};
    for (int n = 0; n < 40; n++) {
        Vec3 way = random_direction();
        Eye eye = n % 3 ? (Eye){vec3_scale(way, random_in(1.8, 6.0)), 1} : (Eye){way, 0};
        Tally tally = check_eye(&box, &warp, eye);
        sum.misses += tally.misses, sum.hits += tally.hits;
        sum.wrong_cover += tally.wrong_cover, sum.wrong_place += tally.wrong_place;
    }
    print_message("# %d hits, %d misses; wrong: %d covers, %d places\n", sum.hits, sum.misses,
                  sum.wrong_cover, sum.wrong_place);
    assert_true(sum.hits > 50000 && sum.misses > 50000);
    assert_true(sum.wrong_cover < 1e-3 * sum.misses);
    assert_true(sum.wrong_place < 1e-3 * sum.hits);
    warp_destroy(&warp);
    box_destroy(&box);
}

/* Eyes between the object and the box. */
static void test_from_inside(void **state) {
    (void)state;
    Box box = make_box(OBJECT, WALLS_SHARED);
    Warp warp = warp_create(SIZE, 1);
    const Vec3 eyes[] = {{0.3, 0.6, 0.5}, {-0.9, -0.7, 0.5}, {-0.1, -0.2, -0.5}, {0.95, 0.75, 0.5}};
    Tally sum = {0};
    for (int i = 0; i < 4; i++) {
        Tally tally = check_eye(&box, &warp, (Eye){eyes[i], 1});
        assert_int_equal(warp.count, 6);
        sum.misses += tally.misses, sum.hits += tally.hits;
        sum.wrong_cover += tally.wrong_cover, sum.wrong_place += tally.wrong_place;
    }
    print_message("# %d hits, %d misses; wrong: %d covers, %d places\n", sum.hits, sum.misses,
                  sum.wrong_cover, sum.wrong_place);
    assert_true(sum.hits > 5000 && sum.misses > 5000);
    assert_true(sum.wrong_cover < 1e-3 * (sum.misses + sum.hits));
    assert_true(sum.wrong_place < 1e-2 * sum.hits);
    warp_destroy(&warp);
    box_destroy(&box);
}

static void test_hollow(void **state) {
    (void)state;
    Box box = make_box(EMPTY, WALLS_SHARED);
    Warp warp = warp_create(SIZE, 2);
    warp_box(&warp, &box, (Eye){{2, 3, 4}, 1}, (Parts){63, true});
    assert_int_equal(warp.count, 3);
    for (int i = 0; i < warp.count; i++)
        for (int k = 0; k < 4 * SIZE * SIZE; k++)
            assert_true(!warp.destinations[i].colour[k] && !warp.destinations[i].normal[k]);
    warp_destroy(&warp);
    box_destroy(&box);
}

/* ---- Where surfaces end ---- */

/* How much of the front is covered, seen straight on from far: the box's edges lie between texels. */
static double covered_area(const Box *box, bool rims) {
    Warp warp = warp_create(SIZE, 4);
    warp_box(&warp, box, (Eye){{0, 0, 1}, 0}, (Parts){63, rims});
    double sum = 0.0;
    for (int k = 0; k < SIZE * SIZE; k++) sum += warp.destinations[0].colour[4 * k + 3] / 65535.0;
    warp_destroy(&warp);
    return sum / (SIZE * SIZE) * size.x * size.y;
}

static void test_rims(void **state) {
    (void)state;
    Box box = make_box(OBJECT, WALLS_SHARED);
    int inside = 0;
    enum { RAYS = 1000 };
    for (int y = 0; y < RAYS; y++)
        for (int x = 0; x < RAYS; x++) {
            SolidHit hit;
            Vec3 from = v3(size.x * ((x + 0.5) / RAYS - 0.5), size.y * ((y + 0.5) / RAYS - 0.5), 1);
            inside += solids_hit(solids, SOLIDS, (Ray){from, {0, 0, -1}}, &hit);
        }
    double exact = inside / (double)(RAYS * RAYS) * size.x * size.y;
    double with = covered_area(&box, true), without = covered_area(&box, false);
    print_message("# area %.4f: with rims %.4f, without %.4f\n", exact, with, without);
    assert_true(fabs(with - exact) < 0.01 * exact);
    assert_true(without < 0.97 * exact);
    box_destroy(&box);
}

/* What fills its box is seen up to the edges of the faces, where there are no texels left, and not beyond. A
 * texel in a corner loses what is beyond the line between its ends along both edges. */
static void test_full_box(void **state) {
    (void)state;
    Box box = make_box(FULL, WALLS_SHARED);
    Warp warp = warp_create(SIZE, 4);
    warp_box(&warp, &box, (Eye){{0, 0, 1}, 0}, (Parts){63, true});
    int partly = 0;
    for (int k = 0; k < SIZE * SIZE; k++) {
        bool corner = (k % SIZE == 0 || k % SIZE == SIZE - 1) && (k / SIZE == 0 || k / SIZE == SIZE - 1);
        uint16_t covered = warp.destinations[0].colour[4 * k + 3];
        partly += covered < 65535;
        assert_true(corner ? covered > 65535 / 2 : covered == 65535);
    }
    print_message("# %d partly\n", partly);
    for (int f = 0; f < FACES; f++)
        for (int i = 0; i < box.faces[f].rim_count; i++)
            for (int k = 0; k < 3; k++) assert_true(box.faces[f].rims[i].corners[k].d <= 0.0f);
    warp_destroy(&warp);
    box_destroy(&box);
}

/* Fails if a triangle faces an eye, or is not in its tile's sphere. */
static void check_faces_away(const Face *face, const Tile *tile, const Spot spots[3], Eye eye) {
    Vec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = face_point(face, spots[k].u, spots[k].v, spots[k].d);
        assert_true(vec3_length(vec3_sub(p[k], tile->centre)) < tile->radius + 1e-6);
    }
    Vec3 normal = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
    assert_true(vec3_dot(normal, eye.w > 0.0 ? vec3_sub(eye.at, p[0]) : eye.at) < 1e-9);
}

static void check_tile(const Face *face, const Tile *tile, Eye eye) {
    for (int i = 0; i < tile->rim_count; i++)
        check_faces_away(face, tile, face->rims[tile->first_rim + i].corners, eye);
    for (int y = tile->row; y < tile->row + tile->rows; y++)
        for (int x = tile->column; x < tile->column + tile->columns; x++) {
            if (!face->cells[y * (face->width - 1) + x]) continue;
            Spot spots[4]; /* both triangles begin at the first, and the third is in both */
            for (int k = 0; k < 4; k++) {
                int column = x + (k == 1 || k == 2), row = y + k / 2;
                spots[k] = (Spot){(float)((column + 0.5) / face->width), (float)((row + 0.5) / face->height),
                                  face->d[row * face->width + column]};
            }
            check_faces_away(face, tile, (const Spot[]){spots[0], spots[1], spots[2]}, eye);
            check_faces_away(face, tile, (const Spot[]){spots[0], spots[2], spots[3]}, eye);
        }
}

/* A tile that is passed over has no triangle that faces the eye: far eyes, near ones, and ones in the box, to
 * which a tile is large. */
static void test_tiles_face_away(void **state) {
    (void)state;
    Box box = make_box(OBJECT, WALLS_SHARED);
    int away = 0, total = 0;
    for (int n = 0; n < 300; n++) {
        Vec3 way = random_direction();
        Eye eye = n % 3 ? (Eye){vec3_scale(way, n % 3 == 1 ? 2.0 : random_in(0.3, 1.0)), 1} : (Eye){way, 0};
        for (int f = 0; f < FACES; f++) {
            const Face *face = &box.faces[f];
            for (int t = 0; t < face->tile_count; t++, total++) {
                if (!tile_faces_away(&face->tiles[t], eye)) continue;
                away++;
                check_tile(face, &face->tiles[t], eye);
            }
        }
    }
    print_message("# %d of %d tiles face away\n", away, total);
    assert_true(away > total / 10);
    box_destroy(&box);
}

/* All neighbours joined: no rims but at the border of what is there. */
static void test_bridged(void **state) {
    (void)state;
    Box box = make_box(OBJECT, WALLS_SHARED), bridged = make_box(OBJECT, WALLS_BRIDGED);
    int cells[2] = {0};
    for (int f = 0; f < FACES; f++)
        for (int i = 0; i < (columns[f] - 1) * (rows[f] - 1); i++) {
            cells[0] += box.faces[f].cells[i];
            cells[1] += bridged.faces[f].cells[i];
            assert_true(bridged.faces[f].cells[i] >= box.faces[f].cells[i]);
        }
    assert_true(cells[1] > cells[0]);
    box_destroy(&box);
    box_destroy(&bridged);
}

/* The light turns about the vertical axis: two seconds are a quarter, eight the whole. */
static void test_light(void **state) {
    (void)state;
    Vec3 start = exhibit_light(0), quarter = exhibit_light(2), end = exhibit_light(8);
    assert_true(fabs(vec3_length(start) - 1.0) < 1e-12);
    assert_true(vec3_length(vec3_sub(quarter, v3(start.z, start.y, -start.x))) < 1e-12);
    assert_true(vec3_length(vec3_sub(end, start)) < 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_faces_seen),  cmocka_unit_test(test_against_rays),
        cmocka_unit_test(test_from_inside), cmocka_unit_test(test_hollow),
        cmocka_unit_test(test_rims),        cmocka_unit_test(test_tiles_face_away),
        cmocka_unit_test(test_bridged),     cmocka_unit_test(test_full_box),
        cmocka_unit_test(test_light),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson 17", tests, NULL, NULL);
}
