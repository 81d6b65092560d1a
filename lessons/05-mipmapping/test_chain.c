/* Mip chains and summed-area tables against sums in doubles that know nothing of how they are made. */
#include "chain.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#define PI 3.14159265358979323846

static void assert_near(double value, double expected, double bound) {
    if (!(fabs(value - expected) <= bound))
        fail_msg("%.9g is %.3g from %.9g; allowed are %.3g", value, fabs(value - expected), expected, bound);
}

static const int sizes[][2] = {{1, 1}, {1, 6}, {7, 1}, {3, 5}, {4, 4}, {64, 64}, {100, 30}, {513, 257}};
enum { SIZES = sizeof sizes / sizeof *sizes };

/* Random numbers, the same ones every time. */
static uint32_t state;
static double random_unit(void) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
}

/* Texels of 0..1, as eight bits give them; or with hdr up to 1000, small ones far more often. */
static Image random_image(int width, int height, int channels, bool hdr) {
    Image image = image_create(width, height, channels);
    state = 1;
    for (size_t i = 0; i < (size_t)width * height * channels; i++) {
        double unit = random_unit();
        image.pixels[i] = (float)(hdr ? 1000.0 * pow(unit, 8.0) : floor(256.0 * unit) / 255.0);
    }
    return image;
}

static double mean(const Image *image, int channel) {
    double sum = 0.0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) sum += image_at(image, x, y)[channel];
    return sum / ((double)image->width * image->height);
}

/* ---- Chains ---- */

static void chains_end_at_one_texel(void **unused) {
    (void)unused;
    static const int cases[][3] = {{1, 1, 1},      {1, 6, 3},      {3, 5, 3},
                                   {513, 257, 10}, {16384, 1, 15}, {16383, 2, 14}};
    for (int i = 0; i < 6; i++) {
        Image base = image_create(cases[i][0], cases[i][1], 1);
        Chain chain = chain_create(&base, CHAIN_BOX);
        assert_int_equal(chain.count, cases[i][2]);
        for (int k = 0; k < chain.count; k++) {
            assert_int_equal(chain.levels[k].width, base.width >> k ? base.width >> k : 1);
            assert_int_equal(chain.levels[k].height, base.height >> k ? base.height >> k : 1);
        }
        chain_destroy(&chain);
        image_destroy(&base);
    }
}

/* Each level sums up its whole parent with equal shares, so all have one mean, odd sizes too. Every level
 * rounds twice to floats: 2 * 2^-24 a level, of values that are not negative. */
static void box_keeps_the_mean(void **unused) {
    (void)unused;
    for (int i = 0; i < 2 * SIZES; i++) {
        Image base = random_image(sizes[i / 2][0], sizes[i / 2][1], 3, i % 2);
        Chain chain = chain_create(&base, CHAIN_BOX);
        for (int k = 0; k < chain.count; k++)
            for (int c = 0; c < 3; c++)
                assert_near(mean(&chain.levels[k], c), mean(&base, c), k * ldexp(mean(&base, c), -23));
        chain_destroy(&chain);
        image_destroy(&base);
    }
}

static double overlap(double a0, double a1, double b0, double b1) {
    return fmax(0.0, fmin(a1, b1) - fmax(a0, b0));
}

/* The mean of the parent over the rectangle of the child's texel (x, y), by trying all parent texels. */
static double area_mean(const Image *parent, const Image *child, int x, int y) {
    double w = (double)parent->width / child->width, h = (double)parent->height / child->height, sum = 0.0;
    for (int j = 0; j < parent->height; j++)
        for (int i = 0; i < parent->width; i++)
            sum += overlap(x * w, (x + 1) * w, i, i + 1) * overlap(y * h, (y + 1) * h, j, j + 1) *
                   image_at(parent, i, j)[0];
    return sum / (w * h);
}

