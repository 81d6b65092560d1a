#include "exhibit.h"

#include "fail.h"
#include "mesh_rays.h"
#include "object.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    Box box;
    Warp warp;
    Texture colours[DESTINATIONS], normals[DESTINATIONS];
    Shape faces[FACES]; /* the box's, to be textured */
    Shape shape;        /* the object's mesh */
    Mesh mesh;
    MeshRays *rays; /* NULL: the object is the toy of solids */
    Vec3 light;     /* the unit vector toward it */
} Exhibit;

/* ---- The light, as light.glsl has it ---- */

static const Vec3 first_light = {0.4, 0.7, 0.59160797830996160};

static Vec3 lit(Vec3 colour, Vec3 normal, Vec3 to_light, Vec3 to_eye) {
    double facing = vec3_dot(normal, to_light);
    if (facing <= 0.0) return vec3_scale(colour, 0.25);
    double along = fmax(vec3_dot(normal, vec3_normalize(vec3_add(to_light, to_eye))), 0.0);
    double highlight = 0.25 * facing * pow(along, 40.0);
    return vec3_add(vec3_scale(colour, 0.25 + 0.6 * facing), v3(highlight, highlight, highlight));
}

/* Once around the vertical axis in eight seconds. */
void exhibit_move(void *data, double seconds) {
    double angle = 2.0 * PI * seconds / 8.0, s = sin(angle), c = cos(angle);
    Vec3 from = first_light;
    ((Exhibit *)data)->light = v3(c * from.x + s * from.z, from.y, c * from.z - s * from.x);
}

/* ---- The truth: rays against the object itself ---- */

Sample exhibit_truth(const void *data, Ray ray) {
    const Exhibit *exhibit = data;
    SolidHit hit;
    MeshHit mesh_hit;
    if (exhibit->rays ? !mesh_rays_hit(exhibit->rays, ray, &mesh_hit)
                      : !solids_hit(toy_solids, TOY_SOLIDS, ray, &hit))
        return (Sample){0};
    double depth = exhibit->rays ? mesh_hit.depth : hit.depth;
    Vec3 normal = exhibit->rays ? mesh_hit.normal : hit.normal, at = ray_at(ray, depth);
    Vec3 colour = exhibit->rays ? bunny_colour(at) : toy_colour(&toy_solids[hit.index], at);
    return (Sample){.colour = lit(colour, normal, exhibit->light, vec3_scale(ray.direction, -1.0)),
                    .depth = depth,
                    .hit = true};
}

/* ---- Loading ---- */

/* A face of the box as a rectangle, its corners where the plane has them. */
static Shape face_shape(const Plane *plane) {
    Mesh mesh = mesh_plane(1.0, 1.0, 1, 1);
    for (int i = 0; i < mesh.vertex_count; i++) {
        Vertex *vertex = &mesh.vertices[i];
        Vec3 along = vec3_add(vec3_scale(plane->a, vertex->uv[0]), vec3_scale(plane->b, vertex->uv[1]));
        Vec3 at = vec3_add(plane->origin, along);
        const double xyz[] = {at.x, at.y, at.z};
        for (int k = 0; k < 3; k++) vertex->position[k] = (float)xyz[k];
    }
    Shape shape = shape_create(&mesh);
    mesh_destroy(&mesh);
    return shape;
}

static Exhibit *load(const Options *options) {
    Exhibit *exhibit = allocate(1, sizeof *exhibit);
    box_load(&exhibit->box, options->colour, DEFAULT_BRIDGE);
    for (int i = 0; i < FACES; i++) exhibit->faces[i] = face_shape(&exhibit->box.faces[i].plane);
    exhibit_move(exhibit, 0.0);
    return exhibit;
}

void *exhibit_load_solids(const Options *options) { return load(options); }

void *exhibit_load_bunny(const Options *options) {
    Exhibit *exhibit = load(options);
    Vec3 box;
    exhibit->mesh = bunny_load(options->other[0], &box);
    exhibit->rays = mesh_rays_create(&exhibit->mesh);
    return exhibit;
}

static void destroy_warp(Exhibit *exhibit) {
    if (!exhibit->warp.size) return;
    for (int i = 0; i < DESTINATIONS; i++) {
        texture_destroy(&exhibit->colours[i]);
        texture_destroy(&exhibit->normals[i]);
    }
    warp_destroy(&exhibit->warp);
}

