/* Between image.c and image.cpp. OpenImageIO brings 250 libraries along, and a quarter of a second goes by
 * until they are loaded: so image.cpp is a library of its own, libtexel-files.so, and image.c loads it when
 * the first file is read or written. A program that only says what is wrong with its command line says it at
 * once. */
#ifndef TEXEL_IMAGE_FILES_H
#define TEXEL_IMAGE_FILES_H

#include "image.h"

/* As image_read, image_write, image_write_raw and image_write_relief in image.h. */
typedef struct {
    const char *(*read)(Image *image, const char *path, ImageKind kind);
    const char *(*write)(const Image *image, const char *path);
    const char *(*write_raw)(const Image *image, const char *path, int bits);
    const char *(*write_relief)(const Image *colour, const Image *height, const char *path, int bits);
} ImageFiles;

extern const ImageFiles image_files;

#endif
