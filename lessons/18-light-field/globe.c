#include "globe.h"

#include "fail.h"
#include "fields.h"
#include "judge.h"
#include "solids.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- The scenes, by their names ---- */

enum { SAMPLES_USUAL = 7, MADE = 8 };

#define SIZE(nu, nv, ns, nt) .radius = 3.5, .u = nu, .v = nv, .s = ns, .t = nt

static const struct {
    const char *name;
    Recipe recipe;
} scenes[] = {
    {"composed", {&light_composed, {FIELD_SPHERE, SIZE(128, 64, 64, 64)}, SAMPLES_USUAL, false, false}},
    {"effects", {&light_effects, {FIELD_SPHERE, SIZE(128, 64, 64, 64)}, SAMPLES_USUAL, false, false}},
    {"aliasing", {&light_aliasing, {FIELD_SPHERE, SIZE(256, 128, 32, 32)}, SAMPLES_USUAL, false, false}},
    {"figure-7", {&light_composed, {FIELD_SPHERE, SIZE(128, 64, 64, 64)}, SAMPLES_USUAL, false, false}},
    {"placements", {&light_placements, {FIELD_SPHERE, SIZE(128, 64, 64, 64)}, SAMPLES_USUAL, true, false}},
    {"cylinder",
     {&light_composed, {FIELD_CYLINDER, .height = 6, SIZE(128, 48, 64, 64)}, SAMPLES_USUAL, false, false}},
    {"panorama", {&light_around, {FIELD_ROOM, SIZE(128, 64, 64, 64)}, SAMPLES_USUAL, false, false}},
};

static const Recipe *recipe_named(const char *name) {
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        if (strcmp(scenes[i].name, name) == 0) return &scenes[i].recipe;
    fail("%s: no light field is made for this scene", name);
}

void globe_list(const Scene *scene) {
    const Recipe *recipe = recipe_named(scene->name);
    field_list(&recipe->field);
    printf("  rays %d a texel%s\n", recipe->samples, recipe->through ? ", from outside of everything" : "");
    light_scene_list(recipe->scene);
}

/* ---- Loading ---- */

typedef struct {
    Recipe usual;
    Made made[MADE]; /* in the order in which they were asked for */
    int count;
    Texture solids;
    SolidKinds kinds;
    char *path; /* of the user's light field, which then is the usual one; NULL: there is none */
    FieldFile file;
} Globe;

/* A user's light field must be one of what the scene shows, or the truth would be of something else. */
static void read_file(Globe *globe, const char *path) {
    field_file_demand(field_file_open(&globe->file, path), path);
    const FieldHeader *header = &globe->file.header;
    Recipe *usual = &globe->usual;
    const Field *field = &header->field, *own = &usual->field;
    FieldHeader expected = field_header(field, usual->scene, header->samples, usual->through);
    if (header->codec != FIELD_RAW) fail("%s: is encoded; lesson 19 reads such files", path);
    if (!field_header_equal(header, &expected))
        fail("%s: is a light field of %s, not of the scene %s", path, header->scene, usual->scene->name);
    if (field->model != own->model || field->radius != own->radius || field->height != own->height)
        fail("%s: is on another model than the scene %s has", path, usual->scene->name);
    if (field->angles != ANGLES_LINEAR) fail("%s: its angles are not linear", path);
    globe->path = text("%s", path);
    usual->field = header->field;
    usual->samples = header->samples;
}

void *globe_load(const Options *options) {
    Globe *globe = allocate(1, sizeof *globe);
    globe->usual = *recipe_named(options->scene);
    if (options->colour) read_file(globe, options->colour);
    globe->solids = solids_texture(globe->usual.scene, &globe->kinds);
    return globe;
}

void globe_unload(void *data) {
    Globe *globe = data;
    for (int i = 0; i < globe->count; i++) field_unmake(&globe->made[i]);
    texture_destroy(&globe->solids);
    if (globe->path) field_file_close(&globe->file);
    free(globe->path);
    free(globe);
}

/* ---- The light field that a technique reads ---- */

