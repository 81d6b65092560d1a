/* Parallax mapping: one lookup of a depth, and the texture shifts with the eye.
 *
 * What to look for: walk around the wall (drag). With `plain` it is wallpaper. With `parallax` and
 * `per-pixel` the mortar sinks, but at grazing angles bricks smear and swim, for the depth is read where the
 * ray enters and not where it lands. `iterated` repairs that where the wall is gentle, and trembles where it
 * is steep. */
#include "wall.h"

/* ---- The techniques ---- */

#define SURFACE .vertex = "surface.vert"
#define PLAIN                                                                                                \
    { "plain", "the texture as it lies on the polygon", SURFACE, .fragment = "plain.frag" }
#define TWO_FETCHES                                                                                          \
    {                                                                                                        \
        "two-fetches", "reads the same two textures unshifted: what any shift must cost", SURFACE,           \
            .fragment = "two-fetches.frag"                                                                   \
    }
#define DISTORTION_MAP                                                                                       \
    {                                                                                                        \
        "distortion-map", "the shift of this view built in C, read and added", SURFACE,                      \
            .fragment = "distortion-map.frag", .prepare = wall_prepare_distortion                            \
    }
#define PARALLAX                                                                                             \
    { "parallax", "the paper's: one view vector for the whole polygon", SURFACE, .fragment = "parallax.frag" }
#define PER_PIXEL                                                                                            \
    { "per-pixel", "each pixel's own view vector", SURFACE, .fragment = "per-pixel.frag" }
#define OFFSET_LIMIT                                                                                         \
    {                                                                                                        \
        "offset-limit", "without the division by view.z: a shift of at most d", SURFACE,                     \
            .fragment = "offset-limit.frag"                                                                  \
    }
#define ITERATED                                                                                             \
    {                                                                                                        \
        "iterated", "the depth read again where the last shift led", SURFACE, .fragment = "iterated.frag",   \
                                                                              .knob = {                      \
                                                                                  "iterations",              \
                                                                                  {2, 4, 8, 16}              \
                                                                              }                              \
    }

/* ---- The views: from the front and turned about y, orthographic and so near that the wall fills the
 * picture; and one in perspective ---- */

#define TURNED(x, z, h)                                                                                      \
    { .eye = {x, 0, z}, .up = {0, 1, 0}, .height = h, .near = 0.1, .far = 10 }
#define NEAR                                                                                                 \
    {                                                                                                        \
        .eye = {0.35, 0.15, 0.45}, .target = {0.05, 0, 0}, .up = {0, 1, 0}, .fov_y_degrees = 50,             \
        .near = 0.01, .far = 10                                                                              \
    }
#define FRONT_VIEW                                                                                           \
    { "front", TURNED(0, 4, 0.74) }
#define VIEW_30                                                                                              \
    { "30", TURNED(2, 3.4641016151377544, 0.64) }
#define VIEW_60                                                                                              \
    { "60", TURNED(3.4641016151377544, 2, 0.37) }
#define VIEW_75                                                                                              \
    { "75", TURNED(3.8637033051562732, 1.0352761804100831, 0.19) }
#define NEAR_VIEW                                                                                            \
    { "near", NEAR }

#define WALL                                                                                                 \
    .unload = wall_unload, .draw = wall_draw, .truth = wall_truth, .texels = wall_texels,                    \
    .measure = wall_measure, .background = {0.02, 0.02, 0.02}

static const Lesson lesson = {
    "14-parallax",
    "parallax mapping: a depth looked up once moves the texture with the eye",
    {
        {"brick", "a brick wall, its bricks' faces in the polygon (base 1)",
         .techniques = {PLAIN, TWO_FETCHES, DISTORTION_MAP, PARALLAX, PER_PIXEL, OFFSET_LIMIT, ITERATED},
         .views = {FRONT_VIEW, VIEW_30, VIEW_60, VIEW_75, NEAR_VIEW}, .colour = "brick-colour.png",
         .height = "brick-height.png",
         .facts = {{"polygon_width", 1, "world units, around the origin in the plane z = 0"},
                   {"base", 1, "height of the polygon"}},
         .path = {TURNED(2, 3.4641016151377544, 0.64), TURNED(2.5, 3.1224989991991992, 0.64)},
         .load = wall_load, WALL},
        {"bottom", "the same wall standing on its polygon (base 0)",
         .techniques = {PLAIN, PER_PIXEL, OFFSET_LIMIT, ITERATED}, .views = {VIEW_30, VIEW_60, NEAR_VIEW},
         .colour = "brick-colour.png", .height = "brick-height.png",
         .facts = {{"polygon_width", 1, "world units, around the origin in the plane z = 0"},
                   {"base", 0, "height of the polygon"}},
         .load = wall_load_bottom, WALL},
        {"soft", "gentle waves, where the iteration contracts",
         .techniques = {PLAIN, PER_PIXEL, OFFSET_LIMIT, ITERATED},
         .views = {VIEW_30, VIEW_60, VIEW_75, NEAR_VIEW}, .colour = "uv-grid.png",
         .height = "soft-height.png",
         .facts = {{"polygon_width", 1, "world units, around the origin in the plane z = 0"},
                   {"base", 1, "height of the polygon"}},
         .load = wall_load, WALL},
    }};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
