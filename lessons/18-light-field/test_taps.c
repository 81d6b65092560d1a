/* The pictures of paper.frag and its relatives as OSMesa draws them, against the same taps in doubles from
 * the paper's own equations: frames by cross products, angles by Eq. 5, and none of common/light_field.c. The
 * fields hold random bytes, the hardest content: neighbours differ by as much as they can. */
#include "context.h"
#include "draw.h"
#include "fail.h"
#include "fields.h"
#include "image.h"
#include "stage.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tests/random.h" /* behind cmocka.h */

enum { SIDE = 64 }; /* of a picture, in pixels */

/* ---- The paper's equations ---- */

static double degrees(double a) { return a * (180.0 / PI); }

static double linear_light(uint8_t code) {
    double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double srgb_code(double light) {
    double c = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
    return 255.0 * c;
}

/* Eq. 3, in degrees; on the cylinder v is the height. */
static Vec2 equation_3(const Field *field, Vec3 p) {
    double u = (degrees(atan2(p.x, p.z)) + 180.0) / 360.0;
    if (field->model == FIELD_CYLINDER) return v2(u, p.y / field->height + 0.5);
    return v2(u, (degrees(asin(clamp(p.y / vec3_length(p), -1, 1))) + 90.0) / 180.0);
}

/* The point whose (u, v) that is. Where v is beyond 0..1 the meridian goes on over the pole. */
static Vec3 point_at(const Field *field, double u, double v) {
    double theta = radians(360.0 * u - 180.0), phi = radians(180.0 * v - 90.0);
    if (field->model == FIELD_CYLINDER)
        return v3(field->radius * sin(theta), field->height * (v - 0.5), field->radius * cos(theta));
    return vec3_scale(v3(cos(phi) * sin(theta), sin(phi), cos(phi) * cos(theta)), field->radius);
}

/* Eq. 4. */
static void equation_4(const Field *field, Vec3 p, Vec3 *x, Vec3 *y, Vec3 *z) {
    *z = vec3_normalize(field->model == FIELD_CYLINDER ? v3(p.x, 0, p.z) : p);
    if (field->model == FIELD_ROOM) *z = vec3_scale(*z, -1);
    *x = vec3_normalize(vec3_cross(v3(0, 1, 0), *z));
    *y = vec3_cross(*z, *x);
}

/* Eq. 5, each arc sine as the arc tangent that it equals; then the scale, named by the arc's end. */
static Vec2 equation_5(const Field *field, Vec3 p, Vec3 d) {
    Vec3 x, y, z;
    equation_4(field, p, &x, &y, &z);
    double a = degrees(atan2(vec3_dot(x, d), vec3_dot(z, d)));
    double b = degrees(atan2(vec3_dot(y, d), hypot(vec3_dot(x, d), vec3_dot(z, d))));
    if (field->angles == ANGLES_LINEAR) return v2((a + 90) / 180, (b + 90) / 180);
    a = clamp(a, -90, 90);
    if (field->angles == ANGLES_SINE) return v2((sin(radians(a)) + 1) / 2, (sin(radians(b)) + 1) / 2);
    return v2((tan(radians(a) / 2) + 1) / 2, (tan(radians(b) / 2) + 1) / 2);
}

/* Four taps in a block. */
static Vec3 angular_taps(const Field *field, const uint8_t *texels, int u, int v, Vec2 st) {
    double x = clamp(st.x * field->s - 0.5, 0, field->s - 1),
           y = clamp(st.y * field->t - 0.5, 0, field->t - 1);
    int s = (int)fmin(x, field->s - 2), t = (int)fmin(y, field->t - 2);
    Vec3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        int si = s + (i & 1), ti = t + (i >> 1);
        double weight = (i & 1 ? x - s : 1 - (x - s)) * (i >> 1 ? y - t : 1 - (y - t));
        const uint8_t *c =
            texels + 3 * ((((size_t)v * (size_t)field->u + (size_t)u) * (size_t)field->t + (size_t)ti) *
                              (size_t)field->s +
                          (size_t)si);
        sum =
            vec3_add(sum, vec3_scale(v3(linear_light(c[0]), linear_light(c[1]), linear_light(c[2])), weight));
    }
    return sum;
}

/* What is looked up in, and where from. */
typedef struct {
    const Field *field;
    const uint8_t *texels;
    const Image *depths; /* COARSE^4 texels each, as in fields.h */
    double mean_depth;
} Held;

