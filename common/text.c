#include "text.h"

#include "fail.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#pragma GCC diagnostic push /* not ours to mend */
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

static const char path[] = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";

/* The letters of Latin-1 from the space on, drawn once a size. */
enum { FIRST = ' ', LETTERS = 256 - FIRST, LINES_MAX = 200 };

struct Font {
    unsigned char *file;
    int size, side; /* of the letters, and of the square bitmap that holds them */
    unsigned char *bitmap;
    stbtt_bakedchar letters[LETTERS];
};

Font *font_open(void) {
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    Font *font = allocate(1, sizeof *font);
    size_t size = 0, room = (size_t)1 << 20;
    font->file = allocate(room, 1);
    size = fread(font->file, 1, room, file);
    fclose(file);
    if (size > 0 && size < room && stbtt_GetFontOffsetForIndex(font->file, 0) == 0) return font;
    font_destroy(font);
    return NULL;
}

void font_destroy(Font *font) {
    if (!font) return;
    free(font->file);
    free(font->bitmap);
    free(font);
}

static void set_size(Font *font, int size) {
    size = size < 6 ? 6 : size > 200 ? 200 : size;
    if (size == font->size) return;
    free(font->bitmap);
    font->size = size;
    font->side = 16 * size; /* a letter takes about 0.6 x 1 of its size, and one pixel around it */
    font->bitmap = allocate((size_t)font->side, (size_t)font->side);
    stbtt_BakeFontBitmap(font->file, 0, (float)size, font->bitmap, font->side, font->side, FIRST, LETTERS,
                         font->letters);
}

int font_column(Font *font, int size) {
    set_size(font, size);
    return (int)lroundf(font->letters[0].xadvance);
}

/* ---- Lines ---- */

/* Latin-1 from UTF-8: ? for what it lacks. The caller frees it. */
static unsigned char *latin1(const char *utf8) {
    unsigned char *result = allocate(strlen(utf8) + 1, 1), *out = result;
    for (const unsigned char *in = (const unsigned char *)utf8; *in; in++) {
        bool pair = (*in == 0xc2 || *in == 0xc3) && (in[1] & 0xc0) == 0x80;
        if (pair) {
            *out++ = (unsigned char)(*in << 6 | (in[1] & 0x3f));
            in++;
        } else if ((*in & 0xc0) != 0x80) { /* the bytes after a letter's first add nothing */
            *out++ = *in >= 0x80 ? '?' : *in;
        }
    }
    return result;
}

typedef struct {
    const unsigned char *start;
    int length;
} Line;

static int break_lines(const unsigned char *at, int columns, Line *lines) {
    int count = 0;
    while (*at && count < LINES_MAX) {
        int length = (int)strcspn((const char *)at, "\n"), kept = length;
        if (length > columns) {
            for (kept = columns; kept > 0 && at[kept] != ' ';) kept--;
            if (kept == 0) kept = columns;
        }
        lines[count++] = (Line){at, kept};
        at += kept;
        if (*at == '\n' || (*at == ' ' && kept < length)) at++;
    }
    return count;
}

/* ---- Letters ---- */

static void draw_letter(const Font *font, unsigned char code, Image *image, int left, int baseline) {
    if (code < FIRST) return;
    const stbtt_bakedchar *letter = &font->letters[code - FIRST];
    for (int y = letter->y0; y < letter->y1; y++) {
        for (int x = letter->x0; x < letter->x1; x++) {
            int to_x = left + (int)lroundf(letter->xoff) + x - letter->x0;
            int to_y = baseline - (int)lroundf(letter->yoff) - (y - letter->y0); /* rows grow upward */
            if (to_x < 0 || to_x >= image->width || to_y < 0 || to_y >= image->height) continue;
            float ink = font->bitmap[y * font->side + x] / 255.0f, *pixel = image_at(image, to_x, to_y);
            *pixel = fmaxf(*pixel, ink);
        }
    }
}

Image font_image(Font *font, const char *lines, int size, int columns) {
    int column = font_column(font, size), margin = font->size / 2, widest = 1;
    int row = font->size + font->size / 8, below = font->size / 4; /* below the baseline: descenders */
    unsigned char *letters = latin1(lines);
    Line broken[LINES_MAX];
    int count = break_lines(letters, columns > 1 ? columns : 1, broken);
    for (int i = 0; i < count; i++)
        if (broken[i].length > widest) widest = broken[i].length;
    Image image = image_create(widest * column + 2 * margin, count * row + margin, 1);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < broken[i].length; k++)
            draw_letter(font, broken[i].start[k], &image, margin + k * column,
                        (count - 1 - i) * row + margin / 2 + below);
    free(letters);
    return image;
}