static void box_is_the_mean_of_the_area(void **unused) {
    (void)unused;
    for (int s = 0; s < SIZES - 1; s++) {
        Image base = random_image(sizes[s][0], sizes[s][1], 1, true);
        Chain chain = chain_create(&base, CHAIN_BOX);
        for (int k = 1; k < chain.count; k++)
            for (int y = 0; y < chain.levels[k].height; y++)
                for (int x = 0; x < chain.levels[k].width; x++) {
                    double exact = area_mean(&chain.levels[k - 1], &chain.levels[k], x, y);
                    assert_near(image_at(&chain.levels[k], x, y)[0], exact, ldexp(exact, -22));
                }
        chain_destroy(&chain);
        image_destroy(&base);
    }
}

static void black_stays_black(void **unused) {
    (void)unused;
    Image base = image_create(13, 6, 3);
    for (ChainFilter filter = CHAIN_BOX; filter <= CHAIN_KAISER; filter++) {
        Chain chain = chain_create(&base, filter);
        for (int k = 0; k < chain.count; k++)
            for (int c = 0; c < 3; c++) assert_true(mean(&chain.levels[k], c) == 0.0);
        chain_destroy(&chain);
    }
    image_destroy(&base);
}

/* ---- The mistake in sRGB ---- */

/* A checker of black and white texels is 1/2 in linear light. Its sRGB codes are 0 and 1 too, but their mean,
 * 1/2, decodes to ((0.5 + 0.055) / 1.055)^2.4 = 0.2140: what is lost is 57 % of the light. */
static void encoded_mean_darkens(void **unused) {
    (void)unused;
    Image base = image_create(8, 8, 3);
    for (int i = 0; i < 8 * 8 * 3; i++) base.pixels[i] = (float)((i / 3 + i / 24) % 2);
    Chain right = chain_create(&base, CHAIN_BOX), wrong = chain_create(&base, CHAIN_SRGB_BOX);
    for (int k = 1; k < right.count; k++)
        for (int c = 0; c < 3; c++) {
            assert_near(image_at(&right.levels[k], 0, 0)[c], 0.5, 0.0);
            assert_near(image_at(&wrong.levels[k], 0, 0)[c], pow(0.555 / 1.055, 2.4), 1e-6);
        }
    chain_destroy(&right);
    chain_destroy(&wrong);
    image_destroy(&base);
}

/* Decoding is convex, so the mean of codes is never too bright; and an even grey is not changed. */
static void encoded_mean_never_brightens(void **unused) {
    (void)unused;
    Image base = random_image(33, 20, 1, true);
    Chain right = chain_create(&base, CHAIN_BOX), wrong = chain_create(&base, CHAIN_SRGB_BOX);
    for (int y = 0; y < right.levels[1].height; y++)
        for (int x = 0; x < right.levels[1].width; x++)
            assert_true(image_at(&wrong.levels[1], x, y)[0] <=
                        image_at(&right.levels[1], x, y)[0] * 1.000001f);
    chain_destroy(&wrong);
    chain_destroy(&right);

    for (int i = 0; i < 33 * 20; i++) base.pixels[i] = 0.18f;
    Chain grey = chain_create(&base, CHAIN_SRGB_BOX);
    for (int k = 0; k < grey.count; k++) assert_near(mean(&grey.levels[k], 0), 0.18, 1e-6);
    chain_destroy(&grey);
    image_destroy(&base);
}

/* Alpha is no light: it has no sRGB. */
static void alpha_is_not_encoded(void **unused) {
    (void)unused;
    Image base = image_create(2, 1, 4);
    for (int c = 0; c < 4; c++) image_at(&base, 1, 0)[c] = 1.0f;
    Chain chain = chain_create(&base, CHAIN_SRGB_BOX);
    assert_near(chain.levels[1].pixels[2], pow(0.555 / 1.055, 2.4), 1e-6);
    assert_near(chain.levels[1].pixels[3], 0.5, 0.0);
    chain_destroy(&chain);
    image_destroy(&base);
}

