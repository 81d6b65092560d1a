/* The functions of mipmap.glsl and summed-area.glsl, as OSMesa runs them, against plain sums and
 * interpolation in doubles; and glGenerateMipmap against our box chain. */
#include "chain.h"
#include "context.h"
#include "draw.h"
#include "fail.h"
#include "plane.h"
#include "stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

static void assert_near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound))
        fail_msg("%.9g is %.3g from %.9g; allowed are %.3g", value, fabs(value - expected), expected, bound);
}

static uint32_t state = 1;
static double random_between(double low, double high) {
    state = state * 1664525u + 1013904223u;
    return low + (high - low) * ((state >> 8) / 16777216.0);
}

static const int sizes[][2] = {{1, 1}, {1, 6}, {3, 5}, {8, 8}, {33, 20}};
enum { SIZES = sizeof sizes / sizeof *sizes, COUNT = 256 };

static Image random_image(int width, int height) {
    Image image = image_create(width, height, 1);
    for (int i = 0; i < width * height; i++) image.pixels[i] = (float)random_between(0, 1);
    return image;
}

/* What the shader below calls uv, dx and dy. */
typedef struct {
    float uv[2], dx[2], dy[2], more[2];
} Arguments;

/* COUNT random footprints; their sides are up to `repeats` long. */
static void random_footprints(Arguments *arguments, double repeats) {
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 2; k++) {
            arguments[i].uv[k] = (float)random_between(-2, 2);
            arguments[i].dx[k] = (float)random_between(-repeats, repeats);
            arguments[i].dy[k] = (float)random_between(-repeats, repeats);
        }
}

/* Evaluates a vec3 of GLSL for each of COUNT arguments. The samplers are first and second. */
static void evaluate(const char *expression, const Arguments *arguments, const Texture *first,
                     const Texture *second, float (*results)[3]) {
    char *folder = project_path("lessons/05-mipmapping"), *common = project_path("common");
    char *shader = text("#include \"summed-area.glsl\"\n"
                        "uniform sampler2D arguments, first, second;\n"
                        "layout(location = 0) out vec4 colour;\n"
                        "void main() {\n"
                        "    vec4 a = texelFetch(arguments, ivec2(0, int(gl_FragCoord.y)), 0);\n"
                        "    vec4 b = texelFetch(arguments, ivec2(1, int(gl_FragCoord.y)), 0);\n"
                        "    vec2 uv = a.xy, dx = a.zw, dy = b.xy;\n"
                        "    colour = vec4(%s, 1.0);\n"
                        "}\n",
                        expression);
    Program program = {0};
    char *log = program_build_text(&program, folder, common, "everywhere.vert", "test", shader, GLSL_330);
    if (log) fail_msg("%s", log);
    Image image = {.width = 2, .height = COUNT, .channels = 4, .pixels = (float *)(uintptr_t)arguments};
    Texture numbers = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    Target target = target_create(1, COUNT, false);
    Picture picture = picture_create(1, COUNT, false);
    target_begin(&target, (Vec3){0});
    program_use(&program);
    program_texture(&program, "arguments", &numbers);
    program_texture(&program, "first", first);
    program_texture(&program, "second", second);
    draw_everywhere();
    target_read(&target, &picture);
    for (int i = 0; i < 3 * COUNT; i++) results[i / 3][i % 3] = picture.colour.pixels[i];
    picture_destroy(&picture);
    target_destroy(&target);
    texture_destroy(&numbers);
    program_destroy(&program);
    free(shader), free(folder), free(common);
}

/* ---- The footprint ---- */

/* The floor of the test: u w = 0.11 x + 0.03 y - 16, v w = 0.02 x + 50, w = 2.5 - 0.01 y + 0.001 x. */
static Vec2 floor_at(double x, double y) {
    double w = 2.5 - 0.01 * y + 0.001 * x;
    return (Vec2){(0.11 * x + 0.03 * y - 16) / w, (0.02 * x + 50) / w};
}

