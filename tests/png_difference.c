/* Prints the largest and the mean difference of two 8-bit images' stored values, in 255ths. */
#include "fail.h"
#include "image.h"

#include <math.h>
#include <stdio.h>

int main(int argc, char **argv) {
    if (argc != 3) fail_usage("two images are expected");
    Image a = image_load(argv[1], IMAGE_RAW), b = image_load(argv[2], IMAGE_RAW);
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        fail("%s is %dx%dx%d, %s is %dx%dx%d", argv[1], a.width, a.height, a.channels, argv[2], b.width,
             b.height, b.channels);
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
    return 0;
}