/* ---- The Kaiser filter ---- */

static void kaiser_keeps_a_constant(void **unused) {
    (void)unused;
    for (int s = 0; s < SIZES; s++) {
        Image base = image_create(sizes[s][0], sizes[s][1], 1);
        for (int i = 0; i < base.width * base.height; i++) base.pixels[i] = 700.0f;
        Chain chain = chain_create(&base, CHAIN_KAISER);
        for (int k = 0; k < chain.count; k++)
            for (int i = 0; i < chain.levels[k].width * chain.levels[k].height; i++)
                assert_near(chain.levels[k].pixels[i], 700.0, 700.0 * k * ldexp(1.0, -23));
        chain_destroy(&chain);
        image_destroy(&base);
    }
}

/* A texture shifted by two texels, around its end, has the same child shifted by one. */
static void kaiser_wraps(void **unused) {
    (void)unused;
    Image base = random_image(24, 1, 1, false), moved = image_create(24, 1, 1);
    for (int x = 0; x < 24; x++) moved.pixels[(x + 2) % 24] = base.pixels[x];
    Chain a = chain_create(&base, CHAIN_KAISER), b = chain_create(&moved, CHAIN_KAISER);
    for (int x = 0; x < 12; x++) assert_near(b.levels[1].pixels[(x + 1) % 12], a.levels[1].pixels[x], 1e-6);
    chain_destroy(&b);
    chain_destroy(&a);
    image_destroy(&moved);
    image_destroy(&base);
}

/* For even sizes the symmetric filter gives every parent texel the same share: the mean stays. */
static void kaiser_keeps_the_mean_of_even_sizes(void **unused) {
    (void)unused;
    Image base = random_image(64, 16, 1, false);
    Chain chain = chain_create(&base, CHAIN_KAISER);
    for (int k = 0; k < chain.count; k++) assert_near(mean(&chain.levels[k], 0), mean(&base, 0), 1e-6);
    chain_destroy(&chain);
    image_destroy(&base);
}

/* What is left of a cosine of that many periods in 64 texels, after one halving. */
static double amplitude(int periods, ChainFilter filter) {
    Image base = image_create(64, 1, 1);
    for (int x = 0; x < 64; x++) base.pixels[x] = (float)cos(2.0 * PI * periods * (x + 0.5) / 64.0);
    Chain chain = chain_create(&base, filter);
    double sum = 0.0;
    for (int x = 0; x < 32; x++) sum += 2.0 * chain.levels[1].pixels[x] * chain.levels[1].pixels[x] / 32.0;
    chain_destroy(&chain);
    image_destroy(&base);
    return sqrt(sum);
}

/* The child can show up to 16 periods; what is faster should vanish, for it would come back as an alias. The
 * box of two texels leaves cos(pi periods / 64) of either. */
static void kaiser_is_sharper_and_aliases_less(void **unused) {
    (void)unused;
    printf("# left of 8 periods: box %.4f, kaiser %.4f; of 24: box %.4f, kaiser %.4f\n",
           amplitude(8, CHAIN_BOX), amplitude(8, CHAIN_KAISER), amplitude(24, CHAIN_BOX),
           amplitude(24, CHAIN_KAISER));
    assert_near(amplitude(8, CHAIN_BOX), cos(PI * 8.0 / 64.0), 1e-6);
    assert_near(amplitude(24, CHAIN_BOX), cos(PI * 24.0 / 64.0), 1e-6);
    assert_near(amplitude(8, CHAIN_KAISER), 1.0, 0.01);
    assert_near(amplitude(24, CHAIN_KAISER), 0.0, 0.01);
}

