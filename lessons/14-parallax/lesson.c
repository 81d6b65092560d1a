/* Parallax mapping: one lookup of a depth, and the texture shifts with the eye.
 *
 * What to look for: walk around the wall (drag). With `plain` it is wallpaper. With `parallax` and
 * `per-pixel` the mortar sinks, but at grazing angles bricks smear and swim, for the depth is read where the
 * ray enters and not where it lands. `iterated` repairs that where the wall is gentle, and trembles where it
 * is steep. On the cylinder, watch the joint: eight flat sides below, and the pattern meets that of the round
 * half. */
#include "parallax.h"
#include "prism.h"
#include "stereo.h"

/* ---- The techniques: a fragment shader each, of their own name ---- */

/* clang-format off */
#define SHADED(id, says) .name = id, .what = says, .vertex = "surface.vert", .fragment = id ".frag"

#define PLAIN {SHADED("plain", "the texture as it lies on the polygon")}
#define TWO_FETCHES {SHADED("two-fetches", "reads the same two textures unshifted: what any shift must cost")}
#define DISTORTION_MAP \
    {SHADED("distortion-map", "the shift of this view built in C, read and added"), \
     .prepare = parallax_prepare_distortion}
#define PARALLAX {SHADED("parallax", "the paper's: one view vector for the whole polygon")}
#define PER_PIXEL {SHADED("per-pixel", "each pixel's own view vector")}
#define OFFSET_LIMIT {SHADED("offset-limit", "without the division by view.z: a shift of at most d")}
#define ITERATED(...) \
    {SHADED("iterated", "the depth read again where the last shift led"), .knob = {"iterations", {__VA_ARGS__}}}
#define SIDES {"sides", {4, 8, 16, 32, 64}}

/* ---- The views. The wall's and the cylinder's are orthographic, turned about y, but for `near` and `above` ---- */

#define ORTHOGRAPHIC(x, y, z, picture_height) \
    {.eye = {x, y, z}, .up = {0, 1, 0}, .height = picture_height, .near = 0.1, .far = 20}

#define FRONT {.name = "front", .camera = ORTHOGRAPHIC(0, 0, 4, 0.74)}
#define WALL_30 ORTHOGRAPHIC(2, 0, 3.4641016151377544, 0.64)
#define WALL_60 ORTHOGRAPHIC(3.4641016151377544, 0, 2, 0.37)
#define WALL_82 ORTHOGRAPHIC(3.9610722749662936, 0, 0.55669240384026103, 0.1)
#define NEAR \
    {.name = "near", .camera = {.eye = {0.35, 0.15, 0.45}, .target = {0.05, 0, 0}, .up = {0, 1, 0}, \
                                  .fov_y_degrees = 50, .near = 0.01, .far = 10}}

#define CYLINDER_CORNER {.name = "corner", .camera = ORTHOGRAPHIC(0, 0, 4, 1.6)}
#define CYLINDER_FACE \
    {.name = "face", .camera = ORTHOGRAPHIC(1.5307337294603591, 0, 3.6955181300451465, 1.6)} /* 22.5 degrees */
#define ABOVE \
    {.name = "above", .camera = {.eye = {0.9, 1.2, 3.6}, .up = {0, 1, 0}, .fov_y_degrees = 34, .near = 0.1, .far = 20}}

/* The face toward +z of every prism of 4 sides or more, seen at an angle from its normal; `middle` is where the
 * picture's middle is, along the picture's width. */
#define AT_ANGLE(id, s, c, middle, width) \
    {.name = id, .camera = {.eye = {10 * (s) + (middle) * (c), 0, 10 * (c) - (middle) * (s)}, \
            .target = {(middle) * (c), 0, -(middle) * (s)}, .up = {0, 1, 0}, .height = 0.75 * (width), \
            .near = 0.1, .far = 20}}

#define EYE(id, x) \
    {.name = id, .camera = {.eye = {x, 0, 0.7}, .target = {x, 0, 0}, .up = {0, 1, 0}, .fov_y_degrees = 43, \
                              .near = 0.1, .far = 10}}

/* ---- The scenes ---- */

#define WALL(base, base_says) \
    .unload = parallax_unload, .draw = parallax_draw, .truth = wall_truth, .texels = wall_texels, \
    .background = {0.02, 0.02, 0.02}, \
    .facts = {{"polygon_width", 1, "world units, around the origin in the plane z = 0"}, \
              {"base", base, "height of the polygon, " base_says}}