static void footprint_has_the_derivatives(void **unused) {
    (void)unused;
    Image image = image_create(1, 1, 1);
    Texture texture = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
    Arguments arguments[COUNT] = {0};
    for (int i = 0; i < COUNT; i++) {
        arguments[i].uv[0] = (float)random_between(0, 320);
        arguments[i].uv[1] = (float)random_between(0, 200);
    }
    static float uv[COUNT][3], dx[COUNT][3], dy[COUNT][3];
    const char *const made =
        "vec3(footprint(mat3(0.11, 0.02, 0.001, 0.03, 0.0, -0.01, -16.0, 50.0, 2.5), uv).%s, 0.0)";
    const char *const fields[] = {"uv", "dx", "dy"};
    for (int k = 0; k < 3; k++) {
        char *expression = text(made, fields[k]);
        evaluate(expression, arguments, &texture, &texture, (float(*[])[3]){uv, dx, dy}[k]);
        free(expression);
    }
    const double h = 1e-3; /* of a pixel: central differences are then off by less than 1e-6 */
    for (int i = 0; i < COUNT; i++) {
        double x = arguments[i].uv[0], y = arguments[i].uv[1];
        Vec2 at = floor_at(x, y), right = floor_at(x + h, y), left = floor_at(x - h, y);
        Vec2 up = floor_at(x, y + h), down = floor_at(x, y - h);
        double error = 1e-5 * (fabs(at.x) + fabs(at.y));
        assert_near(uv[i][0], at.x, error);
        assert_near(uv[i][1], at.y, error);
        assert_near(dx[i][0], (right.x - left.x) / (2 * h), error);
        assert_near(dx[i][1], (right.y - left.y) / (2 * h), error);
        assert_near(dy[i][0], (up.x - down.x) / (2 * h), error);
        assert_near(dy[i][1], (up.y - down.y) / (2 * h), error);
    }
    texture_destroy(&texture);
    image_destroy(&image);
}

/* ---- Texels ---- */

static void nearest_is_the_texel_below_the_point(void **unused) {
    (void)unused;
    static Arguments arguments[COUNT];
    static float results[COUNT][3];
    for (int s = 0; s < SIZES; s++) {
        Image image = random_image(sizes[s][0], sizes[s][1]);
        Texture texture = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
        random_footprints(arguments, 1.0);
        evaluate("nearest(first, uv).rrr", arguments, &texture, &texture, results);
        for (int i = 0; i < COUNT; i++) {
            double x = (arguments[i].uv[0] - floor(arguments[i].uv[0])) * image.width;
            double y = (arguments[i].uv[1] - floor(arguments[i].uv[1])) * image.height;
            assert_near(results[i][0], *image_at(&image, (int)x, (int)y), 0.0);
        }
        texture_destroy(&texture);
        image_destroy(&image);
    }
}

/* n x n bilinear reads by common's own interpolation. One tap is `bilinear`. */
static double area_mean(const Image *image, const Arguments *a, int n) {
    double sum = 0.0, value;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double x = (i + 0.5) / n - 0.5, y = (j + 0.5) / n - 0.5;
            image_sample(image, a->uv[0] + x * a->dx[0] + y * a->dy[0],
                         a->uv[1] + x * a->dx[1] + y * a->dy[1], &value);
            sum += value;
        }
    return sum / (n * n);
}

static void area_is_the_mean_of_its_taps(void **unused) {
    (void)unused;
    static Arguments arguments[COUNT];
    static float results[COUNT][3];
    for (int s = 0; s < SIZES; s++) {
        Image image = random_image(sizes[s][0], sizes[s][1]);
        Texture texture = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
        random_footprints(arguments, 0.7);
        evaluate("vec3(bilinear(first, uv).r, area(first, uv, dx, dy, 1).r, area(first, uv, dx, dy, 5).r)",
                 arguments, &texture, &texture, results);
        for (int i = 0; i < COUNT; i++) {
            assert_near(results[i][0], area_mean(&image, &arguments[i], 1), 1e-4);
            assert_near(results[i][1], area_mean(&image, &arguments[i], 1), 1e-4);
            assert_near(results[i][2], area_mean(&image, &arguments[i], 5), 1e-4);
        }
        texture_destroy(&texture);
        image_destroy(&image);
    }
}