static void kaiser_rings_below_black(void **unused) {
    (void)unused;
    Image base = image_create(64, 1, 1);
    for (int x = 32; x < 64; x++) base.pixels[x] = 1000.0f;
    Chain chain = chain_create(&base, CHAIN_KAISER);
    float low = 0.0f, high = 0.0f;
    for (int x = 0; x < 32; x++) {
        low = fminf(low, chain.levels[1].pixels[x]);
        high = fmaxf(high, chain.levels[1].pixels[x]);
    }
    printf("# a step from 0 to 1000 rings from %.1f to %.1f\n", low, high);
    assert_true(low < -10.0f && low > -100.0f && high > 1010.0f && high < 1100.0f);
    chain_destroy(&chain);
    image_destroy(&base);
}

/* ---- Summed-area tables ---- */

static float at(const Image *sums, int x, int y) { return x && y ? *image_at(sums, x - 1, y - 1) : 0.0f; }

/* The sum over columns x0..x1-1 and rows y0..y1-1 in floats, as a shader computes it. */
static float box(const Image *sums, int x0, int y0, int x1, int y1) {
    float right = at(sums, x1, y1) - at(sums, x1, y0), left = at(sums, x0, y1) - at(sums, x0, y0);
    return right - left;
}

static double table_mean(const SummedArea *table, int x0, int y0, int x1, int y1) {
    float sum = box(&table->high, x0, y0, x1, y1) + box(&table->low, x0, y0, x1, y1);
    return sum / ((double)(x1 - x0) * (y1 - y0));
}

static double sum_of_absolutes(const Image *image) {
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) sum += fabs(image->pixels[i]);
    return sum;
}

static double brute_mean(const Image *image, int x0, int y0, int x1, int y1) {
    double sum = 0.0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) sum += *image_at(image, x, y);
    return sum / ((double)(x1 - x0) * (y1 - y0));
}

/* Of a sum, before it is divided by the area: high is exact. The four low corners are stored with 2^-25 q
 * each, and three subtractions of numbers below 2q round by 2^-24 q each: 5 q 2^-24 with q <= 2^-22 of the
 * sum of absolutes. The last addition rounds the result itself. */
static double bound_of(const Image *image, double value, double texels) {
    return ldexp(5.0 * sum_of_absolutes(image), -46) / texels + ldexp(fabs(value), -24);
}

static void random_boxes_of_the_table_are_exact(void **unused) {
    (void)unused;
    for (int i = 0; i < 3 * SIZES; i++) {
        Image base = random_image(sizes[i / 3][0], sizes[i / 3][1], 1, i % 3);
        if (i % 3 == 2) /* negative values */
            for (int k = 0; k < base.width * base.height; k += 2) base.pixels[k] *= -1.0f;
        SummedArea table = summed_area_create(&base);
        for (int k = 0; k < 300; k++) {
            int x0 = (int)(random_unit() * base.width),
                x1 = x0 + 1 + (int)(random_unit() * (base.width - x0));
            int y0 = (int)(random_unit() * base.height),
                y1 = y0 + 1 + (int)(random_unit() * (base.height - y0));
            double exact = brute_mean(&base, x0, y0, x1, y1);
            assert_near(table_mean(&table, x0, y0, x1, y1), exact,
                        bound_of(&base, exact, (double)(x1 - x0) * (y1 - y0)));
        }
        summed_area_destroy(&table);
        image_destroy(&base);
    }
}

/* Why high may be subtracted in any order: float and double differences agree. */
static void high_differences_do_not_round(void **unused) {
    (void)unused;
    Image base = random_image(513, 257, 1, true);
    SummedArea table = summed_area_create(&base);
    for (int i = 0; i < 10000; i++) {
        float a = table.high.pixels[(int)(random_unit() * 513 * 257)];
        float b = table.high.pixels[(int)(random_unit() * 513 * 257)];
        assert_true((double)(a - b) == (double)a - (double)b);
    }
    summed_area_destroy(&table);
    image_destroy(&base);
}