/* How a neighbour's angles are found: those of the direction d toward the eye in its own frame; in the
 * point's frame; or those of the way from the point d to the neighbour. */
typedef enum { IN_ITS_FRAME, IN_THE_POINTS, FROM_BEHIND } Angles;

/* The neighbours of a point are texels of the plane (u, v); which one each is, and where it lies, is asked of
 * the geometry: the point is made first, and is given its own (u, v) by Eq. 3. */
static Vec3 sixteen_in_doubles(const Held *held, Angles how, Vec3 p, Vec3 d) {
    const Field *field = held->field;
    Vec2 uv = equation_3(field, p);
    double x = uv.x * field->u - 0.5, y = uv.y * field->v - 0.5;
    Vec3 sum = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
        double column = floor(x) + (i & 1), row = floor(y) + (i >> 1);
        double weight = (1 - fabs(x - column)) * (1 - fabs(y - row));
        if (field->model == FIELD_CYLINDER) row = clamp(row, 0, field->v - 1);
        Vec3 centre = point_at(field, (column + 0.5) / field->u, (row + 0.5) / field->v);
        Vec2 own = equation_3(field, centre);
        int u = (int)floor(own.x * field->u) % field->u, v = (int)floor(own.y * field->v);
        Vec2 angles = equation_5(field, how == IN_THE_POINTS ? p : centre,
                                 how == FROM_BEHIND ? vec3_normalize(vec3_sub(centre, d)) : d);
        sum = vec3_add(sum, vec3_scale(angular_taps(field, held->texels, u, v, angles), weight));
    }
    return sum;
}

/* ---- What each program shows of the point p, on a ray along `way`; false where float may decide otherwise
 * ---- */

typedef bool Taps(const Held *held, Vec3 p, Vec3 way, Vec3 *light);

static bool paper_taps(const Held *held, Vec3 p, Vec3 way, Vec3 *light) {
    *light = sixteen_in_doubles(held, IN_ITS_FRAME, p, vec3_scale(way, -1));
    return true;
}

static bool shared_taps(const Held *held, Vec3 p, Vec3 way, Vec3 *light) {
    *light = sixteen_in_doubles(held, IN_THE_POINTS, p, vec3_scale(way, -1));
    return true;
}

static bool mean_taps(const Held *held, Vec3 p, Vec3 way, Vec3 *light) {
    *light = sixteen_in_doubles(held, FROM_BEHIND, p, vec3_add(p, vec3_scale(way, held->mean_depth)));
    return true;
}

/* The cell of the width `wide`, of those from 0 to below n, that holds x; false next to where two meet. */
static bool cell_of(double x, int n, int wide, int *cell) {
    x = clamp(x, 0.5, n - 0.5) / wide;
    *cell = (int)x;
    double part = x - *cell, outermost = 0.5 / wide;
    return (part > 1e-3 || x < outermost + 1e-3) &&
           (part < 1 - 1e-3 || x > (double)n / wide - outermost - 1e-3);
}

/* The texel of u and v that holds a point, and its centre. */
static bool holder(const Field *field, Vec3 p, int *u, int *v, Vec3 *centre) {
    Vec2 uv = equation_3(field, p);
    double x = uv.x * field->u, y = uv.y * field->v;
    *u = (int)fmin(x, field->u - 1), *v = (int)fmin(y, field->v - 1);
    *centre = point_at(field, (*u + 0.5) / field->u, (*v + 0.5) / field->v);
    return fabs(x - round(x)) > 1e-3 && fabs(y - round(y)) > 1e-3;
}

static bool nearest_tap(const Held *held, Vec3 p, Vec3 way, Vec3 *light) {
    const Field *field = held->field;
    int u, v, s, t;
    Vec3 centre;
    bool sure = holder(field, p, &u, &v, &centre);
    Vec2 angles = equation_5(field, centre, vec3_scale(way, -1));
    sure = cell_of(angles.x * field->s, field->s, 1, &s) && sure;
    sure = cell_of(angles.y * field->t, field->t, 1, &t) && sure;
    *light = angular_taps(field, held->texels, u, v, v2((s + 0.5) / field->s, (t + 0.5) / field->t));
    return sure;
}

