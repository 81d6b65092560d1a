/* An object in a box: at most six relief textures, one on each face, made into surfaces that can be warped.
 *
 * A relief's texels are samples of a surface. Four neighbours that belong together are a cell, a patch of
 * that surface; where they do not, the surface ends between them, and how far it reaches is asked of the
 * relief on the side, which sees that edge as a height. Cells and rims are gathered in tiles, which know
 * where they are and which way they face, so that those that no eye in view can see are passed over as one.
 */
#ifndef LESSON_BOX_H
#define LESSON_BOX_H

#include "prewarp.h"

#include <stddef.h>
#include <stdint.h>

enum {
    FACES = 6,
    TILE = 15,           /* cells along a side of a tile, so that a row of it has 16 texels */
    ROW = TILE + 1,      /* those */
    OPPOSITE = FACES / 2 /* face i is opposite to face i + 3 */
};

extern const char *const face_names[FACES]; /* front, right, top, back, left, bottom */

/* What a texel carries along, each number in 0..65535: linear red, green, blue, and 65535; x, y and z of the
 * unit normal in the world as (n + 1) / 2, and 65535. */
typedef struct {
    uint16_t values[8];
} Texel;

/* A point of a relief: its texel coordinates and its displacement from the face, in world units. */
typedef struct {
    float u, v, d;
} Spot;

/* A triangle between the last texels of a surface and its end. Counter-clockwise, seen from outside. */
typedef struct {
    Spot corners[3];
    uint32_t texel; /* whose colour it has, an index into the box's texels */
} Rim;

/* Up to TILE x TILE cells and the rims among them. */
typedef struct {
    int column, row, columns, rows; /* of cells; cell (x, y) lies between texels (x, y) and (x + 1, y + 1) */
    int first_rim, rim_count;
    Spot low, high; /* what all of it lies within, and */
    Vec3 centre;    /* the sphere around that, in the world */
    double radius;
    Vec3 facing; /* the normals of all its triangles are within spread (radians) of this */
    double spread;
} Tile;

typedef struct {
    Plane plane;       /* a and b over the whole image, f outward */
    int width, height; /* texels */
    float *d;          /* displacements (none above 0), NAN where nothing is; ROW - 1 more behind the last */
    uint32_t first;    /* of its texels among the box's */
    uint8_t *cells;    /* (width - 1) x (height - 1): 1 where four neighbours are one surface */
    Rim *rims;         /* in the order of the tiles */
    int rim_count;
    Tile *tiles;
    int tile_count;
} Face;

typedef struct {
    Face faces[FACES];
    Texel *texels; /* nothing, which is 0, then of all faces, row 0 first */
    size_t texel_count;
} Box;

/* What becomes of steep walls between two neighbours: SHARED, the relief on the side has them if it sees them
 * better; KEPT, each relief has its own, so that it can be shown alone; BRIDGED, whatever two neighbours are
 * there is one surface, over cliffs too. */
typedef enum { WALLS_SHARED, WALLS_KEPT, WALLS_BRIDGED } Walls;

/* Reads six relief textures: path is that of the front's file, whose name holds "front"; the others' names
 * have theirs instead. Each has colour, and heights that are hollow, with base 1 and a basis; the six faces
 * bound a box. Ends the program with a line that names the file otherwise. box_destroy frees it. */
void box_load(Box *box, const char *path, Walls walls);
void box_destroy(Box *box);

/* The faces of the box that an eye looks at the object through, in the order of `faces`: from outside the one
 * to three that it is in front of, from inside all six, or those that it is not in the plane of. Being within
 * 1e-6 of the distance to a face's corner is being in its plane. */
typedef struct {
    int faces[FACES], count;
    bool inside;
} Seen;

Seen box_faces_seen(const Box *box, Eye eye);

/* Whether all of a tile's triangles face away from an eye, as far as its sphere and its cone tell. */
bool tile_faces_away(const Tile *tile, Eye eye);

/* The point of the world that a spot is. */
Vec3 face_point(const Face *face, double u, double v, double d);

/* Makes cells, rims, normals and tiles of the faces' displacements: surface.c, called by box_load. */
void box_find_surfaces(Box *box, Walls walls);

#endif
