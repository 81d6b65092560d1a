/* The scene of this lesson: one endless plane, tiled with an image. A floor and a wall differ in where the
 * camera stands and in which way it calls up. */
#ifndef LESSON_PLANE_H
#define LESSON_PLANE_H

#include "chain.h"
#include "lesson.h"

/* What C makes of the image for a technique: the technique's variant. */
typedef enum {
    READS_BASE,        /* the image alone */
    READS_BOX,         /* and its chain: see chain.h */
    READS_SRGB_BOX,    /* the same of sRGB numbers */
    READS_KAISER,      /* the same by a windowed sinc */
    READS_OPENGL,      /* the chain that glGenerateMipmap makes */
    READS_TABLE,       /* its summed-area table */
    READS_NAIVE_TABLE, /* the same without its low half */
    READS_COUNT
} Reads;

typedef struct {
    Texture image, high, low;
    Chain chain; /* only its first level is there, the image, unless it is a chain that is read */
} Reading;

typedef struct {
    Image image;
    double aspect;                 /* a repeat's height over its width */
    Reading readings[READS_COUNT]; /* each made when first drawn: an image may be large */
} Plane;

/* Scene callbacks, see lesson.h. The plane is z = 0; one repeat of the image is one world unit wide, and the
 * image's centre is at the origin. plane_load_1024 and _4096 make a grey image of so many texels on a side
 * out of the scene's, repeated, with one texel of 1e5 in its lower left: a table's hard case. */
void *plane_load(const Options *options);
void *plane_load_1024(const Options *options);
void *plane_load_4096(const Options *options);
void plane_unload(void *data);
void plane_draw(const Frame *frame);
Sample plane_truth(const void *data, Ray ray);
Vec2 plane_texels(const void *data);
void plane_measure(const Shots *shots, Table *table); /* see metrics.c */

/* What a technique reads. */
const Reading *plane_reading(Plane *plane, Reads reads);

/* The levels of a texture made of the base image, as OpenGL holds them (of SRGB8 the codes, divided by 255);
 * chain_destroy frees them. */
Chain plane_download(const Texture *texture, const Image *base);

/* Row by row the matrix that takes a pixel's (x, y, 1) to (u w, v w, w), with w > 0 in front of the eye. */
typedef struct {
    Vec3 u, v, w;
} Homography;

Homography plane_homography(const Plane *plane, const Camera *camera, int width, int height);

#endif
