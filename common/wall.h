/* A polygon with a colour and a relief: the scene that several lessons tell a height by. A lesson's own data
 * begins with a Wall, so that wall_truth and wall_texels can be its scene's callbacks. */
#ifndef TEXEL_WALL_H
#define TEXEL_WALL_H

#include "lesson.h"

typedef struct {
    Image colour_image, height_image;
    Image mask; /* 1 where a height is known, 0 where not; no pixels: known everywhere */
    Texture colour, height;
    Shape polygon; /* one width wide around the origin in the plane z = 0 */
    Relief relief; /* the same polygon, as the truth sees it; its height image is the wall's */
} Wall;

/* Loads the images that the options name: the colour; the height, which must lie in 0..1, with its scale
 * (options_scale) and base (its file's, -10 to 10, or 1); and as the first other one, if there is one, the
 * mask, which counts only for a height map of its size. The wall must stay where it is: its relief points
 * into it. */
void wall_load(Wall *wall, const Options *options);
void wall_unload(Wall *wall);

/* Gives the program in use colour_map, height_map, scale, base and aspect: what polygon.inc reads. */
void wall_bind(const Wall *wall, Program *program);

/* Scene callbacks, see lesson.h; data is a Wall, or begins with one. */
Sample wall_truth(const void *data, Ray ray);
Vec2 wall_texels(const void *data); /* the colour's size */

#endif
