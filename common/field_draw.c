#include "field_draw.h"

#include "fail.h"

#include <stdlib.h>
#include <string.h>

/* ---- Pages ---- */

enum { PAGE_SIDE = 16384, PAGE_BYTES = 768 << 20 };

FieldTexture field_texture_create(const Field *field) {
    FieldTexture texture = {.field = *field, .columns = field->u, .rows = field->v};
    while (texture.columns * field->s > PAGE_SIDE) texture.columns = (texture.columns + 1) / 2;
    while (texture.rows * field->t > PAGE_SIDE ||
           4.0 * texture.columns * field->s * texture.rows * field->t > PAGE_BYTES)
        texture.rows = (texture.rows + 1) / 2;
    texture.across = (field->u + texture.columns - 1) / texture.columns;
    texture.count = texture.across * ((field->v + texture.rows - 1) / texture.rows);
    if (texture.count > FIELD_PAGES)
        fail("a light field of %dx%dx%dx%d: does not fit in %d textures", field->u, field->v, field->s,
             field->t, FIELD_PAGES);
    for (int i = 0; i < texture.count; i++)
        texture.pages[i] = texture_empty(texture.columns * field->s, texture.rows * field->t, TEXTURE_SRGBA8,
                                         TEXTURE_LINEAR);
    return texture;
}

/* From blocks one after another to rows of texels, as a texture has them. */
void field_texture_write(const FieldTexture *texture, int first, int rows, const uint8_t *texels) {
    const Field *field = &texture->field;
    size_t line = (size_t)field->s * FIELD_TEXEL, width = line * (size_t)texture->columns;
    uint8_t *part = allocate((size_t)field->t, width);
    for (int row = 0; row < rows; row++)
        for (int page_u = 0; page_u < texture->across; page_u++) {
            int from = page_u * texture->columns, v = first + row;
            int columns = field->u - from < texture->columns ? field->u - from : texture->columns;
            for (int u = 0; u < columns; u++) {
                const uint8_t *block =
                    texels + field_row(field) * (size_t)row + field_block(field) * (size_t)(from + u);
                for (int t = 0; t < field->t; t++)
                    memcpy(part + (size_t)t * line * (size_t)columns + (size_t)u * line,
                           block + (size_t)t * line, line);
            }
            const Texture *page = &texture->pages[v / texture->rows * texture->across + page_u];
            texture_write_part(page, TEXTURE_SRGB8, 0, v % texture->rows * field->t, columns * field->s,
                               field->t, part);
        }
    free(part);
}

void field_texture_destroy(FieldTexture *texture) {
    for (int i = 0; i < texture->count; i++) texture_destroy(&texture->pages[i]);
    *texture = (FieldTexture){0};
}

size_t field_texture_bytes(const FieldTexture *texture) {
    size_t bytes = 0;
    for (int i = 0; i < texture->count; i++)
        bytes += (size_t)4 * (size_t)texture->pages[i].width * (size_t)texture->pages[i].height;
    return bytes;
}

void field_texture_bind(Program *program, const FieldTexture *texture) {
    static const char *const names[FIELD_PAGES] = {"page", "page1", "page2", "page3"};
    for (int i = 0; i < texture->count; i++) program_texture(program, names[i], &texture->pages[i]);
    program_vector(program, "page_blocks", texture->columns, texture->rows, texture->across, 0);
}

/* ---- Uniforms ---- */

static void set(const Program *program, const char *name, Vec3 v, double w) {
    program_vector(program, name, v.x, v.y, v.z, w);
}

void field_uniforms(const Frame *frame, const Field *field) {
    const Program *program = frame->program;
    Rays rays = camera_rays(&frame->camera, frame->width, frame->height);
    set(program, "ray_fixed", rays.fixed, rays.perspective ? 1 : 0);
    set(program, "ray_middle", rays.middle, 0);
    set(program, "ray_right", rays.right, 0);
    set(program, "ray_up", rays.up, 0);
    program_vector(program, "count", field->u, field->v, field->s, field->t);
    double theta = 2 * PI / field->u, phi = field->model == FIELD_CYLINDER ? 0.0 : PI / field->v;
    program_vector(program, "steps", sin(theta), cos(theta), sin(phi), cos(phi));
    program_vector(program, "window", field->radius, field->model == FIELD_CYLINDER ? field->height : 0,
                   field->model == FIELD_ROOM ? 1 : -1, 0);
}

/* ---- The truth ---- */

/* The distance at which a ray from outside enters the cylinder of that radius and height through its side, or
 * a sphere is met; -1 where it is not. */
static double model_depth(const Field *field, Ray ray) {
    Vec3 o = ray.origin, d = ray.direction;
    bool round = field->model != FIELD_CYLINDER;
    double a = round ? 1.0 : d.x * d.x + d.z * d.z, b = o.x * d.x + o.z * d.z + (round ? o.y * d.y : 0.0);
    double c = o.x * o.x + o.z * o.z + (round ? o.y * o.y : 0.0) - field->radius * field->radius;
    double inside = b * b - a * c;
    if (!(inside >= 0.0 && a > 0.0)) return -1.0;
    double depth = (field->model == FIELD_ROOM ? -b + sqrt(inside) : -b - sqrt(inside)) / a;
    if (!round && fabs(o.y + depth * d.y) > 0.5 * field->height) return -1.0;
    return depth;
}

Sample field_truth(const Field *field, const LightScene *scene, Ray ray) {
    double depth = model_depth(field, ray);
    if (!(depth >= -1e-12 * field->radius)) return (Sample){0}; /* an eye on the model sees it */
    depth = fmax(depth, 0.0);
    SolidHit hit;
    bool met;
    Vec2 place = field_place(field, ray_at(ray, depth));
    return (Sample){.colour = light_along(scene, ray, &hit, &met),
                    .u = place.x,
                    .v = place.y,
                    .depth = depth,
                    .hit = true};
}
