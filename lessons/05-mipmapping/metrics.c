/* The lesson's own metrics:
 *
 * brightness              the mean of the picture over the mean of the exact one: what a filter does to light
 * off_trilinear_rms_255   how far a picture is from trilinear filtering of its own chain at the exact level,
 * off_trilinear_max_255   computed here in doubles: of `opengl` that is what the driver's level is off, of
 *                         `mip-nearest` what the mix of two levels would have changed; in 1/255
 * off_bilinear_max_255    how far a picture made of a summed-area table is from bilinear interpolation at the
 *                         pixel's centre, which is what it should be wherever the texture is magnified
 * level_error_max_255     the largest difference between any texel of glGenerateMipmap's chain and of our box
 *                         chain, floats, in 1/255
 * srgb8_level_error_max_255  the same for a texture of 8-bit sRGB, in codes */
#include "plane.h"

#include "context.h"

static double mean(const Image *image) {
    size_t count = (size_t)image->width * image->height * image->channels;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += image->pixels[i];
    return sum / (double)count;
}

/* ---- Trilinear filtering in doubles ---- */

static void sample_chain(const Chain *chain, double u, double v, double level, double *out) {
    int fine = (int)fmin(level, chain->count - 1), coarse = fine + 1 < chain->count ? fine + 1 : fine;
    double a[4], b[4];
    image_sample(&chain->levels[fine], u, v, a);
    image_sample(&chain->levels[coarse], u, v, b);
    for (int i = 0; i < chain->levels[0].channels; i++) out[i] = a[i] + (b[i] - a[i]) * (level - fine);
}

/* The squared length in texels of d(u, v)/dx, of (u w, v w, w) at a pixel and its derivatives. */
static double squared_side(const Image *base, Vec3 p, Vec3 derivative) {
    double du = (derivative.x - p.x / p.z * derivative.z) / p.z * base->width;
    double dv = (derivative.y - p.y / p.z * derivative.z) / p.z * base->height;
    return du * du + dv * dv;
}

static void add_off_trilinear(const Shots *shots, const Shot *shot, const Chain *chain, Table *table) {
    const Plane *plane = shots->frame->data;
    int width = shots->frame->width, height = shots->frame->height, channels = plane->image.channels;
    Homography h = plane_homography(plane, &shot->view->camera, width, height);
    double sum = 0.0, largest = 0.0, last = chain->count - 1;
    size_t count = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if (image_at(&shot->picture.lookup, x, y)[3] <= 0.5f) continue;
            Vec3 pixel = v3(x + 0.5, y + 0.5, 1.0);
            Vec3 p = v3(vec3_dot(h.u, pixel), vec3_dot(h.v, pixel), vec3_dot(h.w, pixel));
            double square = fmax(squared_side(&plane->image, p, v3(h.u.x, h.v.x, h.w.x)),
                                 squared_side(&plane->image, p, v3(h.u.y, h.v.y, h.w.y)));
            double exact[4];
            sample_chain(chain, p.x / p.z, p.y / p.z, clamp(0.5 * log2(square), 0.0, last), exact);
            for (int c = 0; c < 3; c++) {
                double off =
                    255.0 * (image_at(&shot->picture.colour, x, y)[c] - exact[channels == 3 ? c : 0]);
                sum += off * off;
                largest = fmax(largest, fabs(off));
                count++;
            }
        }
    if (!count) return;
    table_add(table, shots, shot->view, "off_trilinear_rms_255", sqrt(sum / (double)count), "1/255");
    table_add(table, shots, shot->view, "off_trilinear_max_255", largest, "1/255");
}

/* ---- A summed-area table read one texel wide ---- */

static void add_off_bilinear(const Shots *shots, const Shot *shot, Table *table) {
    double largest = 0.0;
    for (int i = 0; i < shots->frame->width * shots->frame->height; i++) {
        const Sample *centre = &shot->centres[i];
        const float *colour = shot->picture.colour.pixels + 3 * (size_t)i;
        if (!centre->hit || shot->picture.lookup.pixels[4 * (size_t)i + 3] <= 0.5f) continue;
        largest = fmax(largest, fabs(colour[0] - centre->colour.x));
        largest = fmax(largest, fabs(colour[1] - centre->colour.y));
        largest = fmax(largest, fabs(colour[2] - centre->colour.z));
    }
    table_add(table, shots, shot->view, "off_bilinear_max_255", 255.0 * largest, "1/255");
}

/* ---- OpenGL's chain against ours ---- */

static double encoded(float linear) { return srgb_byte(linear); }
static double in_255(float linear) { return 255.0 * linear; }
static double code(float stored) { return round(255.0 * stored); }

/* The largest difference at a level, between our numbers and theirs each taken to 1/255. */
static double level_error(const Image *ours, double (*ours_in)(float), const Image *theirs,
                          double (*theirs_in)(float)) {
    size_t count = (size_t)ours->width * ours->height * ours->channels;
    double largest = 0.0;
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, fabs(ours_in(ours->pixels[i]) - theirs_in(theirs->pixels[i])));
    return largest;
}

static void add_level_errors(const Shots *shots, Table *table) {
    Plane *plane = shots->frame->data;
    const Chain *ours = &plane_reading(plane, READS_BOX)->chain;
    const Chain *theirs = &plane_reading(plane, READS_OPENGL)->chain;
    double largest = 0.0;
    for (int k = 1; k < ours->count; k++) {
        double error = level_error(&ours->levels[k], in_255, &theirs->levels[k], in_255);
        table_point(table, shots, NULL, "opengl-level", "level", k, "largest difference (1/255)", error);
        largest = fmax(largest, error);
    }
    table_add(table, shots, NULL, "level_error_max_255", largest, "1/255");
    if (plane->image.bits != 8) return; /* what 8 bits cannot hold, they would clip */
    Texture texture = texture_create(&plane->image, 1, TEXTURE_SRGB8, TEXTURE_LINEAR);
    texture_mipmap(&texture);
    Chain codes = plane_download(&texture, &plane->image);
    largest = 0.0;
    for (int k = 1; k < ours->count; k++)
        largest = fmax(largest, level_error(&ours->levels[k], encoded, &codes.levels[k], code));
    table_add(table, shots, NULL, "srgb8_level_error_max_255", largest, "1/255");
    chain_destroy(&codes);
    texture_destroy(&texture);
}

void plane_measure(const Shots *shots, Table *table) {
    Reads reads = shots->frame->technique->variant;
    const Reading *reading = plane_reading(shots->frame->data, reads);
    bool sums = reads == READS_TABLE || reads == READS_NAIVE_TABLE;
    if (reads == READS_OPENGL) add_level_errors(shots, table);
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        double exact = mean(shot_exact(shot));
        if (exact > 0.0) /* a black image has no brightness to keep */
            table_add(table, shots, shot->view, "brightness", mean(&shot->picture.colour) / exact, "1");
        if (sums) add_off_bilinear(shots, shot, table);
        if (reading->chain.count > 1) add_off_trilinear(shots, shot, &reading->chain, table);
    }
}
