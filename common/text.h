/* Text as pictures, for the window. */
#ifndef TEXEL_TEXT_H
#define TEXEL_TEXT_H

#include "image.h"

typedef struct Font Font;

/* The course's font, or NULL where it is not installed. font_destroy frees it. */
Font *font_open(void);
void font_destroy(Font *font);

/* The width in pixels of a column, for letters of a size: from the lowest descender to the highest ascender,
 * in pixels. Sizes are bounded to 6..200. */
int font_column(Font *font, int size);

/* How much of each pixel is ink, 0..1, one channel, with a margin around. Lines (UTF-8, split at \n) longer
 * than `columns` go on in the next one, from their last space if they have one. The caller destroys it. */
Image font_image(Font *font, const char *lines, int size, int columns);

#endif
