/* Light fields, compressed so that any texel can be read at once.
 *
 * What to look for: almost nothing, and that is the point. The same seven solids in their ball, from `raw`
 * texels, 24 bits each, and from `ramp`, at one twentieth and less. Go through the knob of `ramp` with [ and
 * ]: edges get jagged, then fall to pieces, blocks of 8 x 8 x 2 x 2 texels; `vq` goes soft and spotty
 * instead; `block` at 4 bits shows bands of colour. With D, the error as a heat map: it is all at edges, and
 * much of it is there with `raw` too, for texels are far apart. Then the table: at how many bits a texel a
 * codec is how good, and what its reading costs. */
#include "exhibit.h"

/* clang-format off */

/* ---- The techniques ---- */

#define SHOWING(name, shader, reads, what) name, what, "everywhere.vert", shader ".frag", .variant = reads

#define RAW {SHOWING("raw", "raw", EXHIBIT_RAW, "the texels themselves, 24 bits each")}
#define BLOCK(...) {SHOWING("block", "block", EXHIBIT_BLOCK, "the GPU's own block compression: BC1 at 4 bits a texel, BC7 at 8"), \
                    .knob = {"bits", {__VA_ARGS__}}}
#define VQ(...) {SHOWING("vq", "vq", EXHIBIT_VQ, "vector quantization: a codebook of 2^knob patches of 4 x 4 texels"), \
                 .knob = {"codebook", {__VA_ARGS__}}}
#define RAMP(...) {SHOWING("ramp", "ramp", EXHIBIT_RAMP, "leaves of two colours and a ramp between them, in four dimensions"), \
                   .knob = {"tolerance", {__VA_ARGS__}}}

/* ---- The views: lesson 18's ---- */

#define AT(x, y, z, up_y, up_z, fov) \
    {.eye = {x, y, z}, .up = {0, up_y, up_z}, .fov_y_degrees = fov, .near = 0.01, .far = 100}
#define FRONT {.name = "front", .camera = AT(0, 0, 9, 1, 0, 46)}
#define ASIDE {.name = "aside", .camera = AT(6, 3, 6, 1, 0, 46)}
#define POLE {.name = "pole", .camera = AT(0, 9, 0, 0, -1, 46)}
#define TOUCHING {.name = "touching", .camera = AT(1.2, 1.5, 3, 1, 0, 70)}

#define EXHIBIT .colour = "", .list = exhibit_list, .load = exhibit_load, .unload = exhibit_unload, \
    .draw = exhibit_draw, .truth = exhibit_truth, .measure = exhibit_measure, .samples = 18

static const Lesson lesson = {
    .name = "19-light-field-compression",
    .title = "light fields compressed, with every texel a few fetches away",
    .scenes = {
        {"composed", "seven solids in a sphere: 256 x 128 x 32 x 32 texels", EXHIBIT,
         .techniques = {RAW, BLOCK(4, 8), VQ(8, 12, 14), RAMP(2, 4, 6, 8, 16, 32)},
         .views = {FRONT, ASIDE, POLE, TOUCHING}},
        {"fine", "the same, more finely by place: 512 x 256 x 32 x 32", EXHIBIT,
         .techniques = {RAW, BLOCK(4), RAMP(4, 8, 16)}, .views = {FRONT}},
        {"even", "the same, more finely by direction: 128 x 64 x 64 x 64", EXHIBIT,
         .techniques = {RAW, BLOCK(4), VQ(12), RAMP(4, 8, 16)}, .views = {FRONT}},
    }};
/* clang-format on */

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
