#include "exhibit.h"

#include "compare.h"
#include "encoder.h"
#include "fail.h"
#include "field_draw.h"
#include "files.h"
#include "shown.h"
#include "stage.h"
#include "synthesis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- The scenes, by their names ---- */

enum { RAYS = 7, MADE_MOST = 16, ROWS = 8 };

#define SIZE(nu, nv, ns, nt)                                                                                 \
    { .model = FIELD_SPHERE, .radius = 3.5, .u = nu, .v = nv, .s = ns, .t = nt }

static const struct {
    const char *name;
    Field field;
} scenes[] = {
    {"composed", SIZE(256, 128, 32, 32)},
    {"fine", SIZE(512, 256, 32, 32)},
    {"even", SIZE(128, 64, 64, 64)},
};

static const Field *field_of_scene(const char *name) {
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        if (strcmp(scenes[i].name, name) == 0) return &scenes[i].field;
    fail("%s: no light field is made for this scene", name);
}

void exhibit_list(const Scene *scene) {
    field_list(field_of_scene(scene->name));
    printf("  rays %d a texel\n", RAYS);
    light_scene_list(&light_composed);
}

/* ---- Loading: the texels are synthesised when first asked for ---- */

typedef struct {
    int codec, knob; /* codec: its number */
    Encoder encoder; /* what encoding took */
    Encoded encoded;
    Shown shown;
} Made;

typedef struct {
    FieldHeader header;
    char *path; /* of the user's file, or NULL */
    uint8_t *texels;
    FieldTexture raw;
    Made made[MADE_MOST]; /* in the order in which they were asked for */
    int count;
} Exhibit;

/* A user's light field must be of this scene, or the truth would be of something else. */
static void check_file(Exhibit *exhibit, const char *path) {
    FieldFile file;
    Encoded encoded;
    field_file_demand(field_file_open(&file, path), path);
    FieldHeader own = field_header(&file.header.field, &light_composed, file.header.samples, false);
    if (file.header.scene_key != own.scene_key || file.header.through ||
        file.header.field.angles != ANGLES_LINEAR)
        fail("%s: is a light field of %s, not of the scene composed with linear angles", path,
             file.header.scene);
    exhibit->header = file.header;
    exhibit->path = text("%s", path);
    field_file_close(&file);
    if (exhibit->header.codec == FIELD_RAW) return;
    field_file_demand(encoded_open(path, &file, &encoded), path);
    field_file_close(&file);
}

void *exhibit_load(const Options *options) {
    Exhibit *exhibit = allocate(1, sizeof *exhibit);
    exhibit->header = field_header(field_of_scene(options->scene), &light_composed, RAYS, false);
    if (options->colour) check_file(exhibit, options->colour);
    return exhibit;
}

static void unmake(Made *made) {
    encoded_destroy(&made->encoded);
    shown_destroy(&made->shown);
}

void exhibit_unload(void *data) {
    Exhibit *exhibit = data;
    for (int i = 0; i < exhibit->count; i++) unmake(&exhibit->made[i]);
    if (exhibit->raw.count) field_texture_destroy(&exhibit->raw);
    free(exhibit->texels);
    free(exhibit->path);
    free(exhibit);
}

static void read_rows(const Exhibit *exhibit, uint8_t *texels) {
    FieldFile file;
    field_file_demand(field_file_open(&file, exhibit->path), exhibit->path);
    size_t row = field_row(&exhibit->header.field);
    for (int v = 0; v < exhibit->header.field.v; v++)
        field_file_demand(field_file_section(&file, v, texels + row * (size_t)v), exhibit->path);
    field_file_close(&file);
}

/* All texels as they are. */
static const uint8_t *texels_of(Exhibit *exhibit) {
    const Field *field = &exhibit->header.field;
    if (exhibit->texels) return exhibit->texels;
    exhibit->texels = allocate((size_t)field->v, field_row(field));
    if (exhibit->path && exhibit->header.codec == FIELD_RAW) {
        read_rows(exhibit, exhibit->texels);
    } else {
        Synthesis *synthesis = synthesis_create(field, &light_composed, exhibit->header.samples, false);
        synthesis_rows(synthesis, 0, field->v, exhibit->texels, NULL);
        synthesis_destroy(synthesis);
    }
    return exhibit->texels;
}

static const FieldTexture *raw_of(Exhibit *exhibit) {
    const Field *field = &exhibit->header.field;
    if (exhibit->raw.count) return &exhibit->raw;
    exhibit->raw = field_texture_create(field);
    if (exhibit->raw.count > 1)
        fail("raw: a light field of %dx%dx%dx%d does not fit in one texture", field->u, field->v, field->s,
             field->t);
    field_texture_write(&exhibit->raw, 0, field->v, texels_of(exhibit));
    return &exhibit->raw;
}

/* ---- What a technique shows ---- */

static const Codec *codec_of(const Frame *frame) {
    static const char *const names[] = {[EXHIBIT_VQ] = "vq", [EXHIBIT_RAMP] = "ramp"};
    if (frame->technique->variant == EXHIBIT_BLOCK) return frame->knob < 6 ? &codec_bc1 : &codec_bc7;
    return codec_named(names[frame->technique->variant]);
}

static void make(Exhibit *exhibit, const Codec *codec, int knob, Made *made) {
    bool given = exhibit->path && exhibit->header.codec != FIELD_RAW;
    *made = (Made){.codec = (int)codec->number, .knob = knob};
    if (given) {
        FieldFile file;
        field_file_demand(encoded_open(exhibit->path, &file, &made->encoded), exhibit->path);
        field_file_demand(encoded_read(&file, &made->encoded), exhibit->path);
        made->encoder.bytes = file.bytes;
        field_file_close(&file);
    } else {
        made->encoder =
            encoder_run(&exhibit->header.field, exhibit->header.codec == FIELD_RAW ? exhibit->path : NULL,
                        codec, knob, &made->encoded);
    }
    made->shown = shown_create(&made->encoded);
}

