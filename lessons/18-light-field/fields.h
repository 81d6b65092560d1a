/* The light fields that a scene's techniques read, each synthesised when first asked for, or read from a
 * file. */
#ifndef LESSON_FIELDS_H
#define LESSON_FIELDS_H

#include "field_draw.h"
#include "field_file.h"

/* What a light field is made of. */
typedef struct {
    const LightScene *scene;
    Field field;
    int samples;  /* rays a texel */
    bool through; /* see synthesis.h */
    bool flat;    /* without depths, which take as long as the light */
} Recipe;

/* One that is made: on the GPU, and what else was learnt on the way. */
typedef struct {
    Recipe recipe;
    FieldTexture texture;
    Texture plain;  /* one picture of the model, u by v, with a mipmap: the light along the normals */
    Texture depths; /* a quarter of the texels along each axis: how far behind the model what is seen lies, */
    double mean_depth; /* and the mean of that over all texels that see anything */
    double seconds;    /* that its synthesis took */
    uint8_t *texels;   /* all of them again where they are at most FIELD_KEPT bytes, else NULL */
} Made;

enum { FIELD_KEPT = 128 << 20, COARSE = 4 };

/* Synthesises and uploads, row by row; progress is said on standard error if it takes long. file: where the
 * texels come from instead, or NULL; path is its name. Ends the program if that cannot be read. */
Made field_make(const Recipe *recipe, const FieldFile *file, const char *path);

void field_unmake(Made *made);

#endif