/* The depth that is known along d, seen from the texel that holds p. */
static bool depth_known(const Held *held, Vec3 p, Vec3 d, bool toward, double *depth) {
    const Field *field = held->field;
    int u, v, s, t, across = (field->s + COARSE - 1) / COARSE, up = (field->t + COARSE - 1) / COARSE;
    Vec3 centre;
    bool sure = holder(field, p, &u, &v, &centre);
    Vec2 angles = equation_5(field, centre, toward ? d : vec3_normalize(vec3_sub(centre, d)));
    sure = cell_of(angles.x * field->s, field->s, COARSE, &s) && sure;
    sure = cell_of(angles.y * field->t, field->t, COARSE, &t) && sure;
    *depth = image_at(held->depths, u * across + s, v * up + t)[0];
    return sure;
}

static bool corrected_taps(const Held *held, Vec3 p, Vec3 way, Vec3 *light) {
    double first, second;
    bool sure = depth_known(held, p, vec3_scale(way, -1), true, &first);
    sure = depth_known(held, p, vec3_add(p, vec3_scale(way, first)), false, &second) && sure;
    *light = sixteen_in_doubles(held, FROM_BEHIND, p, vec3_add(p, vec3_scale(way, second)));
    return sure;
}

/* Where a ray meets the model; false where it does not, or almost does not: within a thousandth of the radius
 * of the outline, float and double may disagree on whether it does. */
static bool meet(const Field *field, Ray ray, Vec3 *p) {
    Vec3 o = ray.origin, d = ray.direction, flat = {1, field->model == FIELD_CYLINDER ? 0 : 1, 1};
    Vec3 of = vec3_multiply(o, flat), df = vec3_multiply(d, flat);
    double a = vec3_dot(df, df), b = vec3_dot(of, df);
    double inside = b * b - a * (vec3_dot(of, of) - field->radius * field->radius);
    if (!(inside > 1e-3 * a * field->radius * field->radius)) return false;
    double depth = (-b + (field->model == FIELD_ROOM ? 1 : -1) * sqrt(inside)) / a;
    *p = ray_at(ray, depth);
    return depth > 0 && (field->model != FIELD_CYLINDER || fabs(p->y) < 0.4999 * field->height);
}

/* ---- Drawing ---- */

static char *folder, *common;
static Context *context;

static int start(void **state) {
    (void)state;
    context = context_offscreen();
    folder = project_path("lessons/18-light-field"), common = project_path("common");
    return 0;
}

static int end(void **state) {
    (void)state;
    free(folder), free(common);
    context_destroy(context);
    return 0;
}

static Program build(const char *fragment) {
    Program program = {0};
    char *log = program_build(&program, folder, common, "everywhere.vert", fragment, GLSL_330);
    if (log) fail_msg("%s: %s", fragment, log);
    return program;
}

static void draw_with(Program *program, const FieldTexture *texture, const Texture *depths, double mean_depth,
                      const Camera *camera, Picture *picture) {
    Frame frame = {.program = program, .camera = *camera, .width = SIDE, .height = SIDE};
    Target target = target_create(SIDE, SIDE, true);
    target_begin(&target, (Vec3){0});
    program_use(program);
    program_vector(program, "size", SIDE, SIDE, 0, 0);
    field_uniforms(&frame, &texture->field);
    field_texture_bind(program, texture);
    if (depths) program_texture(program, "depths", depths);
    program_number(program, "mean_depth", mean_depth);
    draw_everywhere();
    target_read(&target, picture);
    draw_check("test_taps");
    target_destroy(&target);
}

static void draw(Program *program, const FieldTexture *texture, const Camera *camera, Picture *picture) {
    draw_with(program, texture, NULL, 0, camera, picture);
}

static uint8_t *random_texels(const Field *field) {
    uint8_t *texels = allocate(field_bytes(field), 1);
    for (size_t i = 0; i < field_bytes(field); i++) texels[i] = (uint8_t)random_in(0, 256);
    return texels;
}

static FieldTexture upload(const Field *field, const uint8_t *texels) {
    FieldTexture texture = field_texture_create(field);
    field_texture_write(&texture, 0, field->v, texels);
    return texture;
}

static Camera looking(Vec3 eye, Vec3 target, double fov) {
    return (Camera){.eye = eye,
                    .target = target,
                    .up = {0.31, 0.9, 0.17},
                    .fov_y_degrees = fov,
                    .height = 2.2,
                    .near = 0.01,
                    .far = 100};
}

