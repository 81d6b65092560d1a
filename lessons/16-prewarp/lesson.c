/* Relief textures by pre-warp: each texel is moved, before anything is drawn, to where the polygon must show
 * it.
 *
 * What to look for: walk around the wall (drag), and let the light go around (space). */
#include "scene.h"

/* ---- The techniques ---- */

/* clang-format off */
#define SHADED(id, says) .name = id, .what = says, .vertex = "surface.vert", .fragment = "warped.frag"

#define WARPED(id, way, says) {SHADED(id, says), .variant = way, .prepare = scene_prepare}

#define NOT_WARPED {SHADED("plain", "the texture as it lies on the polygon"), .variant = PLAIN}
#define BY_ORDER \
    WARPED("occlusion-none", ORDER_NONE, "painted toward the epipole, each texel where it lands"), \
    WARPED("occlusion-linear", ORDER_LINEAR, "painted toward the epipole, cell by cell between texels")
#define INVERSELY WARPED("inverse", INVERSE, "for each texel of the result the relief's first point on its ray")
#define IN_TWO_PASSES WARPED("two-pass", TWO_PASS, "rows, then columns")

/* ---- The views: orthographic, turned about y, as lesson 15's ---- */

#define ORTHOGRAPHIC(x, y, z, picture_height) \
    {.eye = {x, y, z}, .up = {0, 1, 0}, .height = picture_height, .near = 0.1, .far = 20}

#define VIEW_30 {"30", ORTHOGRAPHIC(2, 0, 3.4641016151377544, 0.64)}
#define VIEW_60 {"60", ORTHOGRAPHIC(3.4641016151377544, 0, 2, 0.37)}
#define VIEW_80 {"80", ORTHOGRAPHIC(3.9392310120488321, 0, 0.69459271066772132, 0.13)}
#define VIEW_87 \
    {"87", {.eye = {3.9945181390182953, 0.0625, 0.20934382497177531}, .target = {0, 0.0625, 0}, .up = {0, 1, 0}, \
            .height = 0.039, .near = 0.1, .far = 20}} /* of bricks: of the mortar in the middle nothing is seen */

/* ---- The scenes ---- */

#define WALL .unload = scene_unload, .draw = scene_draw, .move = scene_move, .truth = scene_truth, \
    .texels = scene_texels, .measure = scene_measure, .background = {0.02, 0.02, 0.02}
/* clang-format on */

static const Lesson lesson = {
    .name = "16-prewarp",
    .title = "relief textures by pre-warp: texels are moved first, then the texture is mapped as any other",
    .width = 320,
    .height = 240,
    .scenes = {{"brick", "a brick wall, its bricks' faces in the polygon (base 1)",
                .techniques = {NOT_WARPED, BY_ORDER, IN_TWO_PASSES, INVERSELY},
                .views = {VIEW_30, VIEW_60, VIEW_80, VIEW_87}, .colour = "brick-256-colour.png",
                .height = "brick-256-height.png", .load = scene_load, .samples = 8, WALL}}};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
