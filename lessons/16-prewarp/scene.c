#include "scene.h"

#include "fail.h"
#include "forward.h"
#include "inverse.h"
#include "normals.h"
#include "overflow.h"
#include "two_pass.h"

#include <stdlib.h>
#include <string.h>

/* ---- Loading ---- */

Image scene_resampled(const Image *image, int width, int height) {
    Image result = image_create(width, height, image->channels);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double texel[4];
            image_sample(image, (x + 0.5) / width, (y + 0.5) / height, texel);
            for (int c = 0; c < image->channels; c++) image_at(&result, x, y)[c] = (float)texel[c];
        }
    return result;
}

static int larger(int a, int b) { return a > b ? a : b; }

/* A source of as many texels as the larger of the wall's images has, and the normals of its heights. */
static void make_source(Prewarp *prewarp) {
    const Wall *wall = &prewarp->wall;
    const Image *colour = &wall->colour_image, *height = &wall->height_image;
    int columns = larger(colour->width, height->width), rows = larger(colour->height, height->height);
    Image colours = scene_resampled(colour, columns, rows), heights = scene_resampled(height, columns, rows);
    prewarp->normals = height_normals(&heights, wall->relief.scale, wall->relief.aspect);
    prewarp->source =
        source_create(&colours, &heights, &prewarp->normals, wall->relief.scale, wall->relief.base);
    image_destroy(&colours);
    image_destroy(&heights);
    double aspect = wall->relief.aspect; /* of the colour, whatever the height's */
    prewarp->source.aspect = aspect;
    prewarp->source.plane = (Plane){v3(-0.5, -0.5 * aspect, 0), v3(1, 0, 0), v3(0, aspect, 0), v3(0, 0, 1)};
}

/* The texels as they lie. */
static void write_plain(Prewarp *prewarp) {
    const Source *source = &prewarp->source;
    int width = source->width, height = source->height;
    Destination same = destination_create(width, height, v2(0, 0), v2(1, 1), true);
    memcpy(same.texels, source->texels, (size_t)width * height * sizeof *same.texels);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float *from = same.lookup + 3 * ((size_t)y * width + x);
            from[0] = (float)((x + 0.5) / width), from[1] = (float)((y + 0.5) / height);
            from[2] = (float)source->base; /* it lies in the polygon */
        }
    layer_write(&prewarp->plain, &same);
    layer_lay(&prewarp->plain, &source->plane, v2(0, 0), v2(1, 1));
    destination_destroy(&same);
}

static const double light_start = 120; /* degrees about the normal, from +u toward +v */

static Prewarp *load(const Options *options) {
    Prewarp *prewarp = allocate(1, sizeof *prewarp);
    wall_load(&prewarp->wall, options);
    prewarp->wall.relief.extent = RELIEF_CUT;
    prewarp->light_angle = radians(light_start);
    prewarp->ambient = 0.3;
    Mesh square = mesh_plane(1, 1, 1, 1);
    prewarp->square = shape_create(&square);
    mesh_destroy(&square);
    return prewarp;
}

static Prewarp *finish(Prewarp *prewarp) {
    make_source(prewarp);
    write_plain(prewarp);
    return prewarp;
}

void *scene_load(const Options *options) { return finish(load(options)); }

void *scene_load_overflow(const Options *options) {
    Prewarp *prewarp = load(options);
    prewarp->wall.relief.extent = RELIEF_SLAB;
    return finish(prewarp);
}

void *scene_load_bottom(const Options *options) {
    Prewarp *prewarp = load(options);
    prewarp->wall.relief.extent = RELIEF_SLAB;
    prewarp->wall.relief.base = 0.0;
    return finish(prewarp);
}

void scene_unload(void *data) {
    Prewarp *prewarp = data;
    layer_destroy(&prewarp->plain);
    for (int i = 0; i < LAYERS_MAX; i++) layer_destroy(&prewarp->layers[i]);
    for (int i = 0; i < 2; i++) destination_destroy(&prewarp->destinations[i]);
    source_destroy(&prewarp->source);
    image_destroy(&prewarp->normals);
    shape_destroy(&prewarp->square);
    wall_unload(&prewarp->wall);
    free(prewarp->figures);
    free(prewarp);
}

/* ---- Warping ---- */

Eye scene_eye(const Camera *camera) {
    if (camera->fov_y_degrees > 0.0) return (Eye){camera->eye, 1};
    return (Eye){vec3_normalize(vec3_sub(camera->eye, camera->target)), 0};
}

