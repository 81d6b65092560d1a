#include "plane.h"

#include "context.h"
#include "fail.h"

#include <stdlib.h>

/* ---- The image ---- */

static Plane *plane_of(Image image) {
    Plane *plane = allocate(1, sizeof *plane);
    plane->image = image;
    plane->aspect = (double)image.height / image.width;
    return plane;
}

void *plane_load(const Options *options) { return plane_of(image_load(options->colour, IMAGE_COLOUR)); }

static Plane *load_outlier(const Options *options, int size) {
    Image tile = image_load(options->colour, IMAGE_COLOUR), image = image_create(size, size, 1);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++)
            *image_at(&image, x, y) = image_at(&tile, x % tile.width, y % tile.height)[1];
    *image_at(&image, size / 4, size / 4) = 1e5f;
    image_destroy(&tile);
    return plane_of(image);
}

void *plane_load_1024(const Options *options) { return load_outlier(options, 1024); }
void *plane_load_4096(const Options *options) { return load_outlier(options, 4096); }

Vec2 plane_texels(const void *data) {
    const Plane *plane = data;
    return v2(plane->image.width, plane->image.height);
}

/* ---- What is made of it ---- */

static Texture upload(const Chain *chain) {
    Texture texture = texture_create(chain->levels, chain->count, TEXTURE_FLOAT,
                                     chain->count > 1 ? TEXTURE_TRILINEAR : TEXTURE_LINEAR);
    if (chain->levels[0].channels == 1) { /* red alone is grey */
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_G, GL_RED);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_B, GL_RED);
    }
    return texture;
}

static Texture upload_one(const Image *image) { return upload(&(Chain){1, {*image}}); }

Chain plane_download(const Texture *texture, const Image *base) {
    Chain chain = {.count = texture->levels, .levels = {*base}};
    gl.BindTexture(GL_TEXTURE_2D, texture->id);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.Finish(); /* llvmpipe does not wait by itself for levels that it is still drawing */
    for (int k = 1; k < chain.count; k++) {
        int width = base->width >> k, height = base->height >> k;
        chain.levels[k] = image_create(width ? width : 1, height ? height : 1, base->channels);
        gl.GetTexImage(GL_TEXTURE_2D, k, base->channels == 1 ? GL_RED : GL_RGB, GL_FLOAT,
                       chain.levels[k].pixels);
    }
    draw_check("reading a chain");
    return chain;
}

static Reading reading_create(const Plane *plane, Reads reads) {
    Reading reading = {.chain = {.count = 1, .levels = {plane->image}}};
    if (reads == READS_BOX) reading.chain = chain_create(&plane->image, CHAIN_BOX);
    if (reads == READS_SRGB_BOX) reading.chain = chain_create(&plane->image, CHAIN_SRGB_BOX);
    if (reads == READS_KAISER) reading.chain = chain_create(&plane->image, CHAIN_KAISER);
    if (reads == READS_TABLE || reads == READS_NAIVE_TABLE) {
        SummedArea table = reads == READS_TABLE ? summed_area_create(&plane->image)
                                                : summed_area_create_naive(&plane->image);
        reading.high = upload_one(&table.high);
        reading.low = upload_one(&table.low);
        summed_area_destroy(&table);
    } else {
        reading.image = upload(&reading.chain);
    }
    if (reads == READS_OPENGL) {
        texture_mipmap(&reading.image);
        reading.chain = plane_download(&reading.image, &plane->image);
    }
    return reading;
}

const Reading *plane_reading(Plane *plane, Reads reads) {
    Reading *reading = &plane->readings[reads];
    if (!reading->chain.count) *reading = reading_create(plane, reads);
    return reading;
}

void plane_unload(void *data) {
    Plane *plane = data;
    for (int i = 0; i < READS_COUNT; i++) {
        Reading *reading = &plane->readings[i];
        if (reading->image.id) texture_destroy(&reading->image);
        if (reading->high.id) texture_destroy(&reading->high), texture_destroy(&reading->low);
        chain_destroy(&reading->chain);
    }
    image_destroy(&plane->image);
    free(plane);
}

/* ---- From pixels to the texture ---- */

/* What the matrix does to one point of the picture. A ray o + t d meets z = 0 where t = -o.z / d.z; with
 * w = -d.z that is (o w + d o.z) / w. Either all rays have one o and their d, left as long as the picture
 * plane makes it, is linear in the pixel, or all have one d and o is linear: so is the whole. */
static Vec3 carried(const Plane *plane, const Camera *camera, int width, int height, double x, double y) {
    Ray ray = camera_ray(camera, width, height, x, y);
    Vec3 forward = vec3_normalize(vec3_sub(camera->target, camera->eye)), o = ray.origin;
    Vec3 d = vec3_scale(ray.direction, 1.0 / vec3_dot(ray.direction, forward));
    double side = camera->eye.z < 0.0 ? -1.0 : 1.0, w = -d.z * side; /* seen from below, it is still there */
    Vec3 p = vec3_add(vec3_scale(o, w), vec3_scale(d, o.z * side));
    return v3(p.x + 0.5 * w, p.y / plane->aspect + 0.5 * w, w);
}

Homography plane_homography(const Plane *plane, const Camera *camera, int width, int height) {
    Vec3 origin = carried(plane, camera, width, height, 0, 0);
    Vec3 right = carried(plane, camera, width, height, width, 0);
    Vec3 up = carried(plane, camera, width, height, 0, height);
    Vec3 x = vec3_scale(vec3_sub(right, origin), 1.0 / width);
    Vec3 y = vec3_scale(vec3_sub(up, origin), 1.0 / height);
    return (Homography){v3(x.x, y.x, origin.x), v3(x.y, y.y, origin.y), v3(x.z, y.z, origin.z)};
}

void plane_draw(const Frame *frame) {
    Plane *plane = frame->data;
    const Camera *camera = &frame->camera;
    Homography h = plane_homography(plane, camera, frame->width, frame->height);
    const double columns[9] = {h.u.x, h.v.x, h.w.x, h.u.y, h.v.y, h.w.y, h.u.z, h.v.z, h.w.z};
    float matrix[9];
    for (int i = 0; i < 9; i++) matrix[i] = (float)columns[i];
    program_matrix(frame->program, "homography", matrix, 3);
    program_vector(frame->program, "origin", camera->eye.x, camera->eye.y, camera->eye.z, plane->aspect);
    const Reading *reading = plane_reading(plane, frame->technique->variant);
    program_texture(frame->program, "image", &reading->image);
    program_texture(frame->program, "high", &reading->high);
    program_texture(frame->program, "low", &reading->low);
    draw_everywhere();
}

/* ---- The truth ---- */

Sample plane_truth(const void *data, Ray ray) {
    const Plane *plane = data;
    double t = -ray.origin.z / ray.direction.z;
    if (!(t > 0.0) || isinf(t)) return (Sample){0};
    Vec3 p = ray_at(ray, t);
    Sample sample = {.u = p.x + 0.5, .v = p.y / plane->aspect + 0.5, .depth = t, .hit = true};
    sample.colour = truth_colour(&plane->image, sample.u, sample.v);
    return sample;
}
