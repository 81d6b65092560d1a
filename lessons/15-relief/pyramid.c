#include "pyramid.h"

#include "parallel.h"

/* ---- The cells ---- */

typedef struct {
    const Image *height;
    Image *corners;
} Corners;

static void find_corners_of_row(void *context, int y) {
    const Corners *job = context;
    const Image *height = job->height;
    int above = (y + 1) % height->height;
    for (int x = 0; x < height->width; x++) {
        int right = (x + 1) % height->width;
        float *corners = image_at(job->corners, x, y);
        corners[0] = *image_at(height, x, y), corners[1] = *image_at(height, right, y);
        corners[2] = *image_at(height, x, above), corners[3] = *image_at(height, right, above);
    }
}

Image corners_build(const Image *height) {
    Image corners = image_create(height->width, height->height, 4);
    parallel_for(height->height, find_corners_of_row, &(Corners){height, &corners});
    return corners;
}

/* ---- The pyramid ---- */

static float higher(float a, float b) { return a > b ? a : b; }

static float highest_corner(const float *corners) {
    return higher(higher(corners[0], corners[1]), higher(corners[2], corners[3]));
}

static int power_of_two_from(int size) {
    int power = 1;
    while (power < size) power *= 2;
    return power;
}

/* Each cell's maximum, on a ground of zeros whose sides are powers of two. */
static Image finest_level(const Image *height) {
    Image corners = corners_build(height);
    Image level = image_create(power_of_two_from(height->width), power_of_two_from(height->height), 1);
    for (int y = 0; y < height->height; y++)
        for (int x = 0; x < height->width; x++)
            *image_at(&level, x, y) = highest_corner(image_at(&corners, x, y));
    image_destroy(&corners);
    return level;
}

/* Half the size; a side of 1 stays. */
static Image coarser_level(const Image *finer) {
    int across = finer->width > 1 ? 2 : 1, up = finer->height > 1 ? 2 : 1;
    Image level = image_create(finer->width / across, finer->height / up, 1);
    for (int y = 0; y < finer->height; y++)
        for (int x = 0; x < finer->width; x++) {
            float *highest = image_at(&level, x / across, y / up);
            *highest = higher(*highest, *image_at(finer, x, y));
        }
    return level;
}

Pyramid pyramid_build(const Image *height) {
    Pyramid pyramid = {.levels = {finest_level(height)}, .count = 1};
    for (const Image *last = pyramid.levels; last->width > 1 || last->height > 1; last++)
        pyramid.levels[pyramid.count++] = coarser_level(last);
    return pyramid;
}

void pyramid_destroy(Pyramid *pyramid) {
    for (int i = 0; i < pyramid->count; i++) image_destroy(&pyramid->levels[i]);
    *pyramid = (Pyramid){0};
}
