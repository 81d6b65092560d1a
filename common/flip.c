/* FLIP: how different two images look when one alternates between them on a screen (Andersson, Nilsson,
 * Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", 2020).
 *
 * Two errors are found for each pixel, both 0..1. The colour error: both images are blurred by what an eye
 * cannot resolve, then their distance is taken in a colour space where equal distances look equal. The
 * feature error: edges and points are found in both, for a new edge catches the eye even where the colours
 * hardly differ. The result is colour^(1 - feature). Constants are those of the authors' program,
 * version 1.6.
 *
 * Every filter here is a product of a function of x and one of y, so a row pass and a column pass do. Both
 * are sums of shifted rows, and the speed is in that one loop (weighted_sum). */
#include "compare.h"

#include "fail.h"
#include "parallel.h"
#include "vec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PIXELS_PER_DEGREE = 67.0206; /* 0.7 m from a screen 0.7 m and 3840 pixels wide */

enum { RADIUS_MAX = 10, TAPS_MAX = 2 * RADIUS_MAX + 1, BLOCK = 16 };

/* ---- Filters: TAPS_MAX weights in one dimension ------------------------------------------------------ */

typedef struct {
    int radius;
    float weights[TAPS_MAX]; /* 2 radius + 1 of them */
} Filter;

/* A Gaussian, its first derivative and its second. */
typedef enum { SMOOTH, EDGE, POINT } Shape;

/* The positive weights sum to 1, the negative ones (of EDGE and POINT) to -1. */
static Filter filter_make(Shape shape, double sigma_pixels, int radius) {
    Filter filter = {.radius = radius};
    double weights[TAPS_MAX], positive = 0, negative = 0;
    for (int i = 0; i <= 2 * radius; i++) {
        double x = (i - radius) / sigma_pixels, gaussian = exp(-x * x / 2);
        weights[i] = shape == SMOOTH ? gaussian : shape == EDGE ? -x * gaussian : (x * x - 1) * gaussian;
        if (weights[i] > 0)
            positive += weights[i];
        else
            negative -= weights[i];
    }
    for (int i = 0; i <= 2 * radius; i++)
        filter.weights[i] = (float)(weights[i] / (weights[i] > 0 ? positive : negative ? negative : 1));
    return filter;
}

/* How sharply the eye sees one of the three opponent colours, as a blur: a sqrt(pi/b) exp(-pi^2 r^2 / b), r
 * in degrees (table 1 of the paper), which is a Gaussian of sigma = sqrt(b/2)/pi. Blue-yellow is a sum of
 * two. */
static const double LIGHT_B = 0.0047, RED_GREEN_B = 0.0053;
static const double BLUE_YELLOW_A[2] = {34.1, 13.5}, BLUE_YELLOW_B[2] = {0.04, 0.025};

static double sigma_of(double b) { return sqrt(b / 2) / PI * PIXELS_PER_DEGREE; }

/* The authors cut all of them off where the widest is at three sigmas. A narrow one ends sooner here: what it
 * has beyond six sigmas of its own is below 1e-7. */
static Filter sensitivity_make(double b) {
    int widest = (int)ceil(3 * sigma_of(BLUE_YELLOW_B[0])), own = (int)ceil(6 * sigma_of(b));
    return filter_make(SMOOTH, sigma_of(b), own < widest ? own : widest);
}

/* Edges and points of the width that the eye finds best, in degrees. */
static const double FEATURE_WIDTH = 0.082;

/* The planes that the row pass makes of an image, and the column pass reads. */
enum { LIGHT, RED_GREEN, BLUE_YELLOW_1, BLUE_YELLOW_2, ROW_SMOOTH, ROW_EDGE, ROW_POINT, PLANES };

typedef struct {
    const Image *image;
    Seen *seen; /* what is made */
    int width, height;
    size_t stride; /* floats a row of a plane: the width, rounded up to a multiple of BLOCK */
    float *planes; /* [PLANES][height][stride] */
    Filter light, red_green, blue_yellow[2], smooth, edge, point;
    float share[2];            /* of the two Gaussians in blue-yellow */
    float byte_to_linear[256]; /* the image is seen as an 8-bit sRGB file keeps it */
} Eye;

static float *plane_row(const Eye *f, int plane, int y) {
    return f->planes + ((size_t)plane * f->height + y) * f->stride;
}

