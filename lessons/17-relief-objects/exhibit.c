#include "exhibit.h"

#include "fail.h"
#include "mesh_rays.h"
#include "object.h"
#include "toy_mesh.h"

#include <stdlib.h>
#include <string.h>

enum { SAMPLES_USUAL = 2, MESH_SIDES = 128, SPEED_ROUNDS = 3, SPEED_VIEWS = 16 };

typedef struct {
    Box boxes[3]; /* by Walls; WALLS_SHARED always there, the others loaded when first asked for */
    Warp warp;
    Texture colours[FACES], normals[FACES];
    Shape faces[FACES]; /* the box's, to be textured */
    Shape shape;        /* the object's mesh */
    Mesh mesh;
    MeshRays *rays; /* NULL: the object is the toy of solids */
    Vec3 light;     /* the unit vector toward it */
    char *path;     /* of the front's file */
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

Vec3 exhibit_light(double seconds) {
    double angle = 2.0 * PI * seconds / 8.0, s = sin(angle), c = cos(angle);
    Vec3 from = first_light;
    return v3(c * from.x + s * from.z, from.y, c * from.z - s * from.x);
}

void exhibit_move(void *data, double seconds) { ((Exhibit *)data)->light = exhibit_light(seconds); }

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

static Exhibit *load(const Options *options, Mesh mesh) {
    Exhibit *exhibit = allocate(1, sizeof *exhibit);
    exhibit->path = text("%s", options->colour);
    box_load(&exhibit->boxes[WALLS_SHARED], exhibit->path, WALLS_SHARED);
    for (int i = 0; i < FACES; i++)
        exhibit->faces[i] = face_shape(&exhibit->boxes[WALLS_SHARED].faces[i].plane);
    exhibit->mesh = mesh;
    exhibit->shape = shape_create(&mesh);
    exhibit_move(exhibit, 0.0);
    return exhibit;
}

void *exhibit_load_solids(const Options *options) { return load(options, toy_mesh(MESH_SIDES)); }

void *exhibit_load_bunny(const Options *options) {
    Vec3 box;
    Mesh mesh = bunny_load(options->other[0], &box);
    for (int i = 0; i < mesh.vertex_count; i++) mesh.vertices[i].tangent[3] = 1.0f; /* see mesh.frag */
    Exhibit *exhibit = load(options, mesh);
    exhibit->rays = mesh_rays_create(&exhibit->mesh);
    return exhibit;
}

static void destroy_warp(Exhibit *exhibit) {
    if (!exhibit->warp.size) return;
    for (int i = 0; i < FACES; i++) {
        texture_destroy(&exhibit->colours[i]);
        texture_destroy(&exhibit->normals[i]);
    }
    warp_destroy(&exhibit->warp);
}

void exhibit_unload(void *data) {
    Exhibit *exhibit = data;
    destroy_warp(exhibit);
    for (int i = 0; i < 3; i++) box_destroy(&exhibit->boxes[i]);
    for (int i = 0; i < FACES; i++) shape_destroy(&exhibit->faces[i]);
    shape_destroy(&exhibit->shape);
    if (exhibit->rays) mesh_rays_destroy(exhibit->rays);
    mesh_destroy(&exhibit->mesh);
    free(exhibit->path);
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
    for (int i = 0; i < FACES; i++) {
        exhibit->colours[i] = texture_empty(size, size, TEXTURE_RGBA16, TEXTURE_LINEAR);
        exhibit->normals[i] = texture_empty(size, size, TEXTURE_RGBA16, TEXTURE_LINEAR);
    }
}

/* Each face's own texels, as they lie. */
static void copy_flat(Warp *warp, const Box *box, Eye eye) {
    Seen seen = box_faces_seen(box, eye);
    warp->count = seen.count;
    for (int i = 0; i < seen.count; i++) {
        Destination *destination = &warp->destinations[i];
        const Face *face = &box->faces[seen.faces[i]];
        destination->face = seen.faces[i];
        for (size_t k = 0; k < (size_t)warp->size * warp->size; k++) {
            size_t x = k % warp->size * face->width / warp->size,
                   y = k / warp->size * face->height / warp->size;
            size_t texel = y * face->width + x;
            const Texel *from = &box->texels[isnan(face->d[texel]) ? 0 : face->first + texel];
            memcpy(destination->colour + 4 * k, from->values, 4 * sizeof(uint16_t));
            memcpy(destination->normal + 4 * k, from->values + 4, 4 * sizeof(uint16_t));
        }
    }
}

static Parts parts_of(const Box *box, int variant, Eye eye) {
    Parts parts = {.sources = (1u << FACES) - 1, .rims = variant != EXHIBIT_CELLS};
    if (variant == EXHIBIT_FRONTS) {
        Seen seen = box_faces_seen(box, eye);
        parts.sources = 0;
        for (int i = 0; i < seen.count; i++) parts.sources |= 1u << seen.faces[i];
    }
    return parts;
}

static const Box *box_for(Exhibit *exhibit, int variant) {
    Walls walls = variant == EXHIBIT_BRIDGED  ? WALLS_BRIDGED
                  : variant == EXHIBIT_FRONTS ? WALLS_KEPT
                                              : WALLS_SHARED;
    if (!exhibit->boxes[walls].texels) box_load(&exhibit->boxes[walls], exhibit->path, walls);
    return &exhibit->boxes[walls];
}

void exhibit_prepare(const Frame *frame) {
    Exhibit *exhibit = frame->data;
    Warp *warp = &exhibit->warp;
    Eye eye = exhibit_eye(&frame->camera);
    int variant = frame->technique->variant, samples = frame->knob > 0.0 ? (int)frame->knob : SAMPLES_USUAL;
    bool whole = !(frame->knob > 0.0) || samples == frame->knob;
    if (!whole || (samples != 1 && samples != 2 && samples != 4))
        fail("%g samples: there are 1, 2 or 4", frame->knob);
    use_warp(exhibit, exhibit->boxes[WALLS_SHARED].faces[0].width, samples);
    const Box *box = box_for(exhibit, variant);
    if (variant == EXHIBIT_FLAT)
        copy_flat(warp, box, eye);
    else
        warp_box(warp, box, eye, parts_of(box, variant, eye));
    for (int i = 0; i < warp->count; i++) {
        texture_write(&exhibit->colours[i], TEXTURE_RGBA16, warp->destinations[i].colour);
        texture_write(&exhibit->normals[i], TEXTURE_RGBA16, warp->destinations[i].normal);
    }
}

void exhibit_draw(const Frame *frame) {
    const Exhibit *exhibit = frame->data;
    Vec3 light = exhibit->light, background = frame->scene->background;
    program_vector(frame->program, "light", light.x, light.y, light.z, 0.0);
    program_vector(frame->program, "background", background.x, background.y, background.z, 0.0);
    if (frame->technique->variant == EXHIBIT_MESH) {
        shape_draw(&exhibit->shape);
        return;
    }
    for (int i = 0; i < exhibit->warp.count; i++) {
        frame->program->units = 0;
        program_texture(frame->program, "colour_map", &exhibit->colours[i]);
        program_texture(frame->program, "normal_map", &exhibit->normals[i]);
        shape_draw(&exhibit->faces[exhibit->warp.destinations[i].face]);
    }
}

/* ---- The lesson's own metrics ---- */

/* Pixels whose centre the picture covers and the truth does not, or the other way round, over those that the
 * truth covers. */
static double silhouette_error(const Shots *shots, const Shot *shot, double *fill) {
    size_t count = (size_t)shots->frame->width * shots->frame->height, covered = 0, wrong = 0;
    for (size_t i = 0; i < count; i++) {
        covered += shot->centres[i].hit;
        wrong += shot->centres[i].hit != (shot->picture.lookup.pixels[4 * i + 3] > 0.5f);
    }
    *fill = 100.0 * (double)covered / (double)count;
    return 100.0 * (double)wrong / fmax((double)covered, 1.0);
}

static void add_silhouettes(const Shots *shots, Table *table) {
    double worst = 0.0, sum = 0.0;
    for (int i = 0; i < shots->count; i++) {
        double fill, error = silhouette_error(shots, &shots->shots[i], &fill);
        table_add(table, shots, shots->shots[i].view, "silhouette_error_percent", error, "%");
        table_add(table, shots, shots->shots[i].view, "fill_percent", fill, "%");
        worst = fmax(worst, error);
        sum += error;
    }
    table_add(table, shots, NULL, "silhouette_error_percent", worst, "%");
    table_add(table, shots, NULL, "silhouette_error_mean_percent", sum / shots->count, "%");
}

/* Direction i of n, spread evenly over the sphere: each next one turned by the golden angle. */
static Vec3 spread(int i, int n) {
    double y = 1.0 - (2.0 * i + 1.0) / n, ring = sqrt(1.0 - y * y), angle = i * PI * (3.0 - sqrt(5.0));
    return v3(ring * sin(angle), y, ring * cos(angle));
}

/* Each frame from another side, nothing kept from the last: the fastest of the rounds. */
static void add_speed(const Shots *shots, Table *table) {
    Camera camera = shots->frame->camera;
    double distance = vec3_length(camera.eye), best_ns = INFINITY;
    Cost best = {0};
    camera.up = v3(0, 1, 0);
    for (int round = 0; round < SPEED_ROUNDS; round++) {
        Cost sum = {0};
        for (int i = 0; i < SPEED_VIEWS; i++) {
            camera.eye = vec3_scale(spread(i, SPEED_VIEWS), distance);
            Cost cost = shots_time(shots, &camera);
            sum.prepare_ns += cost.prepare_ns / SPEED_VIEWS;
            sum.draw_ns += cost.draw_ns / SPEED_VIEWS;
        }
        if (sum.prepare_ns + sum.draw_ns >= best_ns) continue;
        best = sum;
        best_ns = sum.prepare_ns + sum.draw_ns;
    }
    table_add(table, shots, NULL, "frames_per_second", 1e9 / best_ns, "1/s");
    table_add(table, shots, NULL, "frame_prepare_ms", best.prepare_ns * 1e-6, "ms");
    table_add(table, shots, NULL, "frame_draw_ms", best.draw_ns * 1e-6, "ms");
}

/* In memory, as little as holds it: of a relief three bytes of colour and two of height a texel; of a mesh
 * three floats of position and three of normal a vertex, and three indices a triangle, without any colour. */
static double bytes(const Exhibit *exhibit, bool mesh) {
    if (mesh) return 24.0 * exhibit->mesh.vertex_count + 4.0 * exhibit->mesh.index_count;
    return 5.0 * (double)(exhibit->boxes[WALLS_SHARED].texel_count - 1);
}

void exhibit_measure(const Shots *shots, Table *table) {
    add_silhouettes(shots, table);
    int variant = shots->frame->technique->variant;
    bool mesh = variant == EXHIBIT_MESH;
    if ((mesh || variant == EXHIBIT_ALL) && shots_want(shots, NULL, "frames_per_second"))
        add_speed(shots, table);
    table_add(table, shots, NULL, "bytes", bytes(shots->frame->data, mesh), "bytes");
}
