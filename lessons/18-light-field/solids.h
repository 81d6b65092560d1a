/* A scene's solids for a shader: solids.glsl says how they lie in the texture. */
#ifndef LESSON_SOLIDS_H
#define LESSON_SOLIDS_H

#include "draw.h"
#include "light_scene.h"

/* Where the rows of each kind end. */
typedef struct {
    int spheres, cylinders, boxes;
} SolidKinds;

/* Six texels of floats a row, a row a solid, sorted by kind. The caller destroys it. */
Texture solids_texture(const LightScene *scene, SolidKinds *kinds);

#endif