/* ---- Levels ---- */

static void last_level_is_the_chains(void **unused) {
    (void)unused;
    static const Arguments arguments[COUNT];
    static float results[COUNT][3];
    for (int exponent = 1; exponent <= 14; exponent++)
        for (int more = -1; more <= 1 && (1 << exponent) + more <= 16384; more++) {
            Image image = image_create((1 << exponent) + more, 1, 1);
            Texture texture = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
            evaluate("vec3(last_level(first))", arguments, &texture, &texture, results);
            assert_near(results[0][0], more < 0 ? exponent - 1 : exponent, 0.0);
            texture_destroy(&texture);
            image_destroy(&image);
        }
}

static void level_is_of_the_longer_side(void **unused) {
    (void)unused;
    Image image = image_create(1, 1, 1);
    Texture texture = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
    static Arguments arguments[COUNT];
    static float results[COUNT][3];
    random_footprints(arguments, 20.0);
    evaluate("vec3(level_of_detail(dx, dy, 4.0))", arguments, &texture, &texture, results);
    for (int i = 0; i < COUNT; i++) {
        const float *dx = arguments[i].dx, *dy = arguments[i].dy;
        double longer = fmax(hypot(dx[0], dx[1]), hypot(dy[0], dy[1]));
        assert_near(results[i][0], clamp(log2(longer), 0.0, 4.0), 1e-5);
    }
    texture_destroy(&texture);
    image_destroy(&image);
}

/* A chain whose level k is k all over tells which levels were read. */
static void levels_are_read_as_asked(void **unused) {
    (void)unused;
    Image levels[4];
    for (int k = 0; k < 4; k++) {
        levels[k] = image_create(8 >> k, 8 >> k, 1);
        for (int i = 0; i < levels[k].width * levels[k].height; i++) levels[k].pixels[i] = (float)k;
    }
    Texture texture = texture_create(levels, 4, TEXTURE_FLOAT, TEXTURE_TRILINEAR);
    static Arguments arguments[COUNT];
    static float results[COUNT][3];
    random_footprints(arguments, 3.0);
    evaluate("vec3(trilinear(first, uv, abs(dx.x)).r, mip_nearest(first, uv, abs(dx.x)).r, 0.0)", arguments,
             &texture, &texture, results);
    for (int i = 0; i < COUNT; i++) {
        double level = fabs(arguments[i].dx[0]);
        assert_near(results[i][0], level, 1e-5);
        assert_near(results[i][1], floor(level + 0.5), 0.0);
    }
    texture_destroy(&texture);
    for (int k = 0; k < 4; k++) image_destroy(&levels[k]);
}

/* ---- Summed-area tables ---- */

/* How much of texel i of an axis a box covers, in all repeats. */
static double covered(int i, int size, double centre, double width) {
    double start = centre - width / 2, end = centre + width / 2, sum = 0.0;
    for (double at = size * floor(start / size) + i; at < end; at += size)
        sum += fmax(0.0, fmin(end, at + 1) - fmax(start, at));
    return sum;
}

static double box_mean(const Image *image, const Arguments *a) {
    double width = fmax(1.0, (fabs(a->dx[0]) + fabs(a->dy[0])) * image->width), sum = 0.0;
    double height = fmax(1.0, (fabs(a->dx[1]) + fabs(a->dy[1])) * image->height);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            sum += covered(x, image->width, a->uv[0] * image->width, width) *
                   covered(y, image->height, a->uv[1] * image->height, height) * *image_at(image, x, y);
    return sum / (width * height);
}

