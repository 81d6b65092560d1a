/* Prints the largest and the mean difference of two 8-bit images' stored values, in 255ths; a line for each
 * pair of files. */
#include "fail.h"
#include "image.h"

#include <math.h>
#include <stdio.h>

static void print_difference(const char *path, const char *other) {
    Image a = image_load(path, IMAGE_RAW), b = image_load(other, IMAGE_RAW);
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        fail("%s is %dx%dx%d, %s is %dx%dx%d", path, a.width, a.height, a.channels, other, b.width, b.height,
             b.channels);
    size_t count = (size_t)a.width * a.height * a.channels;
    double largest = 0, sum = 0;
    for (size_t i = 0; i < count; i++) {
        double difference = 255.0 * fabs((double)a.pixels[i] - b.pixels[i]);
        largest = fmax(largest, difference);
        sum += difference;
    }
    printf("%.0f %.4f\n", largest, sum / (double)count);
    image_destroy(&a);
    image_destroy(&b);
}

int main(int argc, char **argv) {
    if (argc < 3 || argc % 2 == 0) fail_usage("pairs of images are expected");
    for (int i = 1; i < argc; i += 2) print_difference(argv[i], argv[i + 1]);
    return 0;
}