/* Hard cameras first, then random ones; radius is the model's. */
enum { AFAR = 6, CAMERAS = 14 };
static Camera camera_number(int i, const Field *field) {
    double r = field->radius;
    if (field->model == FIELD_ROOM) {
        Vec3 eye = vec3_scale(random_vector(-0.5, 0.5), r);
        const Vec3 toward[] = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}};
        if (i == 0) eye = v3(0, 0, 0);
        return looking(eye, vec3_add(eye, i < 4 ? toward[i] : random_direction()), random_in(50, 110));
    }
    Camera flat = looking(v3(2 * r, r, -2 * r), v3(0, 0, 0), 0);
    flat.height = 2.2 * r;
    switch (i) {
    case 0: return looking(v3(0, 4 * r, 0), v3(0, 0, 0), 30);                  /* over a pole */
    case 1: return looking(v3(0, -4 * r, 0), v3(0, 0, 0), 30);                 /* under one */
    case 2: return looking(v3(0, 0, -4 * r), v3(0, 0, 0), 30);                 /* at the seam */
    case 3: return looking(v3(0.9 * r, 0, -0.9 * r), v3(-r, 0, -r), 70);       /* grazing the seam */
    case 4: return looking(v3(0, 1.05 * r, 0.1 * r), v3(0.3 * r, r, -r), 100); /* close to a pole, grazing */
    case 5: return looking(v3(0, 0, 1.02 * r), v3(0, 0, 0), 100);              /* near */
    case 6: return looking(v3(70 * r, 30 * r, 20 * r), v3(0, 0, 0), 1.6);      /* AFAR */
    case 7: return flat;                                                       /* orthographic */
    }
    return looking(vec3_scale(random_direction(), r * random_in(1.3, 5)),
                   vec3_scale(random_vector(-0.6, 0.6), r), random_in(15, 80));
}

static const Field fields[] = {
    {.model = FIELD_SPHERE, .radius = 3.5, .u = 10, .v = 9, .s = 9, .t = 11},
    {.model = FIELD_SPHERE, .radius = 1, .u = 8, .v = 8, .s = 8, .t = 8},
    {.model = FIELD_SPHERE, .radius = 3.5, .u = 64, .v = 32, .s = 16, .t = 24},
    {.model = FIELD_SPHERE, .radius = 0.7, .u = 22, .v = 13, .s = 64, .t = 33},
    {.model = FIELD_CYLINDER, .radius = 1.5, .height = 2.5, .u = 20, .v = 11, .s = 13, .t = 8},
    {.model = FIELD_ROOM, .radius = 2.5, .u = 26, .v = 15, .s = 12, .t = 17},
};
enum { FIELDS = sizeof fields / sizeof *fields };

/* ---- Comparing ---- */

typedef struct {
    double linear, srgb; /* largest differences, in 255ths */
    long pixels, unsure;
} Apart;

static void compare(Apart *apart, const double *expected, const float *got) {
    for (int c = 0; c < 3; c++) {
        apart->linear = fmax(apart->linear, 255.0 * fabs(got[c] - expected[c]));
        apart->srgb = fmax(apart->srgb, fabs(srgb_code(got[c]) - srgb_code(expected[c])));
    }
    apart->pixels++;
}

/* A picture of a program against the double-precision taps. */
static void compare_to_doubles(Apart *apart, Taps *taps, const Held *held, const Camera *camera,
                               const Picture *picture) {
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            Vec3 p, light;
            Ray ray = camera_ray(camera, SIDE, SIDE, x + 0.5, y + 0.5);
            if (!meet(held->field, ray, &p)) continue;
            if (image_at(&picture->lookup, x, y)[3] != 1.0f) fail_msg("a pixel was left out");
            if (taps(held, p, ray.direction, &light))
                compare(apart, (double[]){light.x, light.y, light.z}, image_at(&picture->colour, x, y));
            else
                apart->unsure++;
        }
}

/* Depths from a third of the radius to all of it: what lies nearer is seen in directions that differ by
 * rounding's share of that nearness. */
static Image random_depths(const Field *field) {
    Image depths = image_create(field->u * ((field->s + COARSE - 1) / COARSE),
                                field->v * ((field->t + COARSE - 1) / COARSE), 1);
    for (int y = 0; y < depths.height; y++)
        for (int x = 0; x < depths.width; x++)
            image_at(&depths, x, y)[0] = (float)(field->radius * random_in(0.33, 1));
    return depths;
}

