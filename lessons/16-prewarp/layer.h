/* What lands on a polygon, as textures for OpenGL. */
#ifndef LESSON_LAYER_H
#define LESSON_LAYER_H

#include "draw.h"
#include "warp.h"

typedef struct {
    Texture colour, normal, lookup; /* id 0 where there is none */
    float model[16];                /* from the square of width 1 around the origin, z = 0, to the polygon */
    uint8_t (*colours)[4];          /* what is written next into the textures */
    uint16_t (*normals)[4];
} Layer;

/* Writes a destination's texels into the layer's textures, which are made anew where their size has changed,
 * and its lookup if it has one. layer_destroy frees them. */
void layer_write(Layer *layer, const Destination *destination);
void layer_destroy(Layer *layer);

/* Lays the layer on the part low..high (u, v) of a plane. */
void layer_lay(Layer *layer, const Plane *plane, Vec2 low, Vec2 high);

/* Gives the program in use colour_map, normal_map, lookup_map and model: what warped.frag reads. */
void layer_bind(const Layer *layer, Program *program);

#endif
