/* What a window shows: a picture, or two side by side, as sRGB, and boxes of text over them. It draws into
 * the window's own framebuffer; the context must be current. */
#ifndef TEXEL_SCREEN_H
#define TEXEL_SCREEN_H

#include "draw.h"
#include "text.h"

enum { SCREEN_BOXES = 8 };

typedef struct {
    Program pictures, letters;
    int width, height; /* the window's, in pixels */
    Font *font;        /* NULL: no text */
    struct {
        char *lines;
        int size, columns;
        Texture ink;
    } boxes[SCREEN_BOXES]; /* kept until their text changes */
} Screen;

/* common: the folder of its shaders. Without its font it says so on standard error, and shows no text. */
Screen screen_open(const char *common);
void screen_close(Screen *screen);

/* Linear light as bytes of sRGB, as image_write makes them: one texture left of the divider (pixels from the
 * left), another right of it, both stretched over the window's width x height pixels. */
void screen_pictures(Screen *screen, const Texture *left, const Texture *right, double divider, int width,
                     int height);

/* A box of text, in letters of that many pixels (none are shown below 8), broken where the window is
 * narrower. Its point `anchor` ((0, 0): the lower left, (1, 1): the upper right) lies at `at`, in pixels from
 * the lower left, or as near to that as keeps it inside. Returns its height. which: 0..SCREEN_BOXES-1, one
 * for each text; alarm: red. */
int screen_text(Screen *screen, int which, const char *lines, int size, Vec2 at, Vec2 anchor, bool alarm);

/* What was drawn since the window last changed its buffers, as linear light; the caller destroys it. */
Image screen_read(const Screen *screen);

#endif