static void summed_area_is_the_mean_of_the_box(void **unused) {
    (void)unused;
    static Arguments arguments[COUNT];
    static float results[COUNT][3];
    for (int s = 0; s < 3 * SIZES; s++) {
        Image image = random_image(sizes[s / 3][0], sizes[s / 3][1]);
        SummedArea table = summed_area_create(&image);
        Texture high = texture_create(&table.high, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
        Texture low = texture_create(&table.low, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
        random_footprints(arguments, (double[]){0.0, 0.2, 3.0}[s % 3]);
        evaluate("summed_area(first, second, uv, dx, dy).rrr", arguments, &high, &low, results);
        for (int i = 0; i < COUNT; i++) {
            assert_near(results[i][0], box_mean(&image, &arguments[i]), 2e-5);
            if (s % 3 == 0) /* one texel wide */
                assert_near(results[i][0], area_mean(&image, &arguments[i], 1), 2e-5);
        }
        texture_destroy(&high);
        texture_destroy(&low);
        summed_area_destroy(&table);
        image_destroy(&image);
    }
}

/* ---- OpenGL's chain ---- */

/* The largest difference of any level from ours, for the chain that OpenGL makes of a random image; and of
 * level 1 from one bilinear read of the image at the texel's centre. */
typedef struct {
    double from_box, from_bilinear;
} Distance;

static Distance opengl_distance(int width, int height) {
    Image image = random_image(width, height);
    Chain ours = chain_create(&image, CHAIN_BOX);
    Texture texture = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_LINEAR);
    texture_mipmap(&texture);
    Chain theirs = plane_download(&texture, &image);
    assert_int_equal(ours.count, theirs.count);
    Distance distance = {0, 0};
    for (int k = 1; k < ours.count; k++) {
        const Image *level = &theirs.levels[k];
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                double stored = *image_at(level, x, y), read;
                image_sample(&image, (x + 0.5) / level->width, (y + 0.5) / level->height, &read);
                distance.from_box = fmax(distance.from_box, fabs(stored - *image_at(&ours.levels[k], x, y)));
                if (k == 1) distance.from_bilinear = fmax(distance.from_bilinear, fabs(stored - read));
            }
    }
    chain_destroy(&theirs);
    chain_destroy(&ours);
    texture_destroy(&texture);
    image_destroy(&image);
    return distance;
}

static void opengl_halves_powers_of_two_as_we_do(void **unused) {
    (void)unused;
    assert_near(opengl_distance(64, 32).from_box, 0.0, 1e-6);
    assert_near(opengl_distance(1, 16).from_box, 0.0, 1e-6);
}

/* So does OSMesa: two texels of a row where the area covers three. */
static void opengl_halves_odd_sizes_by_one_bilinear_read(void **unused) {
    (void)unused;
    Distance distance = opengl_distance(45, 21);
    printf("# glGenerateMipmap of 45 x 21 random texels: %.1f/255 from the area's mean, %.1g/255 from one "
           "bilinear read\n",
           255.0 * distance.from_box, 255.0 * distance.from_bilinear);
    assert_near(distance.from_bilinear, 0.0, 1e-4);
    assert_true(distance.from_box > 0.05);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(footprint_has_the_derivatives),
        cmocka_unit_test(nearest_is_the_texel_below_the_point),
        cmocka_unit_test(area_is_the_mean_of_its_taps),
        cmocka_unit_test(last_level_is_the_chains),
        cmocka_unit_test(level_is_of_the_longer_side),
        cmocka_unit_test(levels_are_read_as_asked),
        cmocka_unit_test(summed_area_is_the_mean_of_the_box),
        cmocka_unit_test(opengl_halves_powers_of_two_as_we_do),
        cmocka_unit_test(opengl_halves_odd_sizes_by_one_bilinear_read),
    };
    Context *context = context_offscreen();
    cmocka_set_message_output(CM_OUTPUT_TAP);
    int failed = cmocka_run_group_tests_name("05-mipmapping mipmap.glsl", tests, NULL, NULL);
    context_destroy(context);
    return failed;
}
