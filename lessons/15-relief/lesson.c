/* Relief mapping: a ray for each pixel, marched through a height field.
 *
 * What to look for: go down to a grazing angle (drag). `parallax` smears. `steep` shows slices, one a step;
 * `occlusion` and `relief` smooth them, until at 80 and 87 degrees whole bricks lose their edges and the pins
 * vanish: what is thinner than a step is not there. More steps (`]`) bring them back, and the frame rate
 * down. */
#include "relief.h"

/* ---- The techniques: a fragment shader each ---- */

/* clang-format off */
#define TECHNIQUE(id, file, says) .name = id, .what = says, .vertex = "surface.vert", .fragment = file ".frag"
#define MARCHED(id, says) TECHNIQUE(id, id, says)
#define STEPS(...) .knob = {"steps", {__VA_ARGS__}}

#define PARALLAX {MARCHED("parallax", "lesson 14's: one height, read where the ray crosses the polygon")}
#define STEEP(...) \
    {MARCHED("steep", "linear steps, the first below the surface (McGuire and McGuire 2005)"), STEPS(__VA_ARGS__)}
#define OCCLUSION(...) {MARCHED("occlusion", "linear steps and one secant (Tatarchuk 2006)"), STEPS(__VA_ARGS__)}
#define RELIEF(...) \
    {MARCHED("relief", "linear steps, then 6 halvings (Policarpo, Oliveira, Comba 2005)"), \
     STEPS(__VA_ARGS__)}
#define CONE(...) \
    {MARCHED("cone", "cones that the interpolated surface stays below (Dummer 2006; Bán et al. 2024)"), \
     STEPS(__VA_ARGS__), .variant = CONES}
#define MAXIMUM \
    {MARCHED("maximum", "a pyramid of maxima, then the exact root in a cell (Tevs, Ihrke, Seidel 2008)"), \
     .variant = PYRAMID}
#define MARCHES \
    PARALLAX, STEEP(32, 128), OCCLUSION(8, 32, 128), RELIEF(8, 32, 128, 512, 1024, 4096), CONE(8, 32, 128, 512), MAXIMUM
#define FEWER_MARCHES PARALLAX, STEEP(32), OCCLUSION(32), RELIEF(32, 512, 1024, 4096), CONE(32, 512), MAXIMUM

/* ---- The views: orthographic, so that every ray has the angle by which the view is turned about y. The polygon
 * fills them, and their middle is low on a course of bricks, for a picture at 87 degrees is but 10 texels high ---- */

#define ORTHOGRAPHIC(x, z, picture_height) \
    {.eye = {x, 0.02, z}, .target = {0, 0.02, 0}, .up = {0, 1, 0}, .height = picture_height, .near = 0.1, .far = 20}

#define VIEW_30(height) {.name = "30", .camera = ORTHOGRAPHIC(2, 3.4641016151377544, height)}
#define VIEW_60(height) {.name = "60", .camera = ORTHOGRAPHIC(3.4641016151377544, 2, height)}
#define VIEW_80 {.name = "80", .camera = ORTHOGRAPHIC(3.9392310120488321, 0.69459271066772133, 0.13)}
#define VIEW_87 {.name = "87", .camera = ORTHOGRAPHIC(3.9945181390182953, 0.20934382497177531, 0.039)}
/* Rays along no axis, which cross cells askew. */
#define ASKEW(id, x, y, z, picture_height) \
    {.name = id, .extra = true, \
     .camera = {.eye = {x, y, z}, .up = {0, 0, 1}, .height = picture_height, .near = 0.1, .far = 20}}
#define ASKEW_60 ASKEW("60-askew", -2.7665545602611914, -2.084748393715176, 2, 0.37)
#define ASKEW_87 ASKEW("87-askew", -3.190164031348039, -2.4039610263145725, 0.20934382497177531, 0.039)
#define NEAR(x, y, z) \
    {.name = "near", .camera = {.eye = {x, y, z}, .up = {0, 1, 0}, .fov_y_degrees = 45, .near = 0.01, .far = 10}}