static void check_program(FieldAngles angles, const char *fragment, Taps *taps, bool spheres_only) {
    Program program = build(fragment);
    Picture picture = picture_create(SIDE, SIDE, true);
    Apart apart = {0};
    for (int f = 0; f < FIELDS; f++) {
        Field field = fields[f];
        if (spheres_only && field.model != FIELD_SPHERE) continue;
        field.angles = angles;
        assert_null(field_refused(&field));
        uint8_t *texels = random_texels(&field);
        FieldTexture texture = upload(&field, texels);
        Image coarse = random_depths(&field);
        Texture depths = texture_create(&coarse, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
        Held held = {&field, texels, &coarse, 0.6 * field.radius};
        for (int i = 0; i < CAMERAS; i++) {
            Camera camera = camera_number(i, &field);
            draw_with(&program, &texture, &depths, held.mean_depth, &camera, &picture);
            compare_to_doubles(&apart, taps, &held, &camera, &picture);
        }
        texture_destroy(&depths);
        image_destroy(&coarse);
        field_texture_destroy(&texture);
        free(texels);
    }
    picture_destroy(&picture);
    program_destroy(&program);
    print_message("%s: %ld pixels (and %ld unsure), at most %.4f/255 in linear light, %.4f codes of sRGB\n",
                  fragment, apart.pixels, apart.unsure, apart.linear, apart.srgb);
    assert_true(apart.pixels > 50000 && apart.unsure < apart.pixels / 20);
    assert_true(apart.linear <= 1 && apart.srgb <= 1);
}

static void test_paper(void **state) {
    (void)state, check_program(ANGLES_LINEAR, "paper.frag", paper_taps, false);
}
static void test_sine(void **state) {
    (void)state, check_program(ANGLES_SINE, "sine.frag", paper_taps, false);
}
static void test_stereographic(void **state) {
    (void)state, check_program(ANGLES_STEREOGRAPHIC, "stereographic.frag", paper_taps, false);
}
static void test_shared(void **state) {
    (void)state, check_program(ANGLES_LINEAR, "shared.frag", shared_taps, false);
}
static void test_nearest(void **state) {
    (void)state, check_program(ANGLES_LINEAR, "nearest.frag", nearest_tap, false);
}
static void test_depth_mean(void **state) {
    (void)state, check_program(ANGLES_LINEAR, "depth-mean.frag", mean_taps, true);
}
static void test_depth_corrected(void **state) {
    (void)state, check_program(ANGLES_LINEAR, "depth-corrected.frag", corrected_taps, true);
}

/* Nearly all that the programs are off by is OSMesa's decoding of bytes: each code alone, fetched, against
 * the formula of sRGB. */
static void test_decoding(void **state) {
    (void)state;
    Program program = {0};
    char *log = program_build_text(&program, folder, common, "everywhere.vert", "decoding",
                                   "uniform sampler2D page;\n"
                                   "layout(location = 0) out vec4 colour;\n"
                                   "layout(location = 1) out vec4 lookup;\n"
                                   "void main() {\n"
                                   "    colour = texelFetch(page, ivec2(gl_FragCoord.xy), 0);\n"
                                   "    lookup = vec4(1.0);\n"
                                   "}\n",
                                   GLSL_330);
    if (log) fail_msg("%s", log);
    uint8_t codes[256 * 3];
    for (int i = 0; i < 256 * 3; i++) codes[i] = (uint8_t)(i / 3);
    Texture row = texture_empty(256, 1, TEXTURE_SRGBA8, TEXTURE_LINEAR);
    texture_write_part(&row, TEXTURE_SRGB8, 0, 0, 256, 1, codes);
    Picture picture = picture_create(256, 1, true);
    Target target = target_create(256, 1, true);
    target_begin(&target, (Vec3){0});
    program_use(&program);
    program_texture(&program, "page", &row);
    draw_everywhere();
    target_read(&target, &picture);
    double largest = 0;
    int at = 0;
    for (int i = 0; i < 256; i++)
        for (int c = 0; c < 3; c++) {
            double off = 255 * fabs(image_at(&picture.colour, i, 0)[c] - linear_light((uint8_t)i));
            if (off > largest) largest = off, at = i;
        }
    print_message("decoding of sRGB: at most %.4f/255, for the code %d\n", largest, at);
    assert_true(largest <= 0.32);
    target_destroy(&target);
    picture_destroy(&picture);
    texture_destroy(&row);
    program_destroy(&program);
}

/* ---- Two programs that must show the same ---- */

static void compare_pictures(Apart *apart, const Picture *a, const Picture *b) {
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const float *e = image_at(&a->colour, x, y);
            compare(apart, (double[]){e[0], e[1], e[2]}, image_at(&b->colour, x, y));
            assert_true(image_at(&a->lookup, x, y)[3] == image_at(&b->lookup, x, y)[3]);
        }
}

