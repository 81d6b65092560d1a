/* terrain DIR: makes a relief texture of a real mountain, with its heights in metres.
 *
 * Reads DIR/topography.png, the fell Levi in Finland: each pixel a height in metres, packed in its three
 * bytes as (65536 red + 256 green + blue) / 11983, the pixels 20 metres apart. Writes DIR/terrain-relief.png.
 *
 * A crop is taken, not a shrunk whole, so that each texel's height is one of the file's. Mountains are
 * flatter than they look: the relief is drawn EXAGGERATED times deeper than it is, and says so by the length
 * of f, so that a height in metres is still origin.z + scale |a| (h - base) / |f|. A mountain does not tile:
 * where the texture repeats there is a cliff, as high as the program prints. */
#include "fail.h"
#include "image.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 256, LEFT = 40, TOP = 60 }; /* the crop, in pixels; its rim is where repeating hurts least */

static const double packing = 11983; /* of the file, as the program that it comes with says */
static const double pixel_metres = 20, exaggerated = 1.5;

/* The heights in metres of a crop of the file. */
static Image read_metres(const char *path) {
    Image file = image_load(path, IMAGE_RAW), metres = image_create(SIDE, SIDE, 1);
    if (file.channels < 3 || file.bits != 8 || file.width < LEFT + SIDE || file.height < TOP + SIDE)
        fail("%s: not three bytes a pixel, or smaller than %d x %d pixels", path, LEFT + SIDE, TOP + SIDE);
    int bottom = file.height - TOP - SIDE;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const float *byte = image_at(&file, LEFT + x, bottom + y);
            double packed = 65536 * round(byte[0] * 255) + 256 * round(byte[1] * 255) + round(byte[2] * 255);
            *image_at(&metres, x, y) = (float)(packed / packing);
        }
    metres.basis = (Basis){.origin = v3(LEFT * pixel_metres, bottom * pixel_metres, NAN),
                           .a = v3(SIDE * pixel_metres, 0, 0),
                           .b = v3(0, SIDE * pixel_metres, 0),
                           .f = v3(0, 0, exaggerated),
                           .unit = "m"};
    image_destroy(&file);
    return metres;
}

/* ---- Colour: what grows there ---- */

/* The height in metres of a texel; beyond the rim, of the nearest one on it. */
static double metres_at(const Image *metres, int x, int y) {
    int column = x < 0 ? 0 : x < SIDE ? x : SIDE - 1, row = y < 0 ? 0 : y < SIDE ? y : SIDE - 1;
    return *image_at(metres, column, row);
}

static double smoothstep(double low, double high, double x) {
    double t = clamp((x - low) / (high - low), 0, 1);
    return t * t * (3 - 2 * t);
}

/* A colour for each height, in metres, blended between. */
static Vec3 tint(double height) {
    static const struct {
        double from;
        Vec3 colour;
    } belts[] = {{180, {0.16, 0.17, 0.06}},  /* bog */
                 {215, {0.05, 0.12, 0.04}},  /* spruce */
                 {320, {0.09, 0.16, 0.05}},  /* birch */
                 {380, {0.27, 0.19, 0.08}},  /* heath */
                 {450, {0.40, 0.33, 0.25}},  /* scree */
                 {530, {0.78, 0.76, 0.74}}}; /* snow */
    enum { BELTS = sizeof belts / sizeof *belts };
    int i = 0;
    while (i < BELTS - 2 && height >= belts[i + 1].from) i++;
    double way = clamp((height - belts[i].from) / (belts[i + 1].from - belts[i].from), 0, 1);
    return vec3_mix(belts[i].colour, belts[i + 1].colour, way);
}

/* Steep ground is bare; hollows are dark and ridges light; still water is blue; every CONTOUR metres there is
 * a line. No light falls on it: that is for those who show it. */
static Vec3 ground(const Image *metres, int x, int y) {
    enum { CONTOUR = 25 };
    double here = metres_at(metres, x, y);
    double east = metres_at(metres, x + 1, y), west = metres_at(metres, x - 1, y);
    double north = metres_at(metres, x, y + 1), south = metres_at(metres, x, y - 1);
    double slope = hypot(east - west, north - south) / (2 * pixel_metres);
    double ridge = (4 * here - east - west - north - south) / pixel_metres; /* negative in a hollow */
    Vec3 colour = vec3_mix(tint(here), v3(0.30, 0.26, 0.23), smoothstep(0.2, 0.5, slope));
    colour = vec3_scale(colour, 1 + clamp(3 * ridge, -0.5, 0.8));
    if (slope < 1e-4) colour = v3(0.03, 0.10, 0.19);
    double level = floor(here / CONTOUR);
    bool line = level > floor(west / CONTOUR) || level > floor(east / CONTOUR) ||
                level > floor(north / CONTOUR) || level > floor(south / CONTOUR);
    return line ? vec3_scale(colour, 0.45) : colour;
}

static Image paint_ground(const Image *metres) {
    Image image = image_create(SIDE, SIDE, 3);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            Vec3 c = ground(metres, x, y);
            float *texel = image_at(&image, x, y);
            texel[0] = (float)c.x, texel[1] = (float)c.y, texel[2] = (float)c.z;
        }
    return image;
}

/* ---- Height ---- */

/* Metres become heights in 0..1; scale, base and the basis say which. */
static void make_heights(Image *image, double low, double high) {
    for (int i = 0; i < SIDE * SIDE; i++) {
        float *h = &image->pixels[i];
        *h = (float)((*h - low) / (high - low));
    }
    image->scale = exaggerated * (high - low) / vec3_length(image->basis.a);
    image->base = 1;
    image->basis.origin.z = high;
}

/* The steps from the last column to the first, and from the last row to the first. */
static void print_seam(const Image *metres) {
    double sum = 0, highest = 0;
    for (int i = 0; i < SIDE; i++) {
        double across = fabs(metres_at(metres, SIDE - 1, i) - metres_at(metres, 0, i));
        double along = fabs(metres_at(metres, i, SIDE - 1) - metres_at(metres, i, 0));
        sum += across + along;
        highest = fmax(highest, fmax(across, along));
    }
    printf("  where it repeats: a cliff of %.1f m in the mean, %.1f m at its highest\n", sum / (2 * SIDE),
           highest);
}

int main(int count, char **arguments) {
    if (count != 2 || arguments[1][0] == '-') fail_usage("usage: terrain DIR");
    char *from = text("%s/topography.png", arguments[1]), *to = text("%s/terrain-relief.png", arguments[1]);
    Image heights = read_metres(from), colour = paint_ground(&heights);
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < SIDE * SIDE; i++)
        low = fmin(low, heights.pixels[i]), high = fmax(high, heights.pixels[i]);
    if (!(low < high)) fail("%s: every height is the same: no relief", from);

    printf("terrain: %d x %d texels of %g m; heights %.2f to %.2f m\n", SIDE, SIDE, pixel_metres, low, high);
    print_seam(&heights);
    make_heights(&heights, low, high);
    printf("  scale %.5f of a width, %g times the true one; base 1\n", heights.scale, exaggerated);
    const char *reason = image_write_relief(&colour, &heights, to, 16);
    if (reason) fail("%s: %s", to, reason);
    image_destroy(&heights), image_destroy(&colour);
    free(from), free(to);
    return 0;
}
