#include "globe.h"
#include "context.h"
#include "fail.h"
#include "field_draw.h"
#include "synthesis.h"
#include <stdlib.h>
#include <stdio.h>
#include "clock.h"

typedef struct {
    Field field;
    const LightScene *scene;
    FieldTexture texture;
    Texture plain;
} Globe;

void *globe_load(const Options *options) {
    (void)options;
    Globe *globe = allocate(1, sizeof *globe);
    globe->field = (Field){.model = FIELD_SPHERE, .radius = 3.5, .u = 512, .v = 256, .s = 32, .t = 32};
    globe->scene = &light_composed;
    globe->texture = field_texture_create(&globe->field);
    double a = clock_seconds();
    Synthesis *synthesis = synthesis_create(&globe->field, globe->scene, 7, false);
    enum { ROWS = 8 };
    uint8_t *rows = allocate(ROWS, field_row(&globe->field));
    Image plain = image_create(globe->field.u, globe->field.v, 3);
    const Field *f = &globe->field;
    for (int v = 0; v < f->v; v += ROWS) {
        synthesis_rows(synthesis, v, ROWS, rows, NULL);
        field_texture_write(&globe->texture, v, ROWS, rows);
        for (int i = 0; i < ROWS * f->u; i++)
            for (int c = 0; c < 3; c++)
                image_at(&plain, i % f->u, v + i / f->u)[c] = (float)srgb_decode(
                    rows[field_block(f) * (size_t)i + 3 * (size_t)(f->t / 2 * f->s + f->s / 2) + (size_t)c] / 255.0);
    }
    fprintf(stderr, "synth+upload %.2f s\n", clock_seconds() - a);
    globe->plain = texture_create(&plain, 1, TEXTURE_SRGB8, TEXTURE_LINEAR);
    texture_mipmap(&globe->plain);
    free(rows);
    synthesis_destroy(synthesis);
    image_destroy(&plain);
    return globe;
}

void globe_unload(void *data) {
    Globe *globe = data;
    field_texture_destroy(&globe->texture);
    free(globe);
}

void globe_draw(const Frame *frame) {
    Globe *globe = frame->data;
    field_uniforms(frame, &globe->field);
    field_texture_bind(frame->program, &globe->texture);
    program_texture(frame->program, "plain", &globe->plain);
    draw_everywhere();
}

Sample globe_truth(const void *data, Ray ray) {
    const Globe *globe = data;
    return field_truth(&globe->field, globe->scene, ray);
}
