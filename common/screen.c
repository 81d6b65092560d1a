#include "screen.h"

#include "context.h"
#include "fail.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static Program build(const char *common, const char *fragment) {
    Program program = {0};
    char *log = program_build(&program, common, common, "everywhere.vert", fragment, GLSL_330);
    if (log) fail("%s", log);
    return program;
}

Screen screen_open(const char *common) {
    Screen screen = {build(common, "pictures.frag"), build(common, "letters.frag"), .font = font_open()};
    if (!screen.font)
        fprintf(stderr, "no text in the window: the font of fonts-dejavu-core is not installed\n");
    return screen;
}

void screen_close(Screen *screen) {
    program_destroy(&screen->pictures);
    program_destroy(&screen->letters);
    for (int i = 0; i < SCREEN_BOXES; i++) {
        if (screen->boxes[i].ink.id) texture_destroy(&screen->boxes[i].ink);
        free(screen->boxes[i].lines);
    }
    font_destroy(screen->font);
    *screen = (Screen){0};
}

void screen_pictures(Screen *screen, const Texture *left, const Texture *right, double divider, int width,
                     int height) {
    screen->width = width;
    screen->height = height;
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.Viewport(0, 0, width, height);
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_BLEND);
    program_use(&screen->pictures);
    program_texture(&screen->pictures, "left", left);
    program_texture(&screen->pictures, "right", right);
    program_vector(&screen->pictures, "size", width, height, 0, 0);
    program_number(&screen->pictures, "divider", divider);
    draw_everywhere();
}

int screen_text(Screen *screen, int which, const char *lines, int size, Vec2 at, Vec2 anchor, bool alarm) {
    if (!screen->font || size < 8 || !*lines) return 0;
    int columns = (screen->width - 2 * size) / font_column(screen->font, size);
    char **kept = &screen->boxes[which].lines;
    Texture *ink = &screen->boxes[which].ink;
    if (!*kept || strcmp(*kept, lines) != 0 || screen->boxes[which].size != size ||
        screen->boxes[which].columns != columns) {
        Image image = font_image(screen->font, lines, size, columns);
        free(*kept);
        if (ink->id) texture_destroy(ink);
        *kept = text("%s", lines);
        *ink = texture_create(&image, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
        screen->boxes[which].size = size;
        screen->boxes[which].columns = columns;
        image_destroy(&image);
    }
    int x = (int)lround(clamp(at.x - anchor.x * ink->width, 0.0, fmax(screen->width - ink->width, 0.0)));
    int y = (int)lround(at.y - anchor.y * ink->height);
    gl.Viewport(x, y, ink->width, ink->height);
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    program_use(&screen->letters);
    program_texture(&screen->letters, "ink", ink);
    program_vector(&screen->letters, "corner", x, y, 0, 0);
    program_vector(&screen->letters, "box", alarm ? 0.45 : 0.0, 0, 0, alarm ? 0.85 : 0.75);
    draw_everywhere();
    return ink->height;
}

Image screen_read(const Screen *screen) {
    int width = screen->width, height = screen->height;
    size_t count = (size_t)width * height * 3;
    unsigned char *bytes = allocate(count, 1);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadBuffer(GL_BACK);
    gl.ReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes);
    draw_check("reading the window");
    Image image = image_create(width, height, 3);
    for (size_t i = 0; i < count; i++) image.pixels[i] = (float)srgb_decode(bytes[i] / 255.0);
    free(bytes);
    return image;
}