void exhibit_unload(void *data) {
    Exhibit *exhibit = data;
    destroy_warp(exhibit);
    box_destroy(&exhibit->box);
    for (int i = 0; i < FACES; i++) shape_destroy(&exhibit->faces[i]);
    if (exhibit->shape.index_count) shape_destroy(&exhibit->shape);
    if (exhibit->rays) mesh_rays_destroy(exhibit->rays);
    mesh_destroy(&exhibit->mesh);
    free(exhibit);
}

/* ---- Drawing ---- */

Eye exhibit_eye(const Camera *camera) {
    if (camera->fov_y_degrees > 0.0) return (Eye){camera->eye, 1.0};
    return (Eye){vec3_normalize(vec3_sub(camera->eye, camera->target)), 0.0};
}

static void use_warp(Exhibit *exhibit, int size, int samples) {
    if (exhibit->warp.size == size && exhibit->warp.samples == samples) return;
    destroy_warp(exhibit);
    exhibit->warp = warp_create(size, samples);
    for (int i = 0; i < DESTINATIONS; i++) {
        exhibit->colours[i] = texture_empty(size, size, TEXTURE_RGBA16, TEXTURE_LINEAR);
        exhibit->normals[i] = texture_empty(size, size, TEXTURE_RGBA16, TEXTURE_LINEAR);
    }
}

void exhibit_prepare(const Frame *frame) {
    Exhibit *exhibit = frame->data;
    int samples = frame->knob > 0.0 ? (int)frame->knob : 2;
    use_warp(exhibit, exhibit->box.faces[0].width, samples);
    if (!warp_box(&exhibit->warp, &exhibit->box, exhibit_eye(&frame->camera), ~0u))
        fail("%s: the eye is in the box, and the faces show nothing from inside", frame->view->name);
    for (int i = 0; i < exhibit->warp.count; i++) {
        texture_write(&exhibit->colours[i], TEXTURE_RGBA16, exhibit->warp.destinations[i].colour);
        texture_write(&exhibit->normals[i], TEXTURE_RGBA16, exhibit->warp.destinations[i].normal);
    }
}

void exhibit_draw(const Frame *frame) {
    const Exhibit *exhibit = frame->data;
    Vec3 light = exhibit->light, background = frame->scene->background;
    program_vector(frame->program, "light", light.x, light.y, light.z, 0.0);
    program_vector(frame->program, "background", background.x, background.y, background.z, 0.0);
    for (int i = 0; i < exhibit->warp.count; i++) {
        frame->program->units = 0;
        program_texture(frame->program, "colour_map", &exhibit->colours[i]);
        program_texture(frame->program, "normal_map", &exhibit->normals[i]);
        shape_draw(&exhibit->faces[exhibit->warp.destinations[i].face]);
    }
}

/* ---- The lesson's own metrics ---- */

/* Pixels that differ in coverage over those that the truth covers. */
static double silhouette_error(const Shots *shots, const Shot *shot) {
    size_t count = (size_t)shots->frame->width * shots->frame->height, covered = 0, wrong = 0;
    for (size_t i = 0; i < count; i++) {
        covered += shot->centres[i].hit;
        wrong += shot->centres[i].hit != (shot->picture.lookup.pixels[4 * i + 3] > 0.5f);
    }
    return 100.0 * (double)wrong / (double)covered;
}

static double fill(const Shots *shots, const Shot *shot) {
    size_t count = (size_t)shots->frame->width * shots->frame->height, covered = 0;
    for (size_t i = 0; i < count; i++) covered += shot->centres[i].hit;
    return 100.0 * (double)covered / (double)count;
}

void exhibit_measure(const Shots *shots, Table *table) {
    double worst = 0.0, sum = 0.0;
    for (int i = 0; i < shots->count; i++) {
        double error = silhouette_error(shots, &shots->shots[i]);
        table_add(table, shots, shots->shots[i].view, "silhouette_error_percent", error, "%");
        table_add(table, shots, shots->shots[i].view, "fill_percent", fill(shots, &shots->shots[i]), "%");
        worst = fmax(worst, error);
        sum += error;
    }
    table_add(table, shots, NULL, "silhouette_error_percent", worst, "%");
    table_add(table, shots, NULL, "silhouette_error_mean_percent", sum / shots->count, "%");
}