/* A file that is encoded is shown by its own technique, whatever the knob says. */
static Made *made_for(Exhibit *exhibit, const Frame *frame) {
    const Codec *codec = codec_of(frame);
    int knob = (int)frame->knob;
    if (frame->knob != floor(frame->knob) || knob < codec->knobs[0] || knob > codec->knobs[1])
        fail("%s: %s is a whole number from %d to %d", frame->technique->name, frame->technique->knob.name,
             codec->knobs[0], codec->knobs[1]);
    if (exhibit->path && exhibit->header.codec != FIELD_RAW) {
        if (exhibit->header.codec != codec->number)
            fail("%s: is encoded by %s, which %s does not read", exhibit->path,
                 codec_numbered(exhibit->header.codec)->name, frame->technique->name);
        knob = (int)exhibit->header.parameters[0];
    }
    for (int i = 0; i < exhibit->count; i++)
        if (exhibit->made[i].codec == (int)codec->number && exhibit->made[i].knob == knob)
            return &exhibit->made[i];
    if (exhibit->count == MADE_MOST) { /* the oldest goes */
        unmake(&exhibit->made[0]);
        memmove(exhibit->made, exhibit->made + 1, (MADE_MOST - 1) * sizeof *exhibit->made);
        exhibit->count--;
    }
    make(exhibit, codec, knob, &exhibit->made[exhibit->count]);
    return &exhibit->made[exhibit->count++];
}

void exhibit_draw(const Frame *frame) {
    Exhibit *exhibit = frame->data;
    field_uniforms(frame, &exhibit->header.field);
    if (frame->technique->variant == EXHIBIT_RAW)
        field_texture_bind(frame->program, raw_of(exhibit));
    else
        shown_bind(&made_for(exhibit, frame)->shown, frame->program);
    draw_everywhere();
}

Sample exhibit_truth(const void *data, Ray ray) {
    const Exhibit *exhibit = data;
    return field_truth(&exhibit->header.field, &light_composed, ray);
}

/* ---- The lesson's own metrics ---- */

static bool wants_any(const Shots *shots, const char *const *metrics) {
    for (int i = 0; metrics[i]; i++)
        if (shots_want(shots, NULL, metrics[i])) return true;
    return false;
}

static void measure_rate(const Shots *shots, Table *table, const Field *field, double bytes) {
    double texels = (double)(field_bytes(field) / FIELD_TEXEL);
    table_add(table, shots, NULL, "bytes", bytes, "bytes");
    table_add(table, shots, NULL, "bits_per_texel", 8.0 * bytes / texels, "bits");
    table_add(table, shots, NULL, "compression_ratio", 3.0 * texels / bytes, "1");
}

static void measure_error(const Shots *shots, Table *table, Exhibit *exhibit, const Made *made) {
    static const char *const metrics[] = {"texture_psnr_db", "texture_psnr_all_db", "near_percent", NULL};
    const Field *field = &exhibit->header.field;
    if (!wants_any(shots, metrics)) return;
    EncodedError error = encoded_error(&made->encoded, 0, field->v, texels_of(exhibit));
    double close = squares_psnr_db(error.near_squares, error.near_texels);
    table_add(table, shots, NULL, metrics[0], close, "dB");
    table_add(table, shots, NULL, metrics[1], squares_psnr_db(error.squares, error.texels), "dB");
    table_add(table, shots, NULL, metrics[2], 100.0 * (double)error.near_texels / (double)error.texels, "%");
    table_point(table, shots, NULL, "rate and quality", "bits a texel",
                8.0 * (double)made->encoder.bytes * FIELD_TEXEL / (double)field_bytes(field),
                "texture_psnr_db", close);
}

/* The picture against that of the texels as they are: what compression alone does to it. */
static void measure_pictures(const Shots *shots, Table *table) {
    for (int i = 0; i < shots->count; i++) {
        const Shot *shot = &shots->shots[i];
        if (!shots_want(shots, shot->view, "raw_psnr_db")) continue;
        Frame frame = *shots->frame;
        frame.technique = &frame.scene->techniques[0], frame.knob = 0.0;
        frame.view = shot->view, frame.camera = shot->view->camera;
        Picture raw = picture_create(frame.width, frame.height, false);
        Difference difference;
        stage_draw(shots->stage, &frame, &raw);
        const char *reason = compare(&shot->picture.colour, &raw.colour, &difference, NULL);
        if (reason) fail("%s: %s", shots->frame->technique->name, reason);
        table_add(table, shots, shot->view, "raw_psnr_db", difference.psnr_db, "dB");
        picture_destroy(&raw);
    }
}

void exhibit_measure(const Shots *shots, Table *table) {
    Exhibit *exhibit = shots->frame->data;
    const Field *field = &exhibit->header.field;
    if (shots->frame->technique->variant == EXHIBIT_RAW) {
        measure_rate(shots, table, field, (double)field_bytes(field));
        return;
    }
    const Made *made = made_for(exhibit, shots->frame);
    measure_rate(shots, table, field, (double)made->encoder.bytes);
    measure_error(shots, table, exhibit, made);
    if (!exhibit->path || exhibit->header.codec == FIELD_RAW) measure_pictures(shots, table);
    if (made->encoder.peak_memory_mib <= 0.0) return; /* a user's file */
    table_add(table, shots, NULL, "encode_seconds", made->encoder.seconds, "s");
    table_add(table, shots, NULL, "peak_memory_mib", made->encoder.peak_memory_mib, "MiB");
}
