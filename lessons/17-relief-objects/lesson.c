/* Whole objects from six relief textures, one on each face of a box.
 *
 * What to look for: with `flat` there are pictures on a box. Choose `relief`, and the same six pictures are
 * an object: drag around it, over edges and corners of the box, let the light move, and look for a seam. Then
 * `front-only` in the view in-edge: sides that only a face away from the eye has seen are missing. `no-rims`:
 * cracks, where two faces' surfaces should meet and both end a texel before. `bridged`: webs, where
 * neighbours in a picture are no neighbours in space. And on the bunny, behind its ears: small holes, which
 * no face has seen. */
#include "exhibit.h"

/* clang-format off */

/* ---- The techniques ---- */

#define MESH {.name = "mesh", .what = "the object's triangles, for comparison", .vertex = "surface.vert", \
              .fragment = "mesh.frag", .variant = EXHIBIT_MESH}
#define WARPED(id, says, kind) \
    .name = id, .what = says, .vertex = "surface.vert", .fragment = "relief.frag", .variant = kind, \
    .prepare = exhibit_prepare
#define FLAT {WARPED("flat", "each relief's colours as they lie on its face", EXHIBIT_FLAT)}
#define RELIEF {WARPED("relief", "all six reliefs, warped onto the faces that the eye looks through", EXHIBIT_ALL), \
                .knob = {"samples", {1, 2}}}
#define FRONT_ONLY {WARPED("front-only", "only the reliefs of the faces that the eye looks through", EXHIBIT_FRONTS)}
#define NO_RIMS {WARPED("no-rims", "surfaces that end at their last texels", EXHIBIT_CELLS)}
#define BRIDGED {WARPED("bridged", "all neighbours joined, over cliffs too", EXHIBIT_BRIDGED)}
#define TECHNIQUES MESH, FLAT, RELIEF, FRONT_ONLY, NO_RIMS, BRIDGED

/* ---- The views: 26 directions, over the faces, edges and corners of the box, 5 away, of an angle so that the object
 * fills a quarter of the picture; and hard ones ---- */

#define FROM(name, fov, x, y, z, up_y, up_z, is_extra) \
    {name, {.eye = {x, y, z}, .up = {0, up_y, up_z}, .fov_y_degrees = fov, .near = 0.5, .far = 20}, is_extra}
#define FACE(name, fov, x, y, z, is_extra) FROM(name, fov, 5 * (x), 5 * (y), 5 * (z), (y) == 0, -(y), is_extra)
#define OVER_EDGE 3.5355339059327378 /* 5 / sqrt 2 */
#define EDGE(name, fov, x, y, z) FROM(name, fov, OVER_EDGE * (x), OVER_EDGE * (y), OVER_EDGE * (z), 1, 0, true)
#define OVER_CORNER 2.8867513459481287 /* 5 / sqrt 3 */
#define CORNER(name, fov, x, y, z, is_extra) \
    FROM(name, fov, OVER_CORNER * (x), OVER_CORNER * (y), OVER_CORNER * (z), 1, 0, is_extra)
#define DIRECTIONS(of_face, of_edge, of_corner) \
    FACE("front", of_face, 0, 0, 1, false), CORNER("top-front-right", of_corner, 1, 1, 1, false), \
    CORNER("top-back-left", of_corner, -1, 1, -1, false), \
    FACE("back", of_face, 0, 0, -1, true), FACE("right", of_face, 1, 0, 0, true), FACE("left", of_face, -1, 0, 0, true), \
    FACE("top", of_face, 0, 1, 0, true), FACE("bottom", of_face, 0, -1, 0, true), \
    EDGE("front-right", of_edge, 1, 0, 1), EDGE("front-left", of_edge, -1, 0, 1), EDGE("back-right", of_edge, 1, 0, -1), \
    EDGE("back-left", of_edge, -1, 0, -1), EDGE("top-front", of_edge, 0, 1, 1), EDGE("top-back", of_edge, 0, 1, -1), \
    EDGE("top-right", of_edge, 1, 1, 0), EDGE("top-left", of_edge, -1, 1, 0), EDGE("bottom-front", of_edge, 0, -1, 1), \
    EDGE("bottom-back", of_edge, 0, -1, -1), EDGE("bottom-right", of_edge, 1, -1, 0), EDGE("bottom-left", of_edge, -1, -1, 0), \
    CORNER("top-front-left", of_corner, -1, 1, 1, true), CORNER("top-back-right", of_corner, 1, 1, -1, true), \
    CORNER("bottom-back-left", of_corner, -1, -1, -1, true), CORNER("bottom-front-right", of_corner, 1, -1, 1, true), \
    CORNER("bottom-front-left", of_corner, -1, -1, 1, true), CORNER("bottom-back-right", of_corner, 1, -1, -1, true)
#define ORTHOGRAPHIC \
    {"orthographic", {.eye = {3, 2, 4}, .up = {0, 1, 0}, .height = 2.7, .near = 0.5, .far = 20}, true}
#define INSIDE(x, y, z) \
    {"inside", {.eye = {x, y, z}, .up = {0, 1, 0}, .fov_y_degrees = 60, .near = 0.01, .far = 20}, true}

/* ---- The scenes ---- */

#define EXHIBIT .techniques = {TECHNIQUES}, .background = {0.02, 0.02, 0.02}, .samples = 18, .brief_extras = true, \
    .unload = exhibit_unload, .draw = exhibit_draw, .move = exhibit_move, .truth = exhibit_truth, .measure = exhibit_measure

static const Lesson lesson = {
    .name = "17-relief-objects",
    .title = "whole objects from at most six relief textures",
    .scenes = {
        {"solids", "a toy of spheres, cylinders and boxes, exact by its formula", EXHIBIT,
         .colour = "solids-front.png", .load = exhibit_load_solids,
         .views = {DIRECTIONS(30, 30, 30),
                   FROM("in-face", 30, 1.05, 0.4, 5, 1, 0, true),  /* in the plane of the right face */
                   FROM("in-edge", 30, 1.05, 1.03, 5, 1, 0, true), /* and of the top: on the line of an edge */
                   FROM("through-corner", 30, 2.94, 2.884, 2.828, 1, 0, true), ORTHOGRAPHIC, INSIDE(0.9, 0.85, 0.85)}},
        {"bunny", "the Stanford bunny, a mesh of 69,666 triangles", EXHIBIT,
         .colour = "bunny-front.png", .other = {"bunny.obj"}, .load = exhibit_load_bunny,
         .views = {DIRECTIONS(26.1, 25.5, 27.6), ORTHOGRAPHIC, INSIDE(0.8, 0.6, 0.6)}},
    }};
/* clang-format on */

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