/* Half the distance of floats just below n texels: what a place among them rounds by. */
static double rounding(int n) { return 0.5 * (n - (double)nextafterf((float)n, 0)); }

/* paper-fast.frag asks OpenGL for the place (block + at) / size. The sum, the quotient and the sampler's
 * product with the size round it by up to half a last digit each, 2^-11 texels on the largest axis, 16384,
 * and neighbours differ by at most 1. That is 0.37/255 an axis. Hardware may round the part between two
 * texels to 8 bits besides, by 2^-9, which is 1/255 over two axes, and with both places at most 1.75/255.
 * OSMesa mixes in floats, so that the weights' share is 0 here, and paper-fast is held to the places alone.
 *
 * Where `doubles` is given, paper.frag is held against the taps in doubles as well, but from afar: 78 radii
 * away, rounding puts the point itself off by up to 6 * 78 * 2^-24 radii (cases.h, meet_sphere), which near a
 * pole is a good part of a narrow column. */
static Apart compare_fast(Program *paper, Program *fast, const Field *field, Apart *doubles) {
    Picture a = picture_create(SIDE, SIDE, true), b = picture_create(SIDE, SIDE, true);
    uint8_t *texels = random_texels(field);
    FieldTexture texture = upload(field, texels);
    Held held = {.field = field, .texels = texels};
    Apart apart = {0}, afar = {0};
    for (int i = 0; i < CAMERAS; i++) {
        Camera camera = camera_number(i, field);
        draw(paper, &texture, &camera, &a);
        draw(fast, &texture, &camera, &b);
        compare_pictures(&apart, &a, &b);
        if (doubles) compare_to_doubles(i == AFAR ? &afar : doubles, paper_taps, &held, &camera, &a);
    }
    assert_int_equal(texture.count, 1);
    double places = 3 * 255.0 * (rounding(texture.pages[0].width) + rounding(texture.pages[0].height));
    double own = 255.0 * 32 * 0x1p-24; /* paper.frag's own mixing: 16 products and sums of at most 1 */
    print_message("%dx%dx%dx%d in %dx%d: paper-fast from paper %.4f/255, bound %.4f", field->u, field->v,
                  field->s, field->t, texture.pages[0].width, texture.pages[0].height, apart.linear,
                  places + own);
    if (doubles) print_message("; paper from doubles %.4f/255, from afar %.4f", doubles->linear, afar.linear);
    print_message("\n");
    assert_true(apart.linear <= places + own && apart.srgb <= 2);
    field_texture_destroy(&texture);
    free(texels);
    picture_destroy(&a), picture_destroy(&b);
    return apart;
}

static void test_fast(void **state) {
    (void)state;
    Program paper = build("paper.frag"), fast = build("paper-fast.frag");
    for (int f = 0; f < FIELDS; f++) compare_fast(&paper, &fast, &fields[f], NULL);
    program_destroy(&paper), program_destroy(&fast);
}

/* The longest textures: 16384 texels, or a little less, which is no power of two. */
static void test_long(void **state) {
    (void)state;
    const int sizes[][4] = {{512, 8, 32, 8}, {64, 8, 256, 8}, {546, 8, 30, 8}, {1024, 8, 16, 8},
                            {8, 512, 8, 32}, {8, 64, 8, 256}, {8, 655, 8, 25}};
    Program paper = build("paper.frag"), fast = build("paper-fast.frag");
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const int *n = sizes[k];
        Field field = {.radius = 3.5, .u = n[0], .v = n[1], .s = n[2], .t = n[3]};
        Apart doubles = {0};
        Apart apart = compare_fast(&paper, &fast, &field, &doubles);
        assert_true(apart.linear <= 2 && doubles.linear <= 1 && doubles.srgb <= 1);
    }
    program_destroy(&paper), program_destroy(&fast);
}

