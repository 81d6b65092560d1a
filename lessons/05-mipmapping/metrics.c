/* The lesson's own metrics.
 *
 * brightness: the mean of the picture over that of the exact one, 1 for a filter that keeps the light.
 *
 * off_trilinear_rms_255, _max_255: how far a picture is from trilinear filtering of its own chain at the
 * exact level, which is computed here in doubles. For `opengl` that is what the driver's level does, for
 * `mip-nearest` what it does to mix no levels. In 1/255, as all below.
 *
 * off_bilinear_max_255: how far a picture of a summed-area table is from bilinear interpolation at the
 * pixel's centre, over the pixels whose box is one texel large: there both are the same.
 *
 * level_error_max_255: the largest difference between any texel of glGenerateMipmap's chain and of our box
 * chain, in floats; srgb8_level_error_max_255: the same in codes of 8-bit sRGB. */
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

/* The picture's difference from exact numbers, all channels. */
typedef struct {
    double sum, largest;
    size_t count;
} Difference255;

static void add_difference(Difference255 *difference, const float *colour, const double *exact,
                           int channels) {
    for (int c = 0; c < 3; c++) {
        double off = 255.0 * (colour[c] - exact[channels == 3 ? c : 0]);
        difference->sum += off * off;
        difference->largest = fmax(difference->largest, fabs(off));
        difference->count++;
    }
}

/* What a pixel sees: u, v, and how many texels they move along x and y of the picture. */
typedef struct {
    double u, v;
    Vec2 dx, dy;
} Texels;

static Texels texels_at(const Plane *plane, const Homography *h, int x, int y) {
    Vec3 pixel = v3(x + 0.5, y + 0.5, 1.0);
    double w = vec3_dot(h->w, pixel), u = vec3_dot(h->u, pixel) / w, v = vec3_dot(h->v, pixel) / w;
    double width = plane->image.width / w, height = plane->image.height / w;
    return (Texels){u, v, v2((h->u.x - u * h->w.x) * width, (h->v.x - v * h->w.x) * height),
                    v2((h->u.y - u * h->w.y) * width, (h->v.y - v * h->w.y) * height)};
}

/* The metrics of one picture that is made of a chain, or of a table (whose chain is the image alone). */
static void add_off(const Shots *shots, const Shot *shot, const Chain *chain, Table *table) {
    const Plane *plane = shots->frame->data;
    int width = shots->frame->width, height = shots->frame->height, channels = plane->image.channels;
    Homography h = plane_homography(plane, &shot->view->camera, width, height);
    Difference255 trilinear = {0}, bilinear = {0};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if (image_at(&shot->picture.lookup, x, y)[3] <= 0.5f) continue;
            Texels t = texels_at(plane, &h, x, y);
            double longer = fmax(hypot(t.dx.x, t.dx.y), hypot(t.dy.x, t.dy.y)), exact[4];
            sample_chain(chain, t.u, t.v, clamp(log2(longer), 0.0, chain->count - 1.0), exact);
            const float *colour = image_at(&shot->picture.colour, x, y);
            add_difference(&trilinear, colour, exact, channels);
            if (fabs(t.dx.x) + fabs(t.dy.x) <= 1.0 && fabs(t.dx.y) + fabs(t.dy.y) <= 1.0)
                add_difference(&bilinear, colour, exact, channels);
        }
    if (chain->count > 1 && trilinear.count) {
        table_add(table, shots, shot->view, "off_trilinear_rms_255",
                  sqrt(trilinear.sum / (double)trilinear.count), "1/255");
        table_add(table, shots, shot->view, "off_trilinear_max_255", trilinear.largest, "1/255");
    } else if (bilinear.count) {
        table_add(table, shots, shot->view, "off_bilinear_max_255", bilinear.largest, "1/255");
    }
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
    if (reads == READS_OPENGL) add_level_errors(shots, table);
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        double exact = mean(shot_exact(shot));
        if (exact > 0.0) /* a black image has no brightness to keep */
            table_add(table, shots, shot->view, "brightness", mean(&shot->picture.colour) / exact, "1");
        if (reads != READS_BASE) add_off(shots, shot, &reading->chain, table);
    }
}