/* out[x] = sum over i of filter.weights[i] * rows[i][x]. In blocks of a fixed size, whose sums stay in
 * registers: this is where the time goes. */
static void weighted_sum(const Filter *filter, const float *const *rows, float *restrict out, size_t stride) {
    int count = 2 * filter->radius + 1;
    for (size_t x = 0; x < stride; x += BLOCK) {
        float sum[BLOCK] = {0};
        for (int i = 0; i < count; i++) {
            const float *row = rows[i] + x;
            float weight = filter->weights[i];
            for (int k = 0; k < BLOCK; k++) sum[k] += weight * row[k];
        }
        memcpy(out + x, sum, sizeof sum);
    }
}

/* Along a row that begins RADIUS_MAX after `padded`. */
static void filter_row(const Eye *f, const Filter *filter, const float *padded, float *out) {
    const float *rows[TAPS_MAX];
    for (int i = 0; i <= 2 * filter->radius; i++) rows[i] = padded + RADIUS_MAX - filter->radius + i;
    weighted_sum(filter, rows, out, f->stride);
}

/* Across the rows of a plane around row y; beyond the edge the last row is repeated, as the authors do. */
static void filter_column(const Eye *f, const Filter *filter, int plane, int y, float *out) {
    const float *rows[TAPS_MAX];
    for (int i = 0; i <= 2 * filter->radius; i++) {
        int row = y - filter->radius + i;
        rows[i] = plane_row(f, plane, row < 0 ? 0 : row < f->height ? row : f->height - 1);
    }
    weighted_sum(filter, rows, out, f->stride);
}

/* ---- Colours ----------------------------------------------------------------------------------------- */

/* CIE XYZ over the XYZ of white (D65), from linear RGB. Each row sums to 1: white is (1, 1, 1). */
static const float XYZ_OF_RGB[9] = {
    10135552. / 23359437, 8788810. / 23359437, 4435075. / 23359437,  /* */
    2613072. / 12288897,  8788810. / 12288897, 887015. / 12288897,   /* */
    1425312. / 80288307,  8788810. / 80288307, 70074185. / 80288307, /* */
};

typedef struct {
    float x, y, z;
} Colour;

/* What the eye sees at a pixel: a colour in Lab, and how much of an edge and of a point. */
struct SeenPixel {
    Colour colour;
    float edge, point;
};

static Colour transform(const float m[9], Colour c) {
    return (Colour){m[0] * c.x + m[1] * c.y + m[2] * c.z, m[3] * c.x + m[4] * c.y + m[5] * c.z,
                    m[6] * c.x + m[7] * c.y + m[8] * c.z};
}

/* out = the inverse of m, by cofactors (indices in a circle: the signs come out right). */
static void invert(const float m[9], float out[9]) {
    double cofactors[9], determinant = 0;
    for (int i = 0; i < 9; i++) {
        int r0 = (i / 3 + 1) % 3 * 3, r1 = (i / 3 + 2) % 3 * 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
        cofactors[i] = (double)m[r0 + c0] * m[r1 + c1] - (double)m[r0 + c1] * m[r1 + c0];
        if (i < 3) determinant += m[i] * cofactors[i];
    }
    for (int i = 0; i < 9; i++) out[i] = (float)(cofactors[i % 3 * 3 + i / 3] / determinant);
}

static float lab_curve(float t) {
    const float d = 6.0f / 29;
    return t > d * d * d ? cbrtf(t) : t / (3 * d * d) + 4.0f / 29;
}