/* All channels have their own sums. */
static void table_has_channels(void **unused) {
    (void)unused;
    Image base = random_image(9, 7, 4, true);
    for (int i = 0; i < 9 * 7; i++) base.pixels[4 * i + 2] = 0.0f;
    SummedArea table = summed_area_create(&base);
    for (int c = 0; c < 4; c++) {
        double total = (double)image_at(&table.high, 8, 6)[c] + image_at(&table.low, 8, 6)[c];
        assert_near(total, 63.0 * mean(&base, c), ldexp(total, -45));
    }
    summed_area_destroy(&table);
    image_destroy(&base);
}

/* The worst error of a box of one texel, in 1/255, over every fifth texel of every fifth row. */
static double worst_texel(const Image *base, const SummedArea *table) {
    double worst = 0.0;
    for (int y = 0; y < base->height; y += 5)
        for (int x = 0; x < base->width; x += 5)
            worst = fmax(worst, fabs(table_mean(table, x, y, x + 1, y + 1) - *image_at(base, x, y)));
    return 255.0 * worst;
}

/* The error of a table read one texel wide, as floats naively hold it and as ours do. naive: at least so many
 * 255ths must be wrong. */
static void one_texel_wide(int size, float brightest, double naive) {
    Image base = random_image(size, size, 1, false);
    if (brightest > 0.0f) *image_at(&base, size / 3, size / 3) = brightest;
    SummedArea table = summed_area_create_naive(&base);
    double wrong = worst_texel(&base, &table);
    summed_area_destroy(&table);
    table = summed_area_create(&base);
    double right = worst_texel(&base, &table);
    summed_area_destroy(&table);
    printf("# %d x %d, brightest texel %g: naive %.4g/255, mended %.3g/255\n", size, size,
           brightest > 0.0f ? brightest : 1.0, wrong, right);
    assert_true(wrong >= naive);
    assert_true(right <= 255.0 * bound_of(&base, 1.0, 1.0));
    assert_true(right <= 0.01);
    image_destroy(&base);
}

/* S reaches size^2 / 2 and a little more, which is stored to 2^-24 of itself: off by about size^2 2^-26 where
 * it is largest, and a box of four corners by four times that: 16/255 for 1024, 255/255 for 4096. */
static void one_texel_of_1024(void **unused) { (void)unused, one_texel_wide(1024, 0.0f, 12.0); }
static void one_texel_of_4096(void **unused) { (void)unused, one_texel_wide(4096, 0.0f, 194.0); }
static void one_texel_of_1024_beside_1e5(void **unused) { (void)unused, one_texel_wide(1024, 1e5f, 12.0); }
static void one_texel_of_4096_beside_1e5(void **unused) { (void)unused, one_texel_wide(4096, 1e5f, 194.0); }

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chains_end_at_one_texel),
        cmocka_unit_test(box_keeps_the_mean),
        cmocka_unit_test(box_is_the_mean_of_the_area),
        cmocka_unit_test(black_stays_black),
        cmocka_unit_test(encoded_mean_darkens),
        cmocka_unit_test(encoded_mean_never_brightens),
        cmocka_unit_test(alpha_is_not_encoded),
        cmocka_unit_test(kaiser_keeps_a_constant),
        cmocka_unit_test(kaiser_wraps),
        cmocka_unit_test(kaiser_keeps_the_mean_of_even_sizes),
        cmocka_unit_test(kaiser_is_sharper_and_aliases_less),
        cmocka_unit_test(kaiser_rings_below_black),
        cmocka_unit_test(random_boxes_of_the_table_are_exact),
        cmocka_unit_test(high_differences_do_not_round),
        cmocka_unit_test(table_has_channels),
        cmocka_unit_test(one_texel_of_1024),
        cmocka_unit_test(one_texel_of_4096),
        cmocka_unit_test(one_texel_of_1024_beside_1e5),
        cmocka_unit_test(one_texel_of_4096_beside_1e5),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests_name("05-mipmapping chain", tests, NULL, NULL);
}
