/* generate DIR: draws the textures that need no photograph, the same bytes on every run.
 *
 * Look at three things in the pictures. The checker and the zone plate average to one half in linear light,
 * so a filter that leaves another mean is wrong. The letters of the UV grid grow with u and its digits
 * with v, so a mirrored or upside-down picture cannot be read. The bricks' heights change as fast as their
 * edges are steep, and the program prints how fast: parallax mapping stands or falls with that number.
 *
 * Each pattern is a function of (u, v), taken at the centres of the texels. All of them tile. */
#include "fail.h"
#include "image.h"
#include "vec.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef Vec3 (*Colour)(double u, double v);
typedef double (*Height)(double u, double v);

/* ---- Patterns with a formula ---- */

enum { CHECKS = 8, ZONE_TEXELS = 512 };

/* 8 by 8 checks of linear 0 and 1; the check at (0, 0) is white. */
static Vec3 checker(double u, double v) {
    int odd = ((int)floor(u * CHECKS) + (int)floor(v * CHECKS)) & 1;
    return odd ? v3(0, 0, 0) : v3(1, 1, 1);
}

/* cos(pi N r^2) with r from the centre in widths. Its frequency along u is |u - 1/2| cycles a texel: at the
 * edge one half, which is all that N texels can hold. */
static Vec3 zone_plate(double u, double v) {
    double x = u - 0.5, y = v - 0.5;
    double light = 0.5 + 0.5 * cos(PI * ZONE_TEXELS * (x * x + y * y));
    return v3(light, light, light);
}

/* ---- The UV grid ---- */

enum { GRID_TEXELS = 512, CELLS = 8, CELL = GRID_TEXELS / CELLS, EDGE = 4, PEN = 5 };

/* Letters of 3 by 5: an octal digit a row, the top row first. */
static const unsigned letters[CELLS] = {025755, 065656, 034443, 065556, 074647, 074644, 034553, 055755};
static const unsigned digits[CELLS] = {026227, 071747, 071317, 055711, 074717, 074757, 071111, 075757};

/* Is the point (x, y) of a cell, in texels from its lower left corner, on the cell's label? */
static bool on_label(int x, int y, int column, int row) {
    int left = (CELL - 7 * PEN) / 2, bottom = (CELL - 5 * PEN) / 2; /* a letter, a gap and a digit */
    if (x < left || y < bottom) return false;
    int across = (x - left) / PEN, up = (y - bottom) / PEN;
    if (across >= 7 || across == 3 || up >= 5) return false;
    unsigned glyph = across < 3 ? letters[column] : digits[row];
    return glyph >> (3 * up + 2 - across % 4) & 1;
}

/* u in red, v in green, both linear; cells of two blues. Letters A..H grow with u, digits 1..8 with v. The
 * edge v = 0 is white, the edge u = 0 black. */
static Vec3 uv_grid(double u, double v) {
    int x = (int)(u * GRID_TEXELS), y = (int)(v * GRID_TEXELS);
    int column = x / CELL, row = y / CELL, cell_x = x % CELL, cell_y = y % CELL;
    Vec3 black = v3(0, 0, 0), white = v3(1, 1, 1);
    if (y < EDGE) return white;
    if (x < EDGE) return black;
    if (cell_x < 1 || cell_x >= CELL - 1 || cell_y < 1 || cell_y >= CELL - 1) return black;
    if (on_label(cell_x, cell_y, column, row)) return column + 3 * row < 6 ? white : black;
    return v3(u, v, (column + row) % 2 ? 0.5 : 0.1);
}

/* ---- The brick wall ---- */

enum { COURSES = 8, BRICKS = 3 }; /* COURSES is even, or the running bond would not tile */

static const double joint = 0.012;             /* between two bricks; lengths are in texture widths */
static const double bevel = 0.026;             /* from a brick's edge in to where its face is flat */
static const double uneven = 0.006;            /* how far an edge strays from straight */
static const double mortar = 0.2, face = 0.88; /* heights */

static double mix(double a, double b, double t) { return a + (b - a) * t; }

static double smoothstep(double low, double high, double x) {
    double t = clamp((x - low) / (high - low), 0, 1);
    return t * t * (3 - 2 * t);
}

/* A number in 0..1 that looks random but depends on its arguments alone. */
static double hash(int x, int y, int seed) {
    uint32_t h = (uint32_t)x * 0x8da6b343u ^ (uint32_t)y * 0xd8163841u ^ (uint32_t)seed * 0xcb1ab31fu;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return (h ^ h >> 16) / 4294967296.0;
}

/* Value noise in -1..1: random values on a lattice of cells by cells that repeats, smooth in between. */
static double value_noise(double u, double v, int cells, int seed) {
    double x = u * cells, y = v * cells;
    int left = (int)floor(x), bottom = (int)floor(y);
    int x0 = left % cells, x1 = (left + 1) % cells, y0 = bottom % cells, y1 = (bottom + 1) % cells;
    double s = smoothstep(0, 1, x - left), t = smoothstep(0, 1, y - bottom);
    double low = mix(hash(x0, y0, seed), hash(x1, y0, seed), s);
    double high = mix(hash(x0, y1, seed), hash(x1, y1, seed), s);
    return 2 * mix(low, high, t) - 1;
}

