#include "truth.h"

#include "fail.h"
#include "parallel.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- The integral over a pixel ---- */

/* The i-th of a sequence of evenly spread 64-bit numbers (splitmix64 by Steele, Lea and Flood, 2014). */
static uint64_t scramble(uint64_t i) {
    i *= 0x9e3779b97f4a7c15u;
    i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9u;
    i = (i ^ (i >> 27)) * 0x94d049bb133111ebu;
    return i ^ (i >> 31);
}

static double unit(uint64_t bits) { return (double)(bits >> 11) * 0x1p-53; }

typedef struct {
    const Truth *truth;
    const Camera *camera;
    Rays rays; /* of the camera */
    PixelFilter filter;
    int width, height, strata; /* strata x strata samples in each of two halves of a pixel */
    Image *image;
    double *row_change; /* a row's sum of squared changes from one half to both */
} Integral;

static Vec3 colour_along(const Truth *truth, Ray ray) {
    Sample sample = truth->sample(truth->scene, ray);
    return sample.hit ? sample.colour : truth->background;
}

/* One of a pixel's two halves: a sample at a random place in each stratum of the filter's support, which is
 * `reach` pixels to each side of the centre. */
static Vec3 half_of_pixel(const Integral *job, int x, int y, int half) {
    double reach = job->filter == FILTER_BOX ? 0.5 : 1.0, step = 2.0 * reach / job->strata, weights = 0.0;
    uint64_t seed = scramble(((uint64_t)y << 32 | (uint64_t)x) * 2 + (uint64_t)half);
    Vec3 sum = v3(0, 0, 0);
    for (int i = 0; i < job->strata * job->strata; i++) {
        uint64_t first = scramble(seed + 2 * (uint64_t)i), second = scramble(seed + 2 * (uint64_t)i + 1);
        double dx = (i % job->strata + unit(first)) * step - reach;
        double dy = (i / job->strata + unit(second)) * step - reach, r2 = dx * dx + dy * dy;
        if (job->filter == FILTER_GAUSSIAN && r2 > 1.0) continue;
        double weight = job->filter == FILTER_BOX ? 1.0 : exp(-2.0 * r2);
        Ray ray = rays_at(&job->rays, x + 0.5 + dx, y + 0.5 + dy);
        sum = vec3_add(sum, vec3_scale(colour_along(job->truth, ray), weight));
        weights += weight;
    }
    return vec3_scale(sum, 1.0 / weights);
}

static bool stopped(const Truth *truth) { return truth->stop && atomic_load(truth->stop); }

static void render_row(void *context, int y) {
    Integral *job = context;
    for (int x = 0; x < job->width && !stopped(job->truth); x++) {
        Vec3 first = half_of_pixel(job, x, y, 0), second = half_of_pixel(job, x, y, 1);
        Vec3 both = vec3_mix(first, second, 0.5), change = vec3_sub(both, first);
        float *pixel = image_at(job->image, x, y);
        pixel[0] = (float)both.x, pixel[1] = (float)both.y, pixel[2] = (float)both.z;
        job->row_change[y] += vec3_dot(change, change);
    }
}

/* ---- Keeping exact pictures ---- */

typedef struct {
    char magic[8];
    int width, height;
    double rmse;
} CacheHeader;

static const char cache_magic[8] = "texel 1";

static char *cache_path(const Integral *job) {
    uint64_t key = job->truth->key;
    const Camera *camera = job->camera;
    const double numbers[] = {camera->eye.x,    camera->eye.y,    camera->eye.z,        camera->target.x,
                              camera->target.y, camera->target.z, camera->up.x,         camera->up.y,
                              camera->up.z,     camera->height,   camera->fov_y_degrees};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        uint64_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        key = scramble(key ^ bits);
    }
    key = scramble(key ^ ((uint64_t)job->width << 32 | (uint64_t)job->height));
    key = scramble(key ^ ((uint64_t)job->strata << 32 | (uint64_t)job->filter));
    return text("%s/%016llx", job->truth->cache, (unsigned long long)key);
}

static bool cache_load(const char *path, Exact *exact) {
    FILE *file = fopen(path, "rb");
    if (!file) return false;
    CacheHeader header;
    Image *image = &exact->image;
    size_t count = (size_t)image->width * image->height * 3;
    bool good = fread(&header, sizeof header, 1, file) == 1 && !memcmp(header.magic, cache_magic, 8) &&
                header.width == image->width && header.height == image->height &&
                fread(image->pixels, sizeof(float), count, file) == count && fgetc(file) == EOF;
    fclose(file);
    if (good) exact->rmse = header.rmse;
    return good;
}

/* Failing to keep a picture loses only time, so it is no error. */
static void cache_save(const char *folder, const char *path, const Exact *exact) {
    mkdir(folder, 0777);
    char *partial = text("%s.%d", path, (int)getpid());
    FILE *file = fopen(partial, "wb");
    if (file) {
        const Image *image = &exact->image;
        CacheHeader header = {.width = image->width, .height = image->height, .rmse = exact->rmse};
        memcpy(header.magic, cache_magic, 8);
        size_t count = (size_t)image->width * image->height * 3;
        bool good = fwrite(&header, sizeof header, 1, file) == 1 &&
                    fwrite(image->pixels, sizeof(float), count, file) == count;
        good = fclose(file) == 0 && good;
        if (!good || rename(partial, path) != 0) remove(partial);
    }
    free(partial);
}

Exact truth_render(const Truth *truth, const Camera *camera, int width, int height, int samples,
                   PixelFilter filter) {
    Exact exact = {.image = image_create(width, height, 3)};
    int strata = (int)fmax(1.0, round(sqrt(samples / 2.0)));
    if (filter == FILTER_GAUSSIAN) strata *= 2; /* its support is four pixels large */
    Integral job = {truth,        camera, camera_rays(camera, width, height), filter, width, height, strata,
                    &exact.image, NULL};
    char *path = truth->key ? cache_path(&job) : NULL;
    if (!path || !cache_load(path, &exact)) {
        job.row_change = allocate((size_t)height, sizeof(double));
        parallel_for(height, render_row, &job);
        double sum = 0.0;
        for (int y = 0; y < height; y++) sum += job.row_change[y];
        exact.rmse = sqrt(sum / (3.0 * width * height));
        free(job.row_change);
        if (path && !stopped(truth)) cache_save(truth->cache, path, &exact);
    }
    free(path);
    return exact;
}

/* ---- Along the centres ---- */

typedef struct {
    const Truth *truth;
    Rays rays;
    int width, height;
    Sample *samples;
} Centres;

static void centres_row(void *context, int y) {
    const Centres *job = context;
    for (int x = 0; x < job->width && !stopped(job->truth); x++)
        job->samples[(size_t)y * job->width + x] =
            job->truth->sample(job->truth->scene, rays_at(&job->rays, x + 0.5, y + 0.5));
}

Sample *truth_centres(const Truth *truth, const Camera *camera, int width, int height) {
    Centres job = {truth, camera_rays(camera, width, height), width, height,
                   allocate((size_t)width * height, sizeof(Sample))};
    parallel_for(height, centres_row, &job);
    return job.samples;
}
