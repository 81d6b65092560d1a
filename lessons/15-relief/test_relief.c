/* The exact searches of GLSL, drawn off-screen, against the truth on maps made to mislead them; the shadow
 * against shadows whose length is known. */
#define _GNU_SOURCE /* mkdtemp */
#include "context.h"
#include "fail.h"
#include "relief.h"
#include "stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* ---- Maps made to mislead ---- */

static float flat_0(int x, int y) { return (void)x, (void)y, 0.0f; }
static float flat_1(int x, int y) { return (void)x, (void)y, 1.0f; }
static float peak(int x, int y) { return x == 3 && y == 2; }
static float hole(int x, int y) { return !(x == 3 && y == 2); }
static float saddles(int x, int y) { return (float)((x + y) % 2); }
static float pins(int x, int y) { return x % 8 == 5 && (y + x / 8) % 8 == 3; }
static float uneven(int x, int y) { return (float)((60 + x * 37 + y * 61 + x * y * 13) % 101) / 100; }
static float bits(int x, int y) { return (float)((x * 7 + y * 3) % 16 + 100) / 255; }

typedef struct {
    const char *name;
    int width, height;
    float (*height_at)(int x, int y);
} Map;

static const Map maps[] = {
    {"flat 0", 4, 4, flat_0}, {"flat 1", 4, 4, flat_1},   {"one peak", 8, 8, peak},
    {"one hole", 8, 8, hole}, {"saddles", 8, 8, saddles}, {"pins", 64, 64, pins},
    {"7 x 5", 7, 5, uneven},  {"1 x 9", 1, 9, uneven},    {"6 x 1", 6, 1, uneven},
    {"1 x 1", 1, 1, uneven},  {"3 x 4", 3, 4, uneven},    {"33 x 65", 33, 65, uneven},
    {"8 bits", 32, 32, bits},
};
enum { MAPS = sizeof maps / sizeof *maps };

static Image map_image(const Map *map) {
    Image image = image_create(map->width, map->height, 1);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) *image_at(&image, x, y) = map->height_at(x, y);
    return image;
}

/* ---- Rays ---- */

enum { SIDE = 32 }; /* of the square of rays that one draw follows */

/* Where they cross the polygon: below, centres of texels and their middles, in which cells have their corners
 * and edges; above, anywhere. */
static Image origins_of(const Image *height) {
    Image origins = image_create(SIDE, SIDE, 2);
    unsigned state = 1;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int k = 0; k < 2; k++) {
                int size = k ? height->height : height->width;
                state = state * 1664525u + 1013904223u;
                double anywhere = (state >> 8) / 0x1p24, half_texels = (k ? y : x) % (2 * size) + 0.5;
                image_at(&origins, x, y)[k] =
                    (float)(y < SIDE / 2 ? (half_texels - 0.5) / (2 * size) : anywhere);
            }
    return origins;
}

enum { VIEWS = 25 };

/* Vectors toward the eye: at an angle from the normal, along the axes, along diagonals of texels (rays that
 * come through a corner then come through all), and askew. */
static int views_of(const Relief *relief, Vec3 views[VIEWS]) {
    static const double angles[] = {30, 60, 87};
    double diagonal = atan2(relief->aspect * relief->height->width, relief->height->height);
    const double azimuths[] = {0, PI / 2, PI, -PI / 2, diagonal, PI - diagonal, 0.7, -2.4};
    int count = 0;
    views[count++] = v3(0, 0, 1);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 8; k++) {
            double tangent = tan(radians(angles[i]));
            double x = tangent * cos(azimuths[k]), y = tangent * sin(azimuths[k]);
            if (fabs(x) < 1e-9 * tangent) x = 0;
            if (fabs(y) < 1e-9 * tangent) y = 0;
            Vec3 unit = vec3_normalize(v3(x, y, 1));
            views[count++] = v3((float)unit.x, (float)unit.y, (float)unit.z); /* what GLSL gets */
        }
    return count;
}

/* ---- GLSL against the truth ---- */

/* A shader that follows each pixel's ray by a search. */
static Program build(const char *search) {
    char *folder = project_path("lessons/15-relief"), *common = project_path("common");
    char *shader = text("#include \"maximum.glsl\"\n#include \"cone.glsl\"\n"
                        "layout(location = 0) out vec4 drawn;\nlayout(location = 1) out vec4 found;\n"
                        "uniform sampler2D pyramid_map, corner_map, cone_map, origins;\n"
                        "uniform vec4 view;\nuniform float scale, base, aspect;\n"
                        "void main() {\n"
                        "    vec2 uv = texelFetch(origins, ivec2(gl_FragCoord.xy), 0).xy;\n"
                        "    HeightRay ray = height_ray(uv, view.xyz, scale, base, aspect);\n"
                        "    float t = %s;\n"
                        "    drawn = vec4(1.0);\n    found = vec4(ray_uv(ray, t), t, 1.0);\n}\n",
                        search);
    Program program = {0};
    char *log = program_build_text(&program, folder, common, "everywhere.vert", "test", shader, GLSL_330);
    if (log) fail_msg("%s", log);
    free(shader), free(folder), free(common);
    return program;
}

