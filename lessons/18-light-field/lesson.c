/* Light-field textures: for each point of a simple model, the light that leaves it in each direction.
 *
 * What to look for: there is only a ball, yet in `composed` seven solids stand in it, hide each other, and
 * move against each other as the eye moves. With `trilinear`, one picture on the ball, they are painted on
 * it. With `nearest` they fall into pieces, a piece a texel; `paper` mixes sixteen texels, and every edge is
 * as soft as the angles between texels are wide. `depth-corrected` knows roughly how deep things lie, and is
 * sharper. Then the table: what softness costs in bytes (`figure-7`), what costs a light field nothing
 * (`effects`), and where it must be wrong (`placements`, from between a ball and the model). */
#include "globe.h"

/* clang-format off */

/* ---- The techniques: a fragment shader each, and the light field that it reads ---- */

#define READING(name, shader, reads, what) name, what, "everywhere.vert", shader ".frag", .variant = reads

#define TRILINEAR {READING("trilinear", "trilinear", READS_USUAL_PAGED, "one picture on the model, through a mipmap")}
#define FRAMES {READING("frames", "frames", READS_NOTHING, "the four frames and no texel: where the time goes")}
#define NEAREST {READING("nearest", "nearest", READS_USUAL, "the nearest texel of all four axes")}
#define SHARED {READING("shared", "shared", READS_USUAL, "sixteen taps, the point's own angles for all four neighbours")}
#define PAPER {READING("paper", "paper", READS_USUAL, "sixteen taps, each neighbour with the angles in its own frame")}
#define PAPER_PAGES {READING("paper-pages", "paper-pages", READS_USUAL_PAGED, "as paper, from up to four textures: for large light fields")}
#define PAPER_FAST {READING("paper-fast", "paper-fast", READS_USUAL, "the same from four filtered fetches")}
#define SINE {READING("sine", "sine", READS_SINE, "as paper, s and t being sines of the angles")}
#define STEREOGRAPHIC \
    {READING("stereographic", "stereographic", READS_STEREOGRAPHIC, "as paper, s and t being tangents of half the angles")}
#define DEPTH_MEAN {READING("depth-mean", "depth-mean", READS_USUAL, "as paper, corrected by one depth for all")}
#define DEPTH_CORRECTED \
    {READING("depth-corrected", "depth-corrected", READS_USUAL, "as paper, corrected by a coarse depth")}
#define DIRECT {READING("direct", "direct", READS_NOTHING, "the solids themselves, by rays")}
#define MARKED {READING("marked", "marked", READS_USUAL, "as paper, and in magenta what comes from behind the eye")}
#define SAMPLED(...) {READING("paper", "paper", READS_USUAL, "sixteen taps of texels made by so many rays each"), \
                      .knob = {"samples", {__VA_ARGS__}}}

/* ---- The views ---- */

#define AT(x, y, z, up_y, up_z, fov) \
    {.eye = {x, y, z}, .up = {0, up_y, up_z}, .fov_y_degrees = fov, .near = 0.01, .far = 100}
#define FRONT {.name = "front", .camera = AT(0, 0, 9, 1, 0, 46)}
#define ASIDE {.name = "aside", .camera = AT(6, 3, 6, 1, 0, 46)}
#define POLE {.name = "pole", .camera = AT(0, 9, 0, 0, -1, 46)}
#define BACK(...) {.name = "back", .camera = AT(-2.5, -1, -8.5, 1, 0, 46), __VA_ARGS__} /* the seam of u */
#define TOUCHING {.name = "touching", .camera = AT(1.2, 1.5, 3, 1, 0, 70)}

#define GLOBE .list = globe_list, .load = globe_load, .unload = globe_unload, .draw = globe_draw, .truth = globe_truth, .measure = globe_measure, .samples = 18

#define FROM_FILE .colour = "" /* --colour FILE: a light field from `make light-field` */

static const Lesson lesson = {
    .name = "18-light-field",
    .title = "light-field textures: the light that leaves a model, by place and by direction",
    .scenes = {
        {"composed", "seven solids in a sphere", GLOBE, FROM_FILE,
         .techniques = {TRILINEAR, FRAMES, NEAREST, SHARED, PAPER, PAPER_FAST, SINE, STEREOGRAPHIC, DEPTH_MEAN,
                        DEPTH_CORRECTED, DIRECT, PAPER_PAGES},
         .views = {FRONT, ASIDE, POLE, TOUCHING, BACK(.extra = true)}, .path = {AT(0, 0, 9, 1, 0, 46), AT(0.6, 0.3, 9, 1, 0, 46)}},
        {"effects", "the same with shadows, a mirroring ball and a clear box", GLOBE, FROM_FILE,
         .techniques = {{READING("plain-light", "paper", READS_PLAIN_LIGHT, "a light field without them")},
                        PAPER, DEPTH_CORRECTED},
         .views = {FRONT, ASIDE}},
        {"aliasing", "one cylinder, on the viewer's side of the sphere or on the far one", GLOBE, FROM_FILE,
         .techniques = {TRILINEAR, SAMPLED(1, 7, 49), PAPER_PAGES},
         .views = {{.name = "near", .camera = AT(0, 0, 9, 1, 0, 46)}, {.name = "far", .camera = AT(0, 0, -9, 1, 0, 46)}},
         .path = {AT(0, 0, -9, 1, 0, 46), AT(0.6, 0.3, -9, 1, 0, 46)}},
        {"figure-7", "the composed scene as light fields of several sizes", GLOBE,
         .techniques = {DIRECT,
                        {READING("64x32x256x256", "paper", READS_64_32_256_256, "few places, many directions")},
                        {READING("64x32x256x256-corrected", "depth-corrected", READS_64_32_256_256, "the same, corrected by a coarse depth")},
                        {READING("512x256x32x32", "paper", READS_512_256_32_32, "many places, few directions")},
                        {READING("512x256x64x64", "paper-pages", READS_512_256_64_64, "four times as many directions")}},
         .views = {FRONT, ASIDE, POLE}},
        {"placements", "balls behind the model, across it and in front of it", GLOBE, FROM_FILE,
         .techniques = {TRILINEAR, SHARED, PAPER, MARKED, DIRECT},
         .views = {{.name = "outside", .camera = AT(1.5, 1, 12, 1, 0, 36)},
                   {.name = "between", .camera = {.eye = {1.835, 0, 3.21}, .target = {-1.4, 0, 0.5}, .up = {0, 1, 0},
                                                  .fov_y_degrees = 80, .near = 0.01, .far = 100}}}},
        {"cylinder", "the composed scene on the side of a cylinder", GLOBE, FROM_FILE,
         .techniques = {TRILINEAR, PAPER, PAPER_FAST}, .views = {FRONT, BACK()}},
        {"panorama", "an observer inside, solids outside", GLOBE, FROM_FILE,
         .techniques = {TRILINEAR, PAPER, PAPER_FAST, DIRECT},
         .views = {{.name = "centre", .camera = {.target = {0, 0, 1}, .up = {0, 1, 0}, .fov_y_degrees = 90, .near = 0.01, .far = 100}},
                   {.name = "aside", .camera = {.eye = {1.5, 0.5, -1}, .target = {-2, 0, 2}, .up = {0, 1, 0}, .fov_y_degrees = 90,
                                                .near = 0.01, .far = 100}}}},
    }};
/* clang-format on */

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