void scene_warp(const Prewarp *prewarp, Way way, Eye eye, Destination *destination) {
    static const struct {
        Visibility visibility;
        Filling filling;
    } forward[] = {
        [DEPTH_NONE] = {VISIBILITY_DEPTH_BUFFER, FILLING_NONE},
        [DEPTH_LINEAR] = {VISIBILITY_DEPTH_BUFFER, FILLING_LINEAR},
        [DEPTH_SPLAT] = {VISIBILITY_DEPTH_BUFFER, FILLING_SPLAT},
        [ORDER_NONE] = {VISIBILITY_OCCLUSION_ORDER, FILLING_NONE},
        [ORDER_LINEAR] = {VISIBILITY_OCCLUSION_ORDER, FILLING_LINEAR},
        [ORDER_SPLAT] = {VISIBILITY_OCCLUSION_ORDER, FILLING_SPLAT},
        [AUXILIARY] = {VISIBILITY_OCCLUSION_ORDER, FILLING_LINEAR},
        [RESIZED] = {VISIBILITY_OCCLUSION_ORDER, FILLING_LINEAR},
    };
    const Source *source = &prewarp->source;
    PrewarpFactors factors = prewarp_factors(&source->plane, eye);
    if (way == TWO_PASS)
        warp_two_pass(source, &factors, destination, NULL);
    else if (way == INVERSE)
        warp_inverse(source, &factors, destination);
    else
        warp_forward(source, &factors, forward[way].visibility, forward[way].filling, destination, NULL);
}

/* The one over the polygon, of the source's size. */
static Destination *polygon_destination(Prewarp *prewarp, bool lookup) {
    Destination *destination = &prewarp->destinations[lookup];
    if (!destination->texels)
        *destination =
            destination_create(prewarp->source.width, prewarp->source.height, v2(0, 0), v2(1, 1), lookup);
    return destination;
}

static void add_layer(Prewarp *prewarp, const Plane *plane, const Destination *destination) {
    Layer *layer = &prewarp->layers[prewarp->layer_count++];
    layer_write(layer, destination);
    layer_lay(layer, plane, destination->low, destination->high);
}

static void add_warped(Prewarp *prewarp, Way way, Eye eye, Destination *destination) {
    scene_warp(prewarp, way, eye, destination);
    add_layer(prewarp, &prewarp->source.plane, destination);
}

static void add_auxiliaries(Prewarp *prewarp, const PrewarpFactors *factors, Eye eye, bool lookup) {
    const Source *source = &prewarp->source;
    Displacements displacements = overflow_displacements(source);
    for (int edge = 0; edge < EDGES; edge++) {
        if (!overflow_can(factors, displacements, edge)) continue;
        Auxiliary auxiliary = auxiliary_create(source, edge, lookup);
        auxiliary_warp(source, eye, &auxiliary);
        add_layer(prewarp, &auxiliary.plane, &auxiliary.destination);
        auxiliary_destroy(&auxiliary);
    }
}

void scene_prepare(const Frame *frame) {
    Prewarp *prewarp = frame->data;
    const Source *source = &prewarp->source;
    Way way = frame->technique->variant;
    Eye eye = scene_eye(&frame->camera);
    PrewarpFactors factors = prewarp_factors(&source->plane, eye);
    prewarp->layer_count = 0;
    if (!factors.possible || factors.behind) return;
    if (way == RESIZED) {
        Destination resized = overflow_destination(source, &factors, RESIZED_LIMIT, frame->looking);
        add_warped(prewarp, way, eye, &resized);
        destination_destroy(&resized);
    } else {
        add_warped(prewarp, way, eye, polygon_destination(prewarp, frame->looking));
    }
    if (way == AUXILIARY) add_auxiliaries(prewarp, &factors, eye, frame->looking);
}

/* ---- Drawing ---- */

Vec3 scene_light(const Prewarp *prewarp) {
    return vec3_normalize(v3(cos(prewarp->light_angle), sin(prewarp->light_angle), 0.7));
}

void scene_move(void *data, double seconds) {
    ((Prewarp *)data)->light_angle = radians(light_start + 36 * seconds);
}

void scene_draw(const Frame *frame) {
    const Prewarp *prewarp = frame->data;
    Program *program = frame->program;
    const Source *source = &prewarp->source;
    Vec3 light = scene_light(prewarp);
    program_vector(program, "light", light.x, light.y, light.z, prewarp->ambient);
    program_vector(program, "near", 8.0 / source->width, 8.0 / source->height, 0, 0);
    program_number(program, "scale", source->scale);
    program_number(program, "base", source->base);
    program_number(program, "aspect", source->aspect);
    program_integer(program, "looking", frame->looking);
    bool plain = frame->technique->variant == PLAIN;
    for (int i = 0; i < (plain ? 1 : prewarp->layer_count); i++) {
        layer_bind(plain ? &prewarp->plain : &prewarp->layers[i], program);
        shape_draw(&prewarp->square);
    }
}

/* ---- The truth ---- */

Sample scene_truth(const void *data, Ray ray) {
    const Prewarp *prewarp = data;
    Sample sample = wall_truth(&prewarp->wall, ray);
    if (!sample.hit) return sample;
    Vec3 normal = vec3_normalize(truth_colour(&prewarp->normals, sample.u, sample.v));
    double lit = fmax(vec3_dot(normal, scene_light(prewarp)), 0.0);
    sample.colour = vec3_scale(sample.colour, prewarp->ambient + (1.0 - prewarp->ambient) * lit);
    return sample;
}

Vec2 scene_texels(const void *data) {
    const Prewarp *prewarp = data;
    return v2(prewarp->wall.height_image.width, prewarp->wall.height_image.height);
}