/* A relief and the rays that are sent to it. */
typedef struct {
    Image height, origins;
    Relief relief;
    Maps maps;
    Texture origins_texture;
} Range;

static Range *range_create(const Map *map, double base) {
    Range *range = allocate(1, sizeof *range);
    range->height = map_image(map);
    range->origins = origins_of(&range->height);
    bool row = map->width == 1 || map->height == 1; /* texels need not be square */
    double aspect = row ? 0.75 : (double)map->height / map->width;
    range->relief = (Relief){&range->height, 1.0, aspect, 0.1, base, RELIEF_REPEATED};
    range->maps = maps_create(&range->height);
    maps_need_cones(&range->maps, &range->height);
    range->origins_texture = texture_create(&range->origins, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    return range;
}

static void range_destroy(Range *range) {
    texture_destroy(&range->origins_texture);
    maps_destroy(&range->maps);
    image_destroy(&range->origins);
    image_destroy(&range->height);
    free(range);
}

static void range_draw(const Range *range, Program *program, Vec3 view, const Target *target,
                       Picture *picture) {
    target_begin(target, v3(0, 0, 0));
    program_use(program);
    maps_bind(&range->maps, program);
    program_texture(program, "origins", &range->origins_texture);
    program_vector(program, "view", view.x, view.y, view.z, 0);
    program_number(program, "scale", range->relief.scale);
    program_number(program, "base", range->relief.base);
    program_number(program, "aspect", range->relief.aspect);
    draw_everywhere();
    target_read(target, picture);
}

/* The exact hit of a ray in the shader's terms. */
static Sample exact_hit(const Relief *relief, const float *origin, Vec3 view) {
    Vec3 toward = vec3_normalize(view);
    Vec3 on_polygon = v3(origin[0] - 0.5, (origin[1] - 0.5) * relief->aspect, 0.0);
    return truth_relief(relief,
                        (Ray){vec3_add(on_polygon, vec3_scale(toward, 4.0)), vec3_scale(toward, -1.0)});
}

typedef struct {
    double rays, wrong, through; /* more than 0.01 texels from the exact hit; and behind it */
} Tally;

static void tally_rays(const Range *range, Vec3 view, const Image *found, Tally *tally) {
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            Sample exact = exact_hit(&range->relief, image_at(&range->origins, x, y), view);
            if (!exact.hit) continue; /* rounding moved an origin on the polygon's edge off it */
            const float *at = image_at(found, x, y);
            double du = (at[0] - exact.u) * range->height.width,
                   dv = (at[1] - exact.v) * range->height.height;
            bool wrong = !(hypot(du, dv) <= 0.01);
            tally->rays++;
            tally->wrong += wrong;
            tally->through += wrong && !(du * view.x + dv * view.y >= 0.0); /* not on the eye's side */
        }
}

static Tally compare(Program *program, const Map *map, double base) {
    Range *range = range_create(map, base);
    Target target = target_create(SIDE, SIDE, true);
    Picture picture = picture_create(SIDE, SIDE, true);
    Vec3 views[VIEWS];
    int count = views_of(&range->relief, views);
    Tally tally = {0};
    for (int i = 0; i < count; i++) {
        range_draw(range, program, views[i], &target, &picture);
        tally_rays(range, views[i], &picture.lookup, &tally);
    }
    picture_destroy(&picture);
    target_destroy(&target);
    range_destroy(range);
    assert_true(tally.rays > 0.9 * count * SIDE * SIDE);
    return tally;
}

/* All hits, but for one ray in 2000: at a grazing touch rounding decides. */
static void test_maximum_is_exact(void **state) {
    (void)state;
    Context *context = context_offscreen();
    Program program = build("maximum(pyramid_map, corner_map, ray)");
    for (int i = 0; i < MAPS; i++) {
        Tally tally = compare(&program, &maps[i], i % 2 ? 0.0 : 1.0);
        if (tally.wrong > tally.rays / 2000)
            fail_msg("%s: %g of %g rays end elsewhere", maps[i].name, tally.wrong, tally.rays);
    }
    program_destroy(&program);
    context_destroy(context);
}

