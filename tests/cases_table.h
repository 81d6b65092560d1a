/* A lesson's hard cases as a table: what cases_glm.cpp makes of the lesson's cases.h, once in float and once
 * in double, and what cases.c compares. tests/cases_glm.cpp says how a cases.h is written. */
#ifndef TEXEL_CASES_TABLE_H
#define TEXEL_CASES_TABLE_H

#include "image.h"

#include <stdbool.h>

typedef struct {
    double component[4];
    int count; /* 1..4 components */
} CaseValue;

enum { CASE_LEVELS_MAX = 14 };

typedef struct {
    int width, height;
    bool mipped, whole; /* whole: a texel's floats are the bits of four whole numbers */
    void (*texel)(int x, int y, int level, float *rgba);
    int count; /* of levels; none until cases.c makes them */
    Image levels[CASE_LEVELS_MAX];
} CaseTexture;

/* One line of a cases.h: a case, or where there is no evaluate, what the cases after it need. */
typedef struct {
    const char *name;
    CaseTexture *texture; /* not NULL: a sampler of that name */
    const char *text;     /* GLSL: the expression of a case, or a function */
    const char *unit;     /* and the rest of a case: */
    double bound;         /* of |float - double| in each component; for a flip the jump that a branch makes */
    bool flip;            /* on a comparison: float may take another branch than double */
    CaseValue (*evaluate)(void);
} Case;

/* The table in two precisions, line for line; each sets the number of lines. */
#ifdef __cplusplus
extern "C" {
#endif
const Case *cases_in_float(int *count);
const Case *cases_in_double(int *count);
const char *cases_folder(void); /* the lesson's, from the root of the tree */
#ifdef __cplusplus
}
#endif

#endif