/* The same field in pages of few blocks, as a large one's, gives the same bits. */
static void test_pages(void **state) {
    (void)state;
    Program paper = build("paper.frag"), paged = build("paper-pages.frag");
    Picture a = picture_create(SIDE, SIDE, true), b = picture_create(SIDE, SIDE, true);
    const int cuts[][2] = {{2, 2}, {1, 4}, {4, 1}, {1, 3}, {3, 1}, {1, 1}};
    Field field = fields[0];
    uint8_t *texels = random_texels(&field);
    FieldTexture whole = upload(&field, texels);
    for (size_t k = 0; k < sizeof cuts / sizeof *cuts; k++) {
        FieldTexture cut = {.field = field, .columns = (field.u + cuts[k][0] - 1) / cuts[k][0]};
        cut.rows = (field.v + cuts[k][1] - 1) / cuts[k][1];
        cut.across = (field.u + cut.columns - 1) / cut.columns;
        cut.count = cut.across * ((field.v + cut.rows - 1) / cut.rows);
        for (int i = 0; i < cut.count; i++)
            cut.pages[i] =
                texture_empty(cut.columns * field.s, cut.rows * field.t, TEXTURE_SRGBA8, TEXTURE_LINEAR);
        /* In two parts that end within a page, as the synthesis writes them. */
        field_texture_write(&cut, 0, 4, texels);
        field_texture_write(&cut, 4, field.v - 4, texels + 4 * field_row(&field));
        for (int i = 0; i < CAMERAS; i++) {
            Camera camera = camera_number(i, &field);
            draw(&paper, &whole, &camera, &a);
            draw(&paged, &cut, &camera, &b);
            assert_memory_equal(a.colour.pixels, b.colour.pixels, (size_t)SIDE * SIDE * 3 * sizeof(float));
        }
        field_texture_destroy(&cut);
    }
    field_texture_destroy(&whole);
    free(texels);
    picture_destroy(&a), picture_destroy(&b);
    program_destroy(&paper), program_destroy(&paged);
}

/* Fields too long for one texture, as field_texture_create cuts them. */
static void test_cut(void **state) {
    (void)state;
    const struct {
        int u, v, s, t, columns, rows, count;
    } sizes[] = {{1024, 8, 32, 8, 512, 8, 2}, {1022, 8, 33, 8, 256, 8, 4}, {8, 700, 8, 33, 8, 350, 2}};
    Program program = build("paper-pages.frag");
    Picture picture = picture_create(SIDE, SIDE, true);
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        Field field = {.radius = 3.5, .u = sizes[k].u, .v = sizes[k].v, .s = sizes[k].s, .t = sizes[k].t};
        uint8_t *texels = random_texels(&field);
        FieldTexture texture = upload(&field, texels);
        assert_int_equal(texture.columns, sizes[k].columns);
        assert_int_equal(texture.rows, sizes[k].rows);
        assert_int_equal(texture.count, sizes[k].count);
        assert_true(field_texture_bytes(&texture) == (size_t)4 * (size_t)texture.count *
                                                         (size_t)(texture.columns * field.s) *
                                                         (size_t)(texture.rows * field.t));
        Held held = {.field = &field, .texels = texels};
        Apart apart = {0};
        for (int i = 0; i < CAMERAS; i++) {
            if (i == AFAR) continue;
            Camera camera = camera_number(i, &field);
            draw(&program, &texture, &camera, &picture);
            compare_to_doubles(&apart, paper_taps, &held, &camera, &picture);
        }
        print_message("%dx%dx%dx%d in %d textures: at most %.4f/255\n", field.u, field.v, field.s, field.t,
                      texture.count, apart.linear);
        assert_true(apart.linear <= 1 && apart.srgb <= 1);
        field_texture_destroy(&texture);
        free(texels);
    }
    picture_destroy(&picture);
    program_destroy(&program);
}

/* One block is white and all others are black, so the angles do not count: a pixel shows the white block's
 * spatial weight alone. A tap that left its block would bring white where there is none, or black into the
 * block, wherever angles reach an end of s or t. So the white block is seen from eight sides, grazing, and
 * each of those four ends must have been reached. */
