/* Mip chains by three filters, and summed-area tables that floats can hold. */
#include "chain.h"

#include "fail.h"
#include "vec.h"

#include <math.h>
#include <stdlib.h>

/* ---- Halving one side ---- */

/* The parent's texels that make one texel of the child: sum of weight[k] * parent[index[k]]. */
enum {
    TAPS_MAX = 20
}; /* a Kaiser filter has the most where 3 texels become 1: within 3 * 3 on either side */
typedef struct {
    int count, index[TAPS_MAX];
    double weight[TAPS_MAX];
} Taps;

/* Texel i of m covers the parent's n texels from i n/m to (i + 1) n/m. Whole numbers throughout: i n/m lies
 * i/m within texel 2i if n is odd, and on its border if n is even. */
static Taps box_taps(int n, int m, int i) {
    if (n == 1) return (Taps){1, {0}, {1.0}};
    if (n % 2 == 0) return (Taps){2, {2 * i, 2 * i + 1}, {0.5, 0.5}};
    return (Taps){
        3, {2 * i, 2 * i + 1, 2 * i + 2}, {(double)(m - i) / n, (double)m / n, (double)(i + 1) / n}};
}

/* The modified Bessel function of order zero: sum of ((x/2)^k / k!)^2. */
static double bessel_i0(double x) {
    double sum = 1.0, term = 1.0;
    for (int k = 1; term > 1e-17 * sum; k++) {
        term *= (x / (2.0 * k)) * (x / (2.0 * k));
        sum += term;
    }
    return sum;
}

static const double kaiser_alpha = 4.0, kaiser_radius = 3.0; /* the radius is in texels of the child */

static double kaiser_sinc(double x) {
    double t = x / kaiser_radius;
    if (fabs(t) >= 1.0) return 0.0;
    double sinc = x == 0.0 ? 1.0 : sin(PI * x) / (PI * x);
    return sinc * bessel_i0(kaiser_alpha * sqrt(1.0 - t * t)) / bessel_i0(kaiser_alpha);
}

/* The filter around the child's centre, at the centres of the parent's texels; divided by its own sum, for a
 * constant image must stay as it is. Texels beyond an end are those of the next repeat. */
static Taps kaiser_taps(int n, int m, int i) {
    double ratio = (double)n / m, centre = (i + 0.5) * ratio, sum = 0.0;
    int first = (int)floor(centre - kaiser_radius * ratio);
    int last = (int)floor(centre + kaiser_radius * ratio);
    Taps taps = {0};
    for (int j = first; j <= last; j++) {
        double weight = kaiser_sinc((j + 0.5 - centre) / ratio);
        if (weight == 0.0) continue;
        taps.index[taps.count] = (j % n + n) % n;
        taps.weight[taps.count++] = weight;
        sum += weight;
    }
    for (int k = 0; k < taps.count; k++) taps.weight[k] /= sum;
    return taps;
}

/* An image with its width halved, or its height. */
static Image halve(const Image *from, bool height, ChainFilter filter) {
    int n = height ? from->height : from->width, m = n > 1 ? n / 2 : 1, channels = from->channels;
    Taps *taps = allocate(m, sizeof *taps);
    for (int i = 0; i < m; i++) taps[i] = filter == CHAIN_KAISER ? kaiser_taps(n, m, i) : box_taps(n, m, i);

    Image to = height ? image_create(from->width, m, channels) : image_create(m, from->height, channels);
    for (int y = 0; y < to.height; y++)
        for (int x = 0; x < to.width; x++) {
            const Taps *t = &taps[height ? y : x];
            double sum[4] = {0};
            for (int k = 0; k < t->count; k++) {
                const float *texel = height ? image_at(from, x, t->index[k]) : image_at(from, t->index[k], y);
                for (int c = 0; c < channels; c++) sum[c] += t->weight[k] * texel[c];
            }
            for (int c = 0; c < channels; c++) image_at(&to, x, y)[c] = (float)sum[c];
        }
    free(taps);
    return to;
}

static Image halve_both(const Image *from, ChainFilter filter) {
    Image narrow = halve(from, false, filter), small = halve(&narrow, true, filter);
    image_destroy(&narrow);
    return small;
}

/* ---- Chains ---- */

static Image recode(const Image *from, double (*code)(double)) {
    Image to = image_create(from->width, from->height, from->channels);
    size_t count = (size_t)from->width * from->height * from->channels;
    for (size_t i = 0; i < count; i++) {
        bool alpha = from->channels == 4 && i % 4 == 3;
        to.pixels[i] = alpha ? from->pixels[i] : (float)code(from->pixels[i]);
    }
    return to;
}

/* The mistake: encode, take the mean, decode. */
static Image halve_encoded(const Image *from) {
    Image encoded = recode(from, srgb_encode), small = halve_both(&encoded, CHAIN_BOX);
    Image to = recode(&small, srgb_decode);
    image_destroy(&encoded);
    image_destroy(&small);
    return to;
}

Chain chain_create(const Image *base, ChainFilter filter) {
    Chain chain = {.count = 1, .levels = {*base}};
    const Image *parent = base;
    while (parent->width > 1 || parent->height > 1) {
        Image *child = &chain.levels[chain.count++];
        *child = filter == CHAIN_SRGB_BOX ? halve_encoded(parent) : halve_both(parent, filter);
        parent = child;
    }
    return chain;
}

void chain_destroy(Chain *chain) {
    for (int i = 1; i < chain->count; i++) image_destroy(&chain->levels[i]);
    *chain = (Chain){0};
}

/* ---- Summed-area tables ---- */

/* The q of chain.h for one channel; a black channel may have any. */
static double quantum(const Image *base, int channel) {
    size_t count = (size_t)base->width * base->height;
    double total = 0.0;
    for (size_t i = 0; i < count; i++) total += fabs(base->pixels[i * base->channels + channel]);
    int exponent;
    double fraction = frexp(total, &exponent); /* total = fraction 2^exponent, fraction in 1/2..1 */
    if (fraction == 0.5) exponent--;
    return ldexp(1.0, exponent - 23);
}

/* S in doubles, one texel after another: the row so far, and the table below it. A sum of 2^28 texels uses 28
 * bits more than a texel has, and doubles have 29 to spare. */
static SummedArea sum_up(const Image *base, bool split) {
    int channels = base->channels;
    size_t row_size = (size_t)base->width * channels;
    SummedArea table = {image_create(base->width, base->height, channels),
                        image_create(base->width, base->height, channels)};
    double *below = allocate(row_size, sizeof *below), q[4] = {0};
    for (int c = 0; split && c < channels; c++) q[c] = quantum(base, c);

    for (int y = 0; y < base->height; y++) {
        double row[4] = {0};
        for (size_t i = 0; i < row_size; i++) {
            int c = (int)(i % channels);
            size_t at = y * row_size + i;
            row[c] += base->pixels[at];
            below[i] += row[c];
            table.high.pixels[at] = (float)(split ? q[c] * nearbyint(below[i] / q[c]) : below[i]);
            if (split) table.low.pixels[at] = (float)(below[i] - table.high.pixels[at]);
        }
    }
    free(below);
    return table;
}

SummedArea summed_area_create(const Image *base) { return sum_up(base, true); }
SummedArea summed_area_create_naive(const Image *base) { return sum_up(base, false); }

void summed_area_destroy(SummedArea *table) {
    image_destroy(&table->high);
    image_destroy(&table->low);
}
