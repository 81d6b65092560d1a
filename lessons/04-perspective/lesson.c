/* Interpolation across a polygon: between its corners, what is linear, and where?
 *
 * What to look for: in the scene quad, go from the view 0 to 80. Seen from the front, `affine` is right;
 * tilted, the wall breaks along the diagonal of its two triangles, for s and t are linear on the wall but not
 * on the screen. `subdivided` breaks it into many small errors, `spans` into bulges that `perspective` has
 * not. And `colour` shows what is left of a texture that is looked up at the corners alone. On the floor,
 * which goes on under the eye and behind it, try the same techniques. Then the joints: bright pixels
 * that no triangle draws, and blue ones that two draw. */
#include "cracks.h"
#include "raster.h"
#include "square.h"

/* clang-format off */

/* ---- The techniques ---- */

#define PAINTED(name, what, filling) {name, what, .variant = filling, .paint = square_paint}
#define PAINTED_WITH(name, what, filling, knob_name, ...) \
    {name, what, .variant = filling, .paint = square_paint, .knob = {knob_name, {__VA_ARGS__}}}

#define AFFINE PAINTED("affine", "s and t linear on the screen, in two triangles", FILL_AFFINE)
#define COLOUR(...) \
    PAINTED_WITH("colour", "the texture read at the vertices, their colours linear on the screen", FILL_COLOUR, \
                 "splits", __VA_ARGS__)
#define SUBDIVIDED(...) \
    PAINTED_WITH("subdivided", "affine in splits x splits cells", FILL_AFFINE, "splits", __VA_ARGS__)
#define SPANS(...) \
    PAINTED_WITH("spans", "exact every n pixels of a row, linear between", FILL_SPANS, "n", __VA_ARGS__)
#define PERSPECTIVE PAINTED("perspective", "s/w, t/w and 1/w linear on the screen, and a division", FILL_PERSPECTIVE)
#define OPENGL \
    {.name = "opengl", .what = "OpenGL's own interpolation", .vertex = "surface.vert", .fragment = "opengl.frag"}

#define CRACKS(name, what, kind, ...) \
    {name, what, .variant = kind, .paint = cracks_paint, .knob = {"places", {__VA_ARGS__}}}

/* ---- The views. The wall's: its normal turned away by an angle, about an axis that is not upright in the
 * picture ---- */

#define TILTED(id, x, z) \
    {.name = id, .camera = {.eye = {x, 0, z}, .up = {0.3, 1, 0}, .fov_y_degrees = 50, .near = 0.05, .far = 20}}
#define STANDING(id, x, y, z, toward_x, toward_y, toward_z, ...) \
    {.name = id, .camera = {.eye = {x, y, z}, .target = {toward_x, toward_y, toward_z}, .up = {__VA_ARGS__}, \
                              .fov_y_degrees = 60, .near = 0.05, .far = 40000}}
#define LOOKING(id, x, y, z, toward_z, angle) \
    {.name = id, .camera = {.eye = {x, y, z}, .target = {0, 0, toward_z}, .up = {0.2, 1, 0}, .fov_y_degrees = angle, \
                              .near = 0.1, .far = 20}}

/* ---- The scenes ---- */

#define SQUARE .unload = square_unload, .draw = square_draw, .truth = square_truth, .texels = square_texels, \
    .measure = square_measure
#define FACTS(...) FACTS_OF(__VA_ARGS__)
#define FACTS_OF(side, repeats, first) \
    .facts = {{"side", side, "world units, of a square around the origin in the plane z = 0"}, \
              {"repeats", repeats, "of the texture along a side"}, \
              {"first", first, "s and t at the corner where x and y are least"}}

static const Lesson lesson = {
    .name = "04-perspective",
    .title = "interpolation across a polygon: why not the colour, and why not linearly on the screen?",
    .scenes = {
        {"quad", "a wall, turned away from the eye by up to 80 degrees",
         .techniques = {AFFINE, COLOUR(1, 64), SUBDIVIDED(1, 4, 16, 64), SPANS(4, 16, 64), PERSPECTIVE, OPENGL},
         .views = {TILTED("0", 0, 1.45), TILTED("45", 0.7778174593052023, 0.77781745930520241),
                   TILTED("70", 0.84572335870731752, 0.30781812899310196),
                   TILTED("80", 0.73860581475915599, 0.13023613325019781)},
         .colour = "brick-256-colour.png", .background = {0.02, 0.02, 0.02}, .samples = 18,
         .load = square_load_quad, SQUARE, FACTS(QUAD)},
        {"floor", "a floor that passes under the eye and goes on behind it",
         .techniques = {AFFINE, COLOUR(64), SUBDIVIDED(4, 16, 64), SPANS(16), PERSPECTIVE, OPENGL},
         .views = {STANDING("ahead", 0.3, -1, 0.8, 0, 2, 0.3, 0, 0, 1),
                   STANDING("under", 0.3, -1, 1.6, 0.5, -0.4, 0, 0.5, 0, 1)},
         .colour = "checker.png", .background = {0.25, 0.45, 0.8}, .samples = 18, .load = square_load_floor, SQUARE,
         FACTS(FLOOR)},
        {"horizon", "the same floor, 20,000 repeats wide",
         .techniques = {PERSPECTIVE, SPANS(16), OPENGL},
         .views = {STANDING("far-high", 0, 0, 30, 3, 9, 28, 0, 0, 1),
                   STANDING("far-rolled", 0.3, 0.2, 0.8, 1, 3, 0.3, 0.35, 0, 1)},
         .colour = "checker.png", .background = {0.25, 0.45, 0.8}, .samples = 18, .load = square_load_horizon,
         SQUARE, FACTS(HORIZON)},
        {"joints", "a wall whose halves are split 5 x 5 and 7 x 7; vertices snap to so many places a pixel",
         .techniques = {CRACKS("cracked", "each half by itself", CRACKED, 1, 16, 256),
                        CRACKS("mended", "each half with the other's vertices on the joint", MENDED, 1, 256)},
         .views = {LOOKING("front", 0.6, 0.25, 1, 0, 45)},
         .colour = "brick-256-colour.png", .background = {0.3, 1, 0.1}, .samples = 8, .load = cracks_load_joints,
         .facts = {{"side", 1, "world units, of a square around the origin in the plane z = 0"},
                   {"joint", 0, "x"}, {"cells_left", 5, "a side"}, {"cells_right", 7, "a side"}},
         .unload = cracks_unload, .truth = cracks_truth, .measure = cracks_measure},
        {"levels", "a tower in two levels of detail: 8 faces below the joint, 4 above",
         .techniques = {CRACKS("cracked", "each level by itself", CRACKED, 256),
                        CRACKS("mended", "the coarse level with the fine one's vertices on the joint", MENDED, 256)},
         .views = {LOOKING("above", 0.3, 1.6, 3, 1, 26), LOOKING("below", 0.3, -1.6, 3, 1, 26)},
         .colour = "brick-256-colour.png", .background = {0.3, 1, 0.1}, .samples = 8, .load = cracks_load_levels,
         .facts = {{"radius", 1, "world units, around the y axis"}, {"arc", ARC_DEGREES, "degrees around +z"},
                   {"height", 1, "world units, around y = 0"}, {"joint", 0, "y"},
                   {"faces_below", 8, "of chords; and as many rows"}, {"faces_above", 4, "of chords; and as many rows"}},
         .unload = cracks_unload, .truth = cracks_truth, .measure = cracks_measure},
    }};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
