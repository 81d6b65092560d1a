/* Relief textures by pre-warp: each texel is moved, before anything is drawn, to where the polygon must show
 * it.
 *
 * What to look for: walk around the wall (drag). With `plain` it is wallpaper. With `occlusion-none` it opens
 * like a fan: between texels that were moved apart there is nothing. `occlusion-linear` closes that, without
 * a depth buffer: what is in front was painted last. Let the light go around (space): the normals moved
 * along. In the scene `overflow` go down to a corner and compare `lost` with `auxiliary`. */
#include "scene.h"

/* ---- The techniques ---- */

/* clang-format off */
#define SHADED(id, says) .name = id, .what = says, .vertex = "surface.vert", .fragment = "warped.frag"
#define WARPED(id, way, says) {SHADED(id, says), .variant = way, .prepare = scene_prepare}

#define NOT_WARPED {SHADED("plain", "the texture as it lies on the polygon"), .variant = PLAIN}
#define BY_DEPTH \
    WARPED("depth-none", DEPTH_NONE, "a depth buffer keeps the nearest (West); holes stay"), \
    WARPED("depth-linear", DEPTH_LINEAR, "a depth buffer; holes filled between a texel and its neighbours"), \
    WARPED("depth-splat", DEPTH_SPLAT, "a depth buffer; each texel a soft spot")
#define POINTS WARPED("occlusion-none", ORDER_NONE, "painted toward the epipole (McMillan), no buffer; holes stay")
#define LINEAR WARPED("occlusion-linear", ORDER_LINEAR, "painted toward the epipole; holes filled between neighbours")
#define BY_ORDER \
    POINTS, LINEAR, WARPED("occlusion-splat", ORDER_SPLAT, "painted toward the epipole; each texel a soft spot")
#define IN_TWO_PASSES WARPED("two-pass", TWO_PASS, "rows, then columns (Oliveira)")
#define INVERSELY WARPED("inverse", INVERSE, "for each texel of the result, what its ray meets (Parilov)")

#define BEYOND_EDGES \
    WARPED("lost", ORDER_LINEAR, "what is seen beyond the polygon's edges is lost"), \
    WARPED("auxiliary", AUXILIARY, "it lands on polygons that stand at the edges (Oliveira)"), \
    WARPED("resized", RESIZED, "it lands on the polygon's plane, which is enlarged (Parilov)")

/* ---- The views: lesson 15's, orthographic and turned about y ... ---- */

#define TURNED(id, x, z, picture_height) \
    {.name = id, .camera = {.eye = {x, 0.02, z}, .target = {0, 0.02, 0}, .up = {0, 1, 0}, .height = picture_height, \
                            .near = 0.1, .far = 20}}
#define ANGLES \
    TURNED("30", 2, 3.4641016151377544, 0.64), TURNED("60", 3.4641016151377544, 2, 0.37), \
    TURNED("80", 3.9392310120488321, 0.69459271066772133, 0.13), \
    TURNED("87", 3.9945181390182953, 0.20934382497177531, 0.039)

/* ... and all around: at an angle from the normal (by its sine and cosine) and in a direction (x, y) of the plane, the
 * eye 1.5 widths away and infinitely far. The whole polygon is in view. ---- */

#define NEAR(id, s, c, x, y, degrees, unpictured) \
    {.name = id, .extra = unpictured, \
     .camera = {.eye = {1.5 * (s) * (x), 1.5 * (s) * (y), 1.5 * (c)}, .up = {0, (s) == 0, (s) != 0}, \
                .fov_y_degrees = degrees, .near = 0.1, .far = 10}}
#define FAR(id, s, c, x, y, picture_height, unpictured) \
    {.name = id "-far", .extra = unpictured, \
     .camera = {.eye = {4 * (s) * (x), 4 * (s) * (y), 4 * (c)}, .up = {0, (s) == 0, (s) != 0}, \
                .height = picture_height, .near = 0.1, .far = 20}}