static void test_borders(void **state) {
    (void)state;
    Field field = {.model = FIELD_SPHERE, .radius = 1, .u = 12, .v = 10, .s = 8, .t = 9};
    const char *const fragments[] = {"paper.frag", "paper-fast.frag", "paper-pages.frag"};
    uint8_t *texels = allocate(field_bytes(&field), 1);
    Picture picture = picture_create(SIDE, SIDE, true);
    int clamped[4] = {0};
    for (int k = 0; k < 3; k++) {
        Program program = build(fragments[k]);
        for (int pass = 0; pass < 6; pass++) {
            int white_u = (int)random_in(0, field.u), white_v = (int)random_in(0, field.v);
            memset(texels, 0, field_bytes(&field));
            memset(texels + field_row(&field) * (size_t)white_v + field_block(&field) * (size_t)white_u, 255,
                   field_block(&field));
            FieldTexture texture = upload(&field, texels);
            Held held = {.field = &field, .texels = texels};
            /* From all sides of the white block, grazing: past each end of s and t. */
            Vec3 centre = point_at(&field, (white_u + 0.5) / field.u, (white_v + 0.5) / field.v), x, y, z;
            equation_4(&field, centre, &x, &y, &z);
            for (int side = 0; side < 8; side++) {
                double angle = side * PI / 4;
                Vec3 aside = vec3_add(vec3_scale(x, cos(angle)), vec3_scale(y, sin(angle)));
                Vec3 eye = vec3_add(centre, vec3_add(vec3_scale(aside, 1.5), vec3_scale(z, 0.12)));
                Camera camera = looking(eye, centre, 40);
                draw(&program, &texture, &camera, &picture);
                Apart apart = {0};
                compare_to_doubles(&apart, paper_taps, &held, &camera, &picture);
                if (apart.linear > 0.05) fail_msg("%s reads across a border: %g", fragments[k], apart.linear);
                Vec2 st = equation_5(&field, centre, vec3_normalize(vec3_sub(eye, centre)));
                clamped[0] += st.x<0.5 / field.s, clamped[1] += st.x> 1 - 0.5 / field.s;
                clamped[2] += st.y<0.5 / field.t, clamped[3] += st.y> 1 - 0.5 / field.t;
            }
            field_texture_destroy(&texture);
        }
        program_destroy(&program);
    }
    for (int i = 0; i < 4; i++) assert_true(clamped[i] > 0);
    picture_destroy(&picture);
    free(texels);
}

/* What trilinear.frag takes for a pixel's size, read off a picture whose level k is k / 8 everywhere.
 * Straight on, a pixel covers the same of the model both ways. */
static void test_level(void **state) {
    (void)state;
    enum { LEVELS = 7, WIDE = 512, HIGH = 256 };
    const Field field = {FIELD_SPHERE, .radius = 3.5, .u = WIDE, .v = HIGH, .s = 8, .t = 8};
    Image levels[LEVELS];
    for (int k = 0; k < LEVELS; k++) {
        levels[k] = image_create(WIDE >> k, HIGH >> k, 3);
        for (int i = 0; i < (WIDE >> k) * (HIGH >> k) * 3; i++) levels[k].pixels[i] = (float)k / 8;
    }
    Texture plain = texture_create(levels, LEVELS, TEXTURE_FLOAT, TEXTURE_TRILINEAR);
    Program program = build("trilinear.frag");
    for (double distance = 10; distance <= 80; distance *= 2) {
        Camera camera = looking(v3(distance, 0, 0), v3(0, 0, 0), 30);
        Frame frame = {.program = &program, .camera = camera, .width = SIDE, .height = SIDE};
        double pixel = 2 * tan(radians(15)) / SIDE, texels = (distance - 3.5) * pixel / (PI * 3.5 / HIGH);
        Target target = target_create(SIDE, SIDE, true);
        Picture picture = picture_create(SIDE, SIDE, true);
        target_begin(&target, (Vec3){0});
        program_use(&program);
        program_vector(&program, "size", SIDE, SIDE, 0, 0);
        program_number(&program, "pixel", pixel);
        program_texture(&program, "plain", &plain);
        field_uniforms(&frame, &field);
        draw_everywhere();
        target_read(&target, &picture);
        double level = 8 * *image_at(&picture.colour, SIDE / 2, SIDE / 2);
        print_message("# from %g: level %.3f, expected %.3f\n", distance, level, log2(texels));
        assert_true(fabs(level - log2(texels)) < 0.05);
        picture_destroy(&picture);
        target_destroy(&target);
    }
    program_destroy(&program);
    texture_destroy(&plain);
    for (int k = 0; k < LEVELS; k++) image_destroy(&levels[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_paper),
        cmocka_unit_test(test_sine),
        cmocka_unit_test(test_stereographic),
        cmocka_unit_test(test_shared),
        cmocka_unit_test(test_nearest),
        cmocka_unit_test(test_depth_mean),
        cmocka_unit_test(test_depth_corrected),
        cmocka_unit_test(test_decoding),
        cmocka_unit_test(test_fast),
        cmocka_unit_test(test_long),
        cmocka_unit_test(test_pages),
        cmocka_unit_test(test_cut),
        cmocka_unit_test(test_borders),
        cmocka_unit_test(test_level),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("taps", tests, start, end);
}