/* With few steps a cone's ray ends too early, never too late. */
static void test_cone_is_conservative(void **state) {
    (void)state;
    Context *context = context_offscreen();
    Program program = build("cone(cone_map, corner_map, ray, 24)");
    for (int i = 0; i < MAPS; i++) {
        Tally tally = compare(&program, &maps[i], i % 2 ? 0.0 : 1.0);
        if (tally.through > tally.rays / 2000)
            fail_msg("%s: %g of %g rays go through", maps[i].name, tally.through, tally.rays);
    }
    program_destroy(&program);
    context_destroy(context);
}

/* ---- Shadow ---- */

/* A ridge along v, of height 1 and two texels wide at its foot, in the middle of 16; scale 1/8, so it is 2
 * texels high. The light from the left at 45 degrees: right of the ridge 2 texels lie in shadow. */
static void test_shadow_of_a_ridge(void **state) {
    (void)state;
    Image height = image_create(16, 1, 1);
    height.pixels[8] = 1.0f;
    Relief relief = {&height, 1.0, 1.0, 0.125, 1.0, RELIEF_REPEATED};
    const double half = 0.70710678118654752;
    for (int side = -1; side <= 1; side += 2)
        for (double texels = -7.45; texels < 8.0; texels += 0.1) {
            double u = (8.5 + texels) / 16, beyond = -side * texels;
            bool in_shadow = beyond > 0.0 && beyond < 2.0;
            assert_int_equal(relief_is_lit(&relief, v3(side * half, 0, half), u, 0.3), !in_shadow);
        }
    image_destroy(&height);
}

/* The same ridge across the border: its shadow goes on where the texture repeats, whatever the base. */
static void test_shadow_across_the_border(void **state) {
    (void)state;
    Image height = image_create(16, 1, 1);
    height.pixels[15] = 1.0f;
    for (int base = 0; base <= 1; base++) {
        Relief relief = {&height, 1.0, 0.5, 0.125, base, RELIEF_REPEATED};
        Vec3 light = v3(-0.70710678118654752, 0, 0.70710678118654752);
        assert_false(relief_is_lit(&relief, light, 0.5 / 16, 0.9));
        assert_false(relief_is_lit(&relief, light, 1.4 / 16, 0.1));
        assert_true(relief_is_lit(&relief, light, 1.6 / 16, 0.1));
        assert_true(relief_is_lit(&relief, light, 15.4 / 16, 0.1));
        assert_true(relief_is_lit(&relief, v3(0, 0, 1), 0.5 / 16, 0.1));
    }
    image_destroy(&height);
}

/* ---- The scenes ---- */

/* What is loaded is what --list says of it: the light's place, and base 1 where the relief is cut. */
static void test_scenes_are_as_listed(void **state) {
    (void)state;
    Context *context = context_offscreen();
    char folder[] = "/tmp/texel-relief-XXXXXX";
    if (!mkdtemp(folder)) fail_msg("%s cannot be made", folder);
    char *path = text("%s/relief.png", folder);
    Image colour = image_create(4, 2, 3), height = image_create(4, 2, 1);
    height.scale = 0.2, height.base = 0.25;
    assert_null(image_write_relief(&colour, &height, path, 16));
    Options options = {.colour = path, .height = path, .scale = NAN};
    Field *lit = relief_load_lit(&options), *cut = relief_load_cut(&options);
    Vec3 light = lit->light;
    assert_true(lit->lit && fabs(vec3_length(light) - 1) < 1e-15);
    assert_true(fabs(atan2(light.y, light.x) - radians(148)) < 1e-15);
    assert_true(fabs(hypot(light.x, light.y) / light.z - 1.2) < 1e-15);
    assert_true(lit->wall.relief.scale == 0.2 && lit->wall.relief.aspect == 0.5);
    assert_true(lit->wall.relief.base == 0.25 && lit->wall.relief.extent == RELIEF_REPEATED);
    assert_true(cut->wall.relief.base == 1.0 && cut->wall.relief.extent == RELIEF_CUT);
    relief_unload(lit);
    relief_unload(cut);
    image_destroy(&colour);
    image_destroy(&height);
    remove(path), free(path);
    rmdir(folder);
    context_destroy(context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_maximum_is_exact),     cmocka_unit_test(test_cone_is_conservative),
        cmocka_unit_test(test_shadow_of_a_ridge),    cmocka_unit_test(test_shadow_across_the_border),
        cmocka_unit_test(test_scenes_are_as_listed),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("lesson 15", tests, NULL, NULL);
}