/* Three octaves of it, each twice as fine and half as strong. */
static double noise(double u, double v, int cells, int seed) {
    return (4 * value_noise(u, v, cells, seed) + 2 * value_noise(u, v, 2 * cells, seed + 1) +
            value_noise(u, v, 4 * cells, seed + 2)) /
           7;
}

/* Where (u, v) lies in the wall. */
typedef struct {
    int column, course; /* the brick that it belongs to, with half of the joints around it */
    double x, y;        /* how far inside the brick's upright and level edges; negative in the mortar */
    double dome;        /* 1 in the middle of the brick's face, 0 at its edges */
} Place;

static Place place(double u, double v) {
    int course = (int)floor(v * COURSES);
    double along = u * BRICKS + (course % 2 ? 0.5 : 0.0);
    double x = (along - floor(along) - 0.5) / BRICKS, y = (v * COURSES - course - 0.5) / COURSES;
    double half_x = 0.5 / BRICKS - joint / 2, half_y = 0.5 / COURSES - joint / 2;
    return (Place){.column = (int)floor(along) % BRICKS,
                   .course = course,
                   .x = half_x - fabs(x) - uneven * (0.5 + noise(u, v, 12, 1)),
                   .y = half_y - fabs(y) - uneven * (0.5 + noise(u, v, 12, 5)),
                   .dome = fmax(1 - x * x / (half_x * half_x), 0) * fmax(1 - y * y / (half_y * half_y), 0)};
}

/* 0 in the mortar, 1 on the brick's face, smooth over `width` from its edges in; corners become round. */
static double brickness(Place p, double width) {
    return smoothstep(0, width, p.x) * smoothstep(0, width, p.y);
}

static double brick_height(double u, double v) {
    Place p = place(u, v);
    double sand = mortar + 0.05 * noise(u, v, 32, 10);
    double top =
        face + 0.06 * (hash(p.column, p.course, 20) - 0.5) + 0.05 * p.dome + 0.04 * noise(u, v, 24, 30);
    return mix(sand, top, brickness(p, bevel));
}

static Vec3 brick_colour(double u, double v) {
    Place p = place(u, v);
    Vec3 sand = vec3_scale(v3(0.40, 0.37, 0.32), 1 + 0.25 * noise(u, v, 32, 40));
    /* A brick is between red and burnt; its face is mottled, and speckled where it was hottest. */
    Vec3 red = v3(0.36, 0.10, 0.050), burnt = v3(0.16, 0.055, 0.040), pale = v3(0.46, 0.19, 0.10);
    double fire = hash(p.column, p.course, 50), chalk = hash(p.column, p.course, 60);
    Vec3 clay = vec3_mix(vec3_mix(red, burnt, 0.8 * fire * fire), pale, 0.5 * chalk * chalk);
    clay = vec3_scale(clay, 1 + 0.30 * noise(u, v, 10, 70) + 0.20 * noise(u, v, 32, 80));
    clay = vec3_scale(clay, 1 - 0.5 * smoothstep(0.35, 0.7, noise(u, v, 24, 90)));
    return vec3_mix(sand, clay, brickness(p, bevel / 3));
}

/* A gentle height, whose slope bounds a whole view: where the iterations of parallax mapping must converge.
 */
static double soft_height(double u, double v) {
    double x = 2 * PI * u, y = 2 * PI * v;
    return 0.5 + 0.20 * sin(x + 0.3) + 0.17 * sin(y + 1.1) + 0.10 * sin(2 * x - y + 2.3);
}

/* ---- Pins ---- */

enum { PIN_TEXELS = 256, PIN_BLOCK = 8 };

/* What no step along a ray may be trusted to find: one texel of height 1 in each block of texels, somewhere
 * in it but not in its first two columns and rows, so that between two pins there are always two texels of
 * height 0. */
static double pins(double u, double v) {
    int x = (int)(u * PIN_TEXELS), y = (int)(v * PIN_TEXELS);
    int column = x / PIN_BLOCK, row = y / PIN_BLOCK;
    int pin_x = 2 + (int)(hash(column, row, 100) * (PIN_BLOCK - 2));
    int pin_y = 2 + (int)(hash(column, row, 101) * (PIN_BLOCK - 2));
    return x % PIN_BLOCK == pin_x && y % PIN_BLOCK == pin_y;
}

/* ---- Files ---- */

static const double scale = 0.1, base = 1; /* displacement = scale (h - base), in texture widths */

