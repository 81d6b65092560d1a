/* What light fields are made of: solids in one light, and the exact light along a ray, in doubles: their
 * truth. How a light field is made of a scene, fast, is synthesis.h, which shares no code
 * with the truth.
 *
 * The light that leaves a surface of the colour c, normal N, lit from L, toward V, all unit vectors:
 *     c (AMBIENT + DIFFUSE (N.L)) + SPECULAR (R.V)^EXPONENT,   R = 2 (N.L) N - L   (Phong 1975)
 * with neither of the last two where N.L <= 0, and no highlight where R.V <= 0. The three sum to 1, so that
 * nothing is brighter than white, and a texture of 0..1 holds all. What is not met is black. */
#ifndef TEXEL_LIGHT_SCENE_H
#define TEXEL_LIGHT_SCENE_H

#include "solid.h"

enum { LIGHT_SOLIDS = 8 };
#define LIGHT_AMBIENT 0.15
#define LIGHT_DIFFUSE 0.55
#define LIGHT_SPECULAR 0.3
#define LIGHT_EXPONENT 32

typedef struct {
    const char *name;
    int count;
    Solid solids[LIGHT_SOLIDS]; /* none overlaps another */
    Vec3 toward_light;
    /* What a light field records besides, where it is made with them: a solid in the way of the light lets
     * only its `clear` of it pass; the share `mirror` of what a solid shows is what it mirrors, once; and
     * `clear` is what lies behind it, seen straight through. */
    bool effects;
    double mirror[LIGHT_SOLIDS], clear[LIGHT_SOLIDS];
} LightScene;

/* The composed scene of the paper; the same with shadows, a mirroring ball and a clear box; the paper's
 * cylinder near the model of diameter 7, on the side of +z; three balls, behind that model, across it and in
 * front of it; and the composed scene's solids spread out around an observer. */
extern const LightScene light_composed, light_effects, light_aliasing, light_placements, light_around;

/* The scene of that name, or NULL. */
const LightScene *light_scene_named(const char *name);

/* Prints it for a lesson's --list: all that it takes to build the same scene. */
void light_scene_list(const LightScene *scene);

/* The light that comes back along a ray, and whether (and where) it meets anything. */
Vec3 light_along(const LightScene *scene, Ray ray, SolidHit *hit, bool *met);

#endif