/* ---- The scenes ---- */

#define SCENE(sample_count, ...) \
    .unload = relief_unload, .draw = relief_draw, .truth = relief_truth, .texels = relief_texels, \
    .measure = relief_measure, .background = {0.02, 0.02, 0.02}, .samples = sample_count, \
    .facts = {{"polygon_width", 1, "world units, around the origin in the plane z = 0"}, \
              {"base", 1, "height of the polygon, unless base_of_file says otherwise"}, \
              {"period", 1, "width: the bilinear relief repeats beyond the polygon, unless it is cut"}, __VA_ARGS__}
#define LIT \
    {"light_azimuth", 148, "degrees from +x toward +y, of a light infinitely far"}, \
    {"light_tangent", 1.2, "of its angle from the normal"}, \
    {"ambient", 0.2, "colour = texture (ambient + (1 - ambient) max(n.l, 0), or 0 for that in shadow)"}, \
    {"normal_span", 1, "texel: n is the unit normal of the bilinear patch that the point lies in"}
#define CUT {"extent", 1, "width: the relief ends with the polygon, whose base is 1 whatever the file says"}
#define ANGLES .views = {VIEW_30(0.64), VIEW_60(0.37), VIEW_80, VIEW_87, ASKEW_60, ASKEW_87}
/* clang-format on */

static const Lesson lesson = {
    .name = "15-relief",
    .title = "relief mapping: rays searched through a height field, and what the search misses",
    .width = 320,
    .height = 240,
    .scenes = {
        {"brick", "a brick wall, its bricks' faces in the polygon", .techniques = {MARCHES}, ANGLES,
         .colour = "brick-256-colour.png", .height = "brick-256-height.png", .load = relief_load,
         SCENE(18, {0})},
        {"terrain", "a real mountain, Levi in Finland, one and a half times as steep as it is",
         .techniques = {MARCHES}, ANGLES, .colour = "terrain-relief.png", .height = "terrain-relief.png",
         .load = relief_load, SCENE(8, {0})},
        {"pins", "a hostile map: a pin of one texel in each 8 x 8, on flat ground",
         .techniques = {FEWER_MARCHES}, ANGLES, .colour = "uv-grid.png", .height = "pins-height.png",
         .load = relief_load, SCENE(8, {0})},
        {"shadow", "the wall in the light of a lamp far to the upper left, and in its own shadow",
         .techniques = {{TECHNIQUE("parallax", "lit-parallax", "one height, lit, no shadow")},
                        {TECHNIQUE("relief", "lit-relief", "lit, no shadow"), STEPS(32)},
                        {TECHNIQUE("relief-shadow", "lit-relief", "a second ray, to the light"),
                         STEPS(32, 128), .variant = SHADOWED},
                        {TECHNIQUE("maximum-shadow", "lit-maximum", "the same, both rays exact"),
                         .variant = SHADOWED}},
         .views = {VIEW_30(0.64), VIEW_60(0.37), NEAR(0.3, -0.5, 0.6)}, .colour = "brick-256-colour.png",
         .height = "brick-256-height.png", .load = relief_load_lit, .move = relief_move, SCENE(18, LIT)},
        {"silhouette", "the wall's relief ends with the polygon",
         .techniques = {{TECHNIQUE("parallax", "parallax", "one height; the polygon's straight edges")},
                        {TECHNIQUE("relief", "relief", "the polygon's straight edges"), STEPS(32)},
                        {TECHNIQUE("relief-cut", "cut-relief", "rays that leave are discarded"),
                         STEPS(32, 128)},
                        {TECHNIQUE("maximum-cut", "cut-maximum", "the same, by the exact search")}},
         .views = {VIEW_30(1.1), VIEW_60(1.1), NEAR(0.7, -0.8, 0.5)}, .colour = "brick-256-colour.png",
         .height = "brick-256-height.png", .load = relief_load_cut, SCENE(18, CUT)},
    }};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
