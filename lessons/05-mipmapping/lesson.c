/* Mipmapping: how much of a texture one pixel sees, and how to read that much at once.
 *
 * What to look for: look toward the horizon of `floor`. With `nearest` and `bilinear` the far checks boil,
 * for a pixel that covers a hundred texels reads one or four. A chain of halved images turns them into even
 * grey, at the price of blur: first along the view, where footprints are long and thin. `mip-nearest` shows
 * where one level ends, `trilinear-srgb` how grey turns dark when the means are taken of the wrong numbers.
 * Then `table-4096`: a summed-area table read one texel wide, as floats hold it and as they should. */
#include "plane.h"

/* ---- The techniques: a fragment shader each, and what C made of the image for it ---- */

/* clang-format off */
#define READING(name, shader, reads, what) name, what, "everywhere.vert", shader ".frag", .variant = reads

#define NEAREST {READING("nearest", "nearest", READS_BASE, "the texel under the pixel's centre")}
#define BILINEAR {READING("bilinear", "bilinear", READS_BASE, "the four texels around the pixel's centre")}
#define MIP_NEAREST {READING("mip-nearest", "mip-nearest", READS_BOX, "one level of the box chain")}
#define TRILINEAR {READING("trilinear", "trilinear", READS_BOX, "two levels of the box chain, mixed")}
#define TRILINEAR_SRGB \
    {READING("trilinear-srgb", "trilinear", READS_SRGB_BOX, "the mistake: a box chain of sRGB numbers")}
#define TRILINEAR_KAISER {READING("trilinear-kaiser", "trilinear", READS_KAISER, "a Kaiser-windowed sinc's chain")}
#define OPENGL {READING("opengl", "opengl", READS_OPENGL, "glGenerateMipmap's chain at the driver's own level")}
#define SUMMED_AREA {READING("summed-area", "summed-area", READS_TABLE, "the mean over the footprint's bounding box")}
#define SUMMED_AREA_NAIVE \
    {READING("summed-area-naive", "summed-area", READS_NAIVE_TABLE, "the same from a table rounded to floats")}
#define AREA(...) \
    {READING("area", "area", READS_BASE, "n x n bilinear taps over the footprint"), .knob = {"taps", {__VA_ARGS__}}}

/* ---- The views. The plane is z = 0 and a repeat is one unit wide; on a floor, z is up ---- */

#define FLOOR(x, y, z, tx, ty, tz, fov) \
    {.eye = {x, y, z}, .target = {tx, ty, tz}, .up = {0, 0, 1}, .fov_y_degrees = fov, .near = 0.01, .far = 1000}
#define HORIZON(y) FLOOR(0.07, y, 0.12, 0.3, 1 + (y), 0.02126, 60)
#define WALL(x, y, distance) \
    {.eye = {x, y, distance}, .target = {x, y, 0}, .up = {0, 1, 0}, .fov_y_degrees = 60, .near = 0.01, .far = 1000}

#define PLANE \
    .unload = plane_unload, .draw = plane_draw, .truth = plane_truth, .texels = plane_texels, \
    .measure = plane_measure, .background = {0.05, 0.1, 0.2}, \
    .facts = {{"repeat_width", 1, "world units: the plane is z = 0, tiled without end"}, \
              {"u_at_origin", 0.5, "u = x + 0.5"}, {"v_at_origin", 0.5, "v = y / (height / width) + 0.5"}}
/* clang-format on */

static const Lesson lesson = {
    .name = "05-mipmapping",
    .title = "mipmaps and their kin: reading as much of a texture as a pixel sees",
    .scenes = {
        {"floor", "a checkerboard floor to the horizon",
         .techniques = {NEAREST, BILINEAR, MIP_NEAREST, TRILINEAR, TRILINEAR_SRGB, TRILINEAR_KAISER,
                        SUMMED_AREA, AREA(1, 2, 4, 16), OPENGL},
         .views = {{.name = "horizon", .camera = HORIZON(0)},
                   {.name = "minified", .camera = FLOOR(0.07, 0, 8, 1, 8, 0, 40)}},
         .path = {HORIZON(0), HORIZON(0.06)}, .colour = "checker.png", .load = plane_load, .gaussian = true,
         .samples = 72, PLANE},
        {"grey", "the same floor from so high that every check is smaller than a pixel",
         .techniques = {NEAREST, TRILINEAR, TRILINEAR_SRGB},
         .views = {{.name = "minified", .camera = FLOOR(0.07, 0, 200, 25, 200, 0, 40)}},
         .colour = "checker.png", .load = plane_load, .samples = 32, PLANE},
        {"zone", "a zone plate: rings of every frequency up to the finest that texels can hold",
         .techniques = {NEAREST, BILINEAR, MIP_NEAREST, TRILINEAR, TRILINEAR_KAISER, SUMMED_AREA,
                        AREA(2, 4, 16), OPENGL},
         .views = {{.name = "minified", .camera = WALL(0.11, 0.07, 2)}}, .colour = "zone-plate.png",
         .load = plane_load, .gaussian = true, .samples = 72, PLANE},
        {"photo", "a photo whose sides are no powers of two, or your own image",
         .techniques = {NEAREST, BILINEAR, MIP_NEAREST, TRILINEAR, TRILINEAR_SRGB, TRILINEAR_KAISER,
                        SUMMED_AREA, AREA(2, 4, 16), OPENGL},
         .views = {{.name = "minified", .camera = WALL(0.11, 0.07, 2)}}, .colour = "chelsea.png",
         .load = plane_load, .gaussian = true, .samples = 32, PLANE},
        {"table-1024",
         "1024 x 1024 texels, magnified: what one texel of 1e5 far away does to a summed-area table",
         .techniques = {NEAREST, BILINEAR, SUMMED_AREA, SUMMED_AREA_NAIVE},
         .views = {{.name = "magnified", .camera = WALL(0.4, 0.36, 0.1)}}, .colour = "astronaut.png",
         .load = plane_load_1024, .samples = 8, PLANE},
        {"table-4096", "the same with 4096 x 4096",
         .techniques = {NEAREST, BILINEAR, SUMMED_AREA, SUMMED_AREA_NAIVE},
         .views = {{.name = "magnified", .camera = WALL(0.475, 0.465, 0.025)}}, .colour = "astronaut.png",
         .load = plane_load_4096, .samples = 8, PLANE},
    }};

int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