#define BOTH(id, s, c, degrees, height, x, y) NEAR(id, s, c, x, y, degrees, true), FAR(id, s, c, x, y, height, true)
#define R2 0.70710678118654752
#define EIGHT(id, ...) \
    BOTH(id "-000", __VA_ARGS__, 1, 0), BOTH(id "-045", __VA_ARGS__, R2, R2), BOTH(id "-090", __VA_ARGS__, 0, 1), \
    BOTH(id "-135", __VA_ARGS__, -R2, R2), BOTH(id "-180", __VA_ARGS__, -1, 0), BOTH(id "-225", __VA_ARGS__, -R2, -R2), \
    BOTH(id "-270", __VA_ARGS__, 0, -1), BOTH(id "-315", __VA_ARGS__, R2, -R2)
#define AROUND \
    BOTH("0", 0, 1, 40, 1.1, 0, 0), EIGHT("30", 0.5, 0.86602540378443865, 58, 1.3), \
    EIGHT("60", 0.86602540378443865, 0.5, 44, 1.1), EIGHT("75", 0.96592582628906829, 0.25881904510252076, 44, 1.1)

#define CORNER_AND_ABOVE \
    NEAR("60-045", 0.86602540378443865, 0.5, R2, R2, 44, false), \
    FAR("60-045", 0.86602540378443865, 0.5, R2, R2, 1.1, false), NEAR("0", 0, 1, 0, 0, 40, false)

/* ---- The scenes ---- */

#define WALL(base, base_says, extent_says) \
    .unload = scene_unload, .draw = scene_draw, .move = scene_move, .truth = scene_truth, .texels = scene_texels, \
    .measure = scene_measure, .background = {0.02, 0.02, 0.02}, \
    .facts = {{"polygon_width", 1, "world units, around the origin in the plane z = 0"}, \
              {"base", base, "height of the polygon, " base_says}, \
              {"extent", 1, "width: the relief ends with the polygon, without sides, and is seen " extent_says}, \
              {"light_azimuth", 120, "degrees from +u toward +v, far away"}, \
              {"light_tangent", 0.7, "its height over the plane, to its distance in the plane"}, \
              {"ambient", 0.3, "colour = texture (ambient + (1 - ambient) max(n.l, 0)); there are no shadows"}, \
              {"normal_span", 2, "texels: n by central differences at the larger image's size, interpolated, unit"}}
#define BEHIND "through the polygon alone"
#define AROUND_IT "from beside the polygon too"
#define FROM_FILE "unless base_of_file says otherwise"
#define TOP WALL(1, FROM_FILE, BEHIND)
#define BRICK .colour = "brick-256-colour.png", .height = "brick-256-height.png"
#define TERRAIN .colour = "terrain-relief.png", .height = "terrain-relief.png"
/* clang-format on */

static const Lesson lesson = {
    .name = "16-prewarp",
    .title = "relief textures by pre-warp: texels are moved first, then the texture is mapped as any other",
    .width = 320,
    .height = 240,
    .scenes = {
        {"brick", "a brick wall, its bricks' faces in the polygon (base 1)",
         .techniques = {NOT_WARPED, BY_DEPTH, BY_ORDER, IN_TWO_PASSES, INVERSELY}, .views = {ANGLES, AROUND},
         BRICK, .load = scene_load, TOP},
        {"terrain", "a real mountain, Levi in Finland, one and a half times as steep as it is",
         .techniques = {NOT_WARPED, POINTS, LINEAR, IN_TWO_PASSES, INVERSELY}, .views = {ANGLES, AROUND},
         TERRAIN, .load = scene_load, TOP},
        {"pins", "a hostile map: a pin of one texel in each 8 x 8, on flat ground",
         .techniques = {NOT_WARPED, POINTS, LINEAR, IN_TWO_PASSES}, .views = {ANGLES},
         .colour = "uv-grid.png", .height = "pins-height.png", .load = scene_load, TOP},
        {"overflow", "the wall below its polygon, seen beyond two edges at most (base 1)",
         .techniques = {NOT_WARPED, BEYOND_EDGES}, .views = {CORNER_AND_ABOVE}, BRICK,
         .load = scene_load_overflow, WALL(1, FROM_FILE, AROUND_IT)},
        {"bottom", "the wall standing on its polygon, seen beyond up to four edges (base 0)",
         .techniques = {NOT_WARPED, BEYOND_EDGES}, .views = {CORNER_AND_ABOVE}, BRICK,
         .load = scene_load_bottom, WALL(0, "whatever base_of_file says", AROUND_IT)},
    }};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