static Recipe recipe_of(const Globe *globe, Reads reads, double knob) {
    Recipe recipe = globe->usual;
    if (globe->path && (reads == READS_USUAL || reads == READS_USUAL_PAGED)) return recipe;
    if (knob > 0.0) recipe.samples = (int)knob;
    Field *field = &recipe.field;
    recipe.flat = reads != READS_USUAL && reads != READS_USUAL_PAGED && reads != READS_64_32_256_256;
    if (reads == READS_SINE) field->angles = ANGLES_SINE;
    if (reads == READS_STEREOGRAPHIC) field->angles = ANGLES_STEREOGRAPHIC;
    if (reads == READS_PLAIN_LIGHT) recipe.scene = &light_composed;
    if (reads == READS_64_32_256_256) field->u = 64, field->v = 32, field->s = 256, field->t = 256;
    if (reads == READS_512_256_32_32) field->u = 512, field->v = 256, field->s = 32, field->t = 32;
    if (reads == READS_512_256_64_64) field->u = 512, field->v = 256, field->s = 64, field->t = 64;
    return recipe;
}

static bool same(const Recipe *a, const Recipe *b) {
    const Field *f = &a->field, *g = &b->field;
    return a->scene == b->scene && a->samples == b->samples && f->angles == g->angles && f->u == g->u &&
           f->v == g->v && f->s == g->s && f->t == g->t;
}

static const Made *made_for(Globe *globe, const Frame *frame) {
    if (frame->knob > 0.0 && frame->knob != floor(frame->knob))
        fail("%g rays a texel: expected a whole number", frame->knob);
    if (globe->path && frame->knob > 0.0 && frame->knob != globe->usual.samples)
        fail("%s: has %d rays a texel, not %g; --knob %d shows it", globe->path, globe->usual.samples,
             frame->knob, globe->usual.samples);
    Recipe recipe = recipe_of(globe, frame->technique->variant, frame->knob);
    for (int i = 0; i < globe->count; i++)
        if (same(&globe->made[i].recipe, &recipe)) return &globe->made[i];
    if (globe->count == MADE) { /* the oldest goes */
        field_unmake(&globe->made[0]);
        for (int i = 1; i < MADE; i++) globe->made[i - 1] = globe->made[i];
        globe->count--;
    }
    bool stored = globe->path && same(&recipe, &globe->usual);
    globe->made[globe->count] = field_make(&recipe, stored ? &globe->file : NULL, globe->path);
    return &globe->made[globe->count++];
}

/* ---- Drawing ---- */

/* What a pixel in the middle of the picture covers at unit distance. */
static double pixel_size(const Frame *frame) {
    const Camera *camera = &frame->camera;
    return 2.0 * tan(0.5 * radians(camera->fov_y_degrees)) / frame->height;
}

/* A shader for one texture would show the first of several as if it were all. */
static void check_pages(const Made *made, const Technique *technique) {
    bool paged = technique->variant == READS_USUAL_PAGED || technique->variant == READS_512_256_64_64;
    if (made->texture.count > 1 && !paged)
        fail("%s: this light field lies in %d textures, which paper-pages alone reads", technique->name,
             made->texture.count);
}

void globe_draw(const Frame *frame) {
    Globe *globe = frame->data;
    Program *program = frame->program;
    program_number(program, "pixel", pixel_size(frame));
    program_texture(program, "solids", &globe->solids);
    program_vector(program, "kinds", globe->kinds.spheres, globe->kinds.cylinders, globe->kinds.boxes, 0);
    Vec3 light = globe->usual.scene->toward_light;
    program_vector(program, "light", light.x, light.y, light.z, 0);
    if (frame->technique->variant == READS_NOTHING) {
        field_uniforms(frame, &globe->usual.field);
    } else {
        const Made *made = made_for(globe, frame);
        check_pages(made, frame->technique);
        field_uniforms(frame, &made->recipe.field);
        field_texture_bind(program, &made->texture);
        program_texture(program, "plain", &made->plain);
        program_texture(program, "depths", &made->depths);
        program_number(program, "mean_depth", made->mean_depth);
    }
    draw_everywhere();
}

/* ---- The truth ---- */

Sample globe_truth(const void *data, Ray ray) {
    const Globe *globe = data;
    return field_truth(&globe->usual.field, globe->usual.scene, ray);
}

/* ---- The lesson's own metrics ---- */

void globe_measure(const Shots *shots, Table *table) {
    Globe *globe = shots->frame->data;
    const char *scene = shots->frame->scene->name, *technique = shots->frame->technique->name;
    if (!strcmp(scene, "composed") && !strcmp(technique, "paper"))
        judge_rates(shots, table, &globe->usual.field, globe->usual.scene);
    if (shots->frame->technique->variant == READS_NOTHING) return;
    judge_field(shots, table, made_for(globe, shots->frame));
}