static Image paint(int size, Colour colour) {
    Image image = image_create(size, size, 3);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            Vec3 c = colour((x + 0.5) / size, (y + 0.5) / size);
            float *texel = image_at(&image, x, y);
            texel[0] = (float)c.x, texel[1] = (float)c.y, texel[2] = (float)c.z;
        }
    return image;
}

/* Heights as the 16 bits of the file will hold them, so that what is measured is what is stored. */
static Image paint_height(int size, Height height) {
    Image image = image_create(size, size, 1);
    image.scale = scale, image.base = base;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            double h = clamp(height((x + 0.5) / size, (y + 0.5) / size), 0, 1);
            *image_at(&image, x, y) = (float)(round(h * 65535) / 65535);
        }
    return image;
}

/* The height of texel (x, y) of a map that repeats. */
static double height_at(const Image *map, int x, int y) {
    return *image_at(map, (x + map->width) % map->width, (y + map->height) % map->height);
}

/* Normals in tangent space, x = +u, y = +v, z out of the wall, from central differences: 0..1 stands for
 * -1..1, as in every normal map. */
static Image paint_normals(const Image *map) {
    int size = map->width;
    Image image = image_create(size, size, 3);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            double du = (height_at(map, x + 1, y) - height_at(map, x - 1, y)) * size / 2;
            double dv = (height_at(map, x, y + 1) - height_at(map, x, y - 1)) * size / 2;
            Vec3 n = vec3_normalize(v3(-scale * du, -scale * dv, 1));
            float *texel = image_at(&image, x, y);
            texel[0] = (float)(0.5 + 0.5 * n.x);
            texel[1] = (float)(0.5 + 0.5 * n.y);
            texel[2] = (float)(0.5 + 0.5 * n.z);
        }
    return image;
}

/* The steepest slope, max |grad d|, of the bilinear interpolation of a map that repeats, in widths per
 * width. In the patch between four texels each component is largest at an edge: the corners suffice. */
static double steepest(const Image *map) {
    double steepest = 0;
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            double a = height_at(map, x, y), b = height_at(map, x + 1, y);
            double c = height_at(map, x, y + 1), d = height_at(map, x + 1, y + 1);
            double du = fmax(fabs(b - a), fabs(d - c)), dv = fmax(fabs(c - a), fabs(d - b));
            steepest = fmax(steepest, sqrt(du * du + dv * dv));
        }
    return steepest * scale * map->width;
}

/* The mean of a channel; of colours, in linear light and as the bytes of the file hold them. */
static double mean(const Image *image, int channel, bool colour) {
    double sum = 0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            float value = image_at(image, x, y)[channel];
            sum += colour ? srgb_decode(srgb_byte(value) / 255.0) : value;
        }
    return sum / image->width / image->height;
}

/* Writes one picture and says what is in it. bits: 0 for colour (8-bit sRGB), else raw numbers of 8 or 16. */
static void save(const char *folder, const char *name, Image *image, int bits) {
    char *path = text("%s/%s", folder, name);
    const char *reason = bits ? image_write_raw(image, path, bits) : image_write(image, path);
    if (reason) fail("%s: %s", path, reason);
    printf("%-22s %4d x %-4d mean", name, image->width, image->height);
    for (int channel = 0; channel < image->channels; channel++)
        printf(" %.5f", mean(image, channel, bits == 0));
    if (image->channels == 1) printf(", steepest slope %.3f at scale %g", steepest(image), scale);
    putchar('\n');
    free(path);
}

static void draw(const char *folder, const char *name, int size, Colour colour) {
    Image image = paint(size, colour);
    save(folder, name, &image, 0);
    image_destroy(&image);
}

/* Colour, height and normals of the wall; the names begin with prefix. */
static void draw_bricks(const char *folder, const char *prefix, int size) {
    char *colour = text("%s-colour.png", prefix), *height = text("%s-height.png", prefix);
    char *normal = text("%s-normal.png", prefix);
    Image heights = paint_height(size, brick_height), normals = paint_normals(&heights);
    draw(folder, colour, size, brick_colour);
    save(folder, height, &heights, 16);
    save(folder, normal, &normals, 8);
    image_destroy(&heights), image_destroy(&normals);
    free(colour), free(height), free(normal);
}

int main(int count, char **arguments) {
    if (count != 2 || arguments[1][0] == '-') fail_usage("usage: generate DIR");
    const char *folder = arguments[1];
    draw(folder, "checker.png", 256, checker);
    draw(folder, "zone-plate.png", ZONE_TEXELS, zone_plate);
    draw(folder, "uv-grid.png", GRID_TEXELS, uv_grid);
    draw_bricks(folder, "brick", 128);
    draw_bricks(folder, "brick-256", 256);
    Image soft = paint_height(128, soft_height);
    save(folder, "soft-height.png", &soft, 16);
    image_destroy(&soft);
    Image pinned = paint_height(PIN_TEXELS, pins);
    save(folder, "pins-height.png", &pinned, 8);
    image_destroy(&pinned);
    return 0;
}