#define ROUND \
    .unload = prism_unload, .draw = prism_draw, .truth = prism_truth, .texels = prism_texels, \
    .background = {0.02, 0.02, 0.02}, .samples = 8
#define CYLINDER_FACTS \
    {"radius", 1, "world units, around the y axis"}, {"height", CYLINDER_HEIGHT, "world units, around y = 0"}, \
    {"v_at_the_top", 0.5, "v is 0 at the bottom; u is 0.5 toward +z and grows toward +x, over 0..1 around"}
/* clang-format on */

static const Lesson lesson = {
    .name = "14-parallax",
    .title = "parallax mapping: a depth looked up once moves the texture with the eye",
    .scenes = {
        {"brick", "a brick wall, its bricks' faces in the polygon (base 1)",
         .techniques = {PLAIN, TWO_FETCHES, DISTORTION_MAP, PARALLAX, PER_PIXEL, OFFSET_LIMIT,
                        ITERATED(4, 16)},
         .views = {FRONT, {.name = "30", .camera = WALL_30}, {.name = "60", .camera = WALL_60}, NEAR},
         .colour = "brick-colour.png", .height = "brick-height.png",
         .path = {WALL_30, ORTHOGRAPHIC(2.5, 0, 3.1224989991991992, 0.64)}, .load = parallax_load,
         .samples = 18, .measure = parallax_measure, WALL(1, "unless base_of_file says otherwise")},
        {"bottom", "the same wall standing on its polygon (base 0)",
         .techniques = {PLAIN, PER_PIXEL, OFFSET_LIMIT, ITERATED(4)},
         .views = {{.name = "60", .camera = WALL_60}, NEAR}, .colour = "brick-colour.png",
         .height = "brick-height.png", .load = parallax_load_bottom, .samples = 18,
         .measure = parallax_measure, WALL(0, "whatever base_of_file says")},
        {"soft", "gentle waves, where the iteration contracts up to an angle of 73 degrees",
         .techniques = {PLAIN, PER_PIXEL, ITERATED(2, 4, 8, 16)},
         .views = {{.name = "30", .camera = WALL_30},
                   {.name = "60", .camera = WALL_60},
                   {.name = "82", .camera = WALL_82},
                   NEAR},
         .colour = "uv-grid.png", .height = "soft-height.png", .load = parallax_load, .samples = 8,
         .measure = parallax_measure, WALL(1, "unless base_of_file says otherwise")},
        {"cylinder", "eight sides below the joint, 32 plain ones above (the paper's Figure 6)",
         .techniques = {PLAIN, PARALLAX, PER_PIXEL, ITERATED(4)},
         .views = {CYLINDER_CORNER, CYLINDER_FACE, ABOVE}, .colour = "uv-grid.png",
         .facts = {CYLINDER_FACTS, {"joint", 0, "y: below it 8 sides, above it 32"}},
         .load = prism_load_cylinder, .measure = prism_measure_joint, ROUND},
        {"sides", "one face toward +z, by the number of sides and the angle of the view (Figure 3)",
         .techniques = {{SHADED("plain", "the texture as it lies on the faces"), .knob = SIDES},
                        {SHADED("parallax", "the paper's: one view vector for a face"), .knob = SIDES}},
         .views = {AT_ANGLE("0", 0.0, 1.0, 0.0, 1.4143),
                   AT_ANGLE("30", 0.5, 0.86602540378443871, -0.3535, 1.2248),
                   AT_ANGLE("60", 0.86602540378443871, 0.5, -0.6294, 0.7412),
                   AT_ANGLE("75", 0.96592582628906831, 0.25881904510252074, -0.75, 0.5),
                   AT_ANGLE("85", 0.99619469809174555, 0.087155742747658174, -0.765, 0.47)},
         .colour = "uv-grid.png", .facts = {CYLINDER_FACTS}, .load = prism_load_sides,
         .measure = prism_measure_sides, ROUND},
        {"stereo", "a photographed scene's relief from its measured disparity, seen by two eyes",
         .techniques = {PLAIN, PARALLAX, PER_PIXEL, OFFSET_LIMIT, ITERATED(4)},
         .views = {EYE("left", -0.0615), EYE("right", 0.0615)}, .colour = "stereo-colour.png",
         .height = "stereo-height.exr", .other = {"stereo-mask.png"}, .load = parallax_load, .samples = 18,
         .measure = stereo_measure, WALL(1, "unless base_of_file says otherwise")},
    }};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
