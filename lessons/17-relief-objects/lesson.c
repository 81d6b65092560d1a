/* Whole objects from six relief textures, one on each face of a box.
 *
 * What to look for: turn the object (drag). */
#include "exhibit.h"

/* clang-format off */

#define WARPED(id, says, kind) \
    .name = id, .what = says, .vertex = "surface.vert", .fragment = "relief.frag", .variant = kind, \
    .prepare = exhibit_prepare

#define RELIEF {WARPED("relief", "all six reliefs, warped onto the faces toward the eye", ALL_FACES), \
                .knob = {"samples", {2}}}

/* ---- The views: from the middle of each face, edge and corner ---- */

#define FROM(name, x, y, z, up_y, up_z, is_extra) \
    {name, {.eye = {x, y, z}, .up = {0, up_y, up_z}, .fov_y_degrees = 32, .near = 0.5, .far = 20}, is_extra}
#define FACE(name, x, y, z) FROM(name, 5 * (x), 5 * (y), 5 * (z), (y) == 0, -(y), true)
#define EDGE(name, x, y, z) FROM(name, 3.5355339059327378 * (x), 3.5355339059327378 * (y), 3.5355339059327378 * (z), 1, 0, true)
#define CORNER(name, x, y, z) FROM(name, 2.8867513459481287 * (x), 2.8867513459481287 * (y), 2.8867513459481287 * (z), 1, 0, true)
#define DIRECTIONS \
    FACE("front", 0, 0, 1), FACE("back", 0, 0, -1), FACE("right", 1, 0, 0), FACE("left", -1, 0, 0), \
    FACE("top", 0, 1, 0), FACE("bottom", 0, -1, 0), \
    EDGE("front-right", 1, 0, 1), EDGE("front-left", -1, 0, 1), EDGE("back-right", 1, 0, -1), EDGE("back-left", -1, 0, -1), \
    EDGE("top-front", 0, 1, 1), EDGE("top-back", 0, 1, -1), EDGE("top-right", 1, 1, 0), EDGE("top-left", -1, 1, 0), \
    EDGE("bottom-front", 0, -1, 1), EDGE("bottom-back", 0, -1, -1), EDGE("bottom-right", 1, -1, 0), EDGE("bottom-left", -1, -1, 0), \
    CORNER("top-front-right", 1, 1, 1), CORNER("top-front-left", -1, 1, 1), CORNER("top-back-right", 1, 1, -1), \
    CORNER("top-back-left", -1, 1, -1), CORNER("bottom-front-right", 1, -1, 1), CORNER("bottom-front-left", -1, -1, 1), \
    CORNER("bottom-back-right", 1, -1, -1), CORNER("bottom-back-left", -1, -1, -1)
/* clang-format on */

static const Lesson lesson = {
    .name = "17-relief-objects",
    .title = "whole objects from at most six relief textures",
    .scenes = {
        {"solids", "a toy of spheres, cylinders and boxes, exact by its formula", .techniques = {RELIEF},
         .views = {DIRECTIONS}, .colour = "solids-front.png", .background = {0.02, 0.02, 0.02}, .samples = 18,
         .load = exhibit_load_solids, .unload = exhibit_unload, .draw = exhibit_draw, .move = exhibit_move,
         .truth = exhibit_truth, .measure = exhibit_measure},
        {"bunny", "the Stanford bunny, a mesh of 70,000 triangles", .techniques = {RELIEF},
         .views = {DIRECTIONS}, .colour = "bunny-front.png", .other = {"bunny.obj"},
         .background = {0.02, 0.02, 0.02}, .samples = 18, .load = exhibit_load_bunny,
         .unload = exhibit_unload, .draw = exhibit_draw, .move = exhibit_move, .truth = exhibit_truth,
         .measure = exhibit_measure},
    }};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
