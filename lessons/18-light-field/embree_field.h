/* Light fields synthesised through Embree (Debian's, 3.13), to hold synthesis.h against: the same rays, one a
 * texel at its centre, the same shading and the same bytes in the same places, on all cores; only what finds
 * the solid that a ray meets is Embree's. No effects, and the rays begin on the model.
 *
 * What Embree is given: rays in Morton order, so that four, eight, sixteen and all longer runs of them are
 * squares or halves of squares of the grid of angles; directions made eight at a time; its best quality of
 * tree; hits gathered and shaded eight at a time; and, as user geometry, callbacks with the same SIMD
 * formulas that synthesis.h has, with all that depends on the origin alone computed once a block. */
#ifndef LESSON_EMBREE_FIELD_H
#define LESSON_EMBREE_FIELD_H

#include "light_field.h"
#include "light_scene.h"

typedef struct EmbreeField EmbreeField;

/* How rays are handed over: singly (rtcIntersect1), in packets (rtcIntersect4, 8, 16), or as streams (of
 * single rays, rtcIntersect1M; of packets of sixteen, rtcIntersectNM; of arrays, rtcIntersectNp). */
typedef enum {
    EMBREE_1,
    EMBREE_4,
    EMBREE_8,
    EMBREE_16,
    EMBREE_1M,
    EMBREE_NM,
    EMBREE_NP,
    EMBREE_WAYS
} EmbreeWay;
extern const char *const embree_way_names[EMBREE_WAYS];

/* meshes: as triangles (their number goes to *triangles, unless NULL), else as user geometry. Field and scene
 * are kept by their addresses; the field must not be refused. embree_field_destroy frees it. */
EmbreeField *embree_field_create(const Field *field, const LightScene *scene, bool meshes, int *triangles);
void embree_field_destroy(EmbreeField *embree);

/* As synthesis_rows. coherent: tell Embree that neighbouring rays are alike, which it makes use of only in
 * some of its ways, and not always to advantage. */
void embree_field_rows(const EmbreeField *embree, EmbreeWay way, bool coherent, int first, int rows,
                       uint8_t *texels);

#endif