/* CIE Lab, with a and b scaled by L over 100: the darker, the less colourful (the Hunt effect). */
static Colour lab_hunt(Colour xyz) {
    float x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
    float lightness = 116 * y - 16;
    return (Colour){lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

static const float QC = 0.7f, PC = 0.4f, PT = 0.95f, QF = 0.5f; /* the paper's q_c, p_c, p_t, q_f */

/* The HyAB distance of two colours in Lab, to the power q_c: it is large differences that it tames. */
static float colour_distance(Colour a, Colour b) {
    float red_green = a.y - b.y, blue_yellow = a.z - b.z;
    return powf(fabsf(a.x - b.x) + sqrtf(red_green * red_green + blue_yellow * blue_yellow), QC);
}

/* To 0..1: all below p_c of the largest distance is given p_t of the range, the rest is squeezed above. */
static float colour_error(float distance, float largest) {
    float knee = PC * largest;
    return distance < knee ? distance / knee * PT : PT + (distance - knee) / (largest - knee) * (1 - PT);
}

/* ---- The two passes ---------------------------------------------------------------------------------- */

/* Linear RGB to opponent colours, y, x - y and y - z of XYZ over white, and all filters along the row. (The
 * paper's YCxCz is 116 y - 16, 500 (x - y), 200 (y - z). Blurring does not mind factors and offsets, and the
 * features are those of (Y + 16) / 116 = y: so we do without.) */
static void row_pass(void *context, int row) {
    const Eye *f = context;
    const Image *source = f->image;
    size_t length = f->stride + 2 * RADIUS_MAX;
    float *light = allocate(3 * length, sizeof *light), *red_green = light + length;
    float *blue_yellow = red_green + length;
    for (size_t i = 0; i < length; i++) {
        int x = (int)i - RADIUS_MAX; /* beyond the edge its pixel is repeated */
        const float *p = image_at(source, x < 0 ? 0 : x < f->width ? x : f->width - 1, row);
        int grey = source->channels < 3;
        float rgb[3];
        for (int c = 0; c < 3; c++) rgb[c] = f->byte_to_linear[srgb_byte(p[grey ? 0 : c])];
        Colour xyz = transform(XYZ_OF_RGB, (Colour){rgb[0], rgb[1], rgb[2]});
        light[i] = xyz.y;
        red_green[i] = xyz.x - xyz.y;
        blue_yellow[i] = xyz.y - xyz.z;
    }
    filter_row(f, &f->light, light, plane_row(f, LIGHT, row));
    filter_row(f, &f->red_green, red_green, plane_row(f, RED_GREEN, row));
    filter_row(f, &f->blue_yellow[0], blue_yellow, plane_row(f, BLUE_YELLOW_1, row));
    filter_row(f, &f->blue_yellow[1], blue_yellow, plane_row(f, BLUE_YELLOW_2, row));
    filter_row(f, &f->smooth, light, plane_row(f, ROW_SMOOTH, row));
    filter_row(f, &f->edge, light, plane_row(f, ROW_EDGE, row));
    filter_row(f, &f->point, light, plane_row(f, ROW_POINT, row));
    free(light);
}

/* What the column pass finds at each pixel of a row. */
enum { SEEN_LIGHT, SEEN_RED_GREEN, SEEN_BY_1, SEEN_BY_2, EDGE_X, EDGE_Y, POINT_X, POINT_Y, FOUND };

static Colour seen_colour(const Eye *f, const float *found, const float rgb_of_xyz[9], size_t x) {
    float y = found[SEEN_LIGHT * f->stride + x];
    float blue_yellow =
        f->share[0] * found[SEEN_BY_1 * f->stride + x] + f->share[1] * found[SEEN_BY_2 * f->stride + x];
    Colour rgb =
        transform(rgb_of_xyz, (Colour){y + found[SEEN_RED_GREEN * f->stride + x], y, y - blue_yellow});
    rgb = (Colour){fminf(fmaxf(rgb.x, 0), 1), fminf(fmaxf(rgb.y, 0), 1), fminf(fmaxf(rgb.z, 0), 1)};
    return lab_hunt(transform(XYZ_OF_RGB, rgb));
}

static float length_of(const Eye *f, const float *found, int along_x, int along_y, size_t x) {
    float a = found[along_x * f->stride + x], b = found[along_y * f->stride + x];
    return sqrtf(a * a + b * b);
}

static void column_pass(void *context, int row) {
    const Eye *f = context;
    float rgb_of_xyz[9], *found = allocate(FOUND * f->stride, sizeof *found);
    invert(XYZ_OF_RGB, rgb_of_xyz);
    filter_column(f, &f->light, LIGHT, row, found + SEEN_LIGHT * f->stride);
    filter_column(f, &f->red_green, RED_GREEN, row, found + SEEN_RED_GREEN * f->stride);
    filter_column(f, &f->blue_yellow[0], BLUE_YELLOW_1, row, found + SEEN_BY_1 * f->stride);
    filter_column(f, &f->blue_yellow[1], BLUE_YELLOW_2, row, found + SEEN_BY_2 * f->stride);
    filter_column(f, &f->smooth, ROW_EDGE, row, found + EDGE_X * f->stride);
    filter_column(f, &f->edge, ROW_SMOOTH, row, found + EDGE_Y * f->stride);
    filter_column(f, &f->smooth, ROW_POINT, row, found + POINT_X * f->stride);
    filter_column(f, &f->point, ROW_SMOOTH, row, found + POINT_Y * f->stride);
    for (int x = 0; x < f->width; x++)
        f->seen->pixels[(size_t)row * f->width + x] =
            (SeenPixel){.colour = seen_colour(f, found, rgb_of_xyz, x),
                        .edge = length_of(f, found, EDGE_X, EDGE_Y, x),
                        .point = length_of(f, found, POINT_X, POINT_Y, x)};
    free(found);
}

Seen seen_create(const Image *image) {
    Seen seen = {image->width, image->height,
                 allocate((size_t)image->width * image->height, sizeof(SeenPixel))};
    Eye f = {.image = image, .seen = &seen, .width = image->width, .height = image->height};
    f.stride = ((size_t)f.width + BLOCK - 1) / BLOCK * BLOCK;
    f.planes = allocate((size_t)PLANES * f.height, f.stride * sizeof *f.planes);
    for (int i = 0; i < 256; i++) f.byte_to_linear[i] = (float)srgb_decode(i / 255.0);

    f.light = sensitivity_make(LIGHT_B);
    f.red_green = sensitivity_make(RED_GREEN_B);
    double weight[2];
    for (int i = 0; i < 2; i++) {
        f.blue_yellow[i] = sensitivity_make(BLUE_YELLOW_B[i]);
        /* The filter sums to 1, so its Gaussian's sum is 1 over the weight in its middle, along each axis. */
        double sum = 1 / f.blue_yellow[i].weights[f.blue_yellow[i].radius];
        weight[i] = BLUE_YELLOW_A[i] * sqrt(PI / BLUE_YELLOW_B[i]) * sum * sum;
    }
    for (int i = 0; i < 2; i++) f.share[i] = (float)(weight[i] / (weight[0] + weight[1]));
    double sigma = FEATURE_WIDTH / 2 * PIXELS_PER_DEGREE;
    int radius = (int)ceil(3 * sigma);
    f.smooth = filter_make(SMOOTH, sigma, radius);
    f.edge = filter_make(EDGE, sigma, radius);
    f.point = filter_make(POINT, sigma, radius);

    parallel_for(f.height, row_pass, &f);
    parallel_for(f.height, column_pass, &f);
    free(f.planes);
    return seen;
}

void seen_destroy(Seen *seen) {
    free(seen->pixels);
    *seen = (Seen){0};
}

/* ---- The difference of what is seen ------------------------------------------------------------------ */

typedef struct {
    const Seen *test, *reference;
    Image *map;
    float largest;    /* colour distance (to the power QC) that a screen can show: of green and blue */
    double *row_sums; /* of the errors, one a row */
} Flip;

static void difference_row(void *context, int row) {
    const Flip *f = context;
    int width = f->test->width;
    double sum = 0;
    for (int x = 0; x < width; x++) {
        const SeenPixel *a = &f->test->pixels[(size_t)row * width + x];
        const SeenPixel *b = &f->reference->pixels[(size_t)row * width + x];
        float feature = powf(fmaxf(fabsf(a->edge - b->edge), fabsf(a->point - b->point)) / sqrtf(2), QF);
        float error = powf(colour_error(colour_distance(a->colour, b->colour), f->largest), 1 - feature);
        image_at(f->map, x, row)[0] = error;
        sum += error;
    }
    f->row_sums[row] = sum;
}

double flip(const Seen *test, const Seen *reference, Image *map) {
    *map = image_create(test->width, test->height, 1);
    Flip f = {.test = test, .reference = reference, .map = map};
    f.row_sums = allocate((size_t)test->height, sizeof *f.row_sums);
    f.largest = colour_distance(lab_hunt(transform(XYZ_OF_RGB, (Colour){0, 1, 0})),
                                lab_hunt(transform(XYZ_OF_RGB, (Colour){0, 0, 1})));
    parallel_for(test->height, difference_row, &f);
    double sum = 0;
    for (int y = 0; y < test->height; y++) sum += f.row_sums[y];
    free(f.row_sums);
    return sum / ((double)test->width * test->height);
}
