/* From displacements to surfaces: which neighbours belong together, how far a surface reaches beyond its last
 * texel, its normals, and tiles of all that. Done once, when a box is loaded. */
#include "box.h"

#include "fail.h"

#include <stdlib.h>

/* The four ways to a neighbour. Around a cell from texel (x, y), counter-clockwise, way k leads from corner k
 * to the next. */
static const struct {
    int x, y;
} ways[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

static int opposite(int way) { return (way + 2) % 4; }

/* Neighbours that differ by more than STEEPEST times their distance are two surfaces; by more than STEEP, if
 * the relief on the side sees the wall between them better. */
static const double STEEP = 1.5, STEEPEST = 8.0;
static const double SMOOTH = 0.5;

/* What surfaces are found with. */
typedef struct {
    const Box *box;
    Face *face;
    Walls walls;
    int side[4]; /* the face of the box that lies each way */
    int rim_room;
} Finder;

static float displacement_at(const Face *face, int x, int y) {
    bool inside = x >= 0 && y >= 0 && x < face->width && y < face->height;
    return inside ? face->d[(size_t)y * face->width + x] : NAN;
}

static bool is_there(const Face *face, int x, int y) { return !isnan(displacement_at(face, x, y)); }

/* The vector to the next texel. */
static Vec3 pitch(const Face *face, int way) {
    Vec3 along = ways[way].x ? face->plane.a : face->plane.b;
    return vec3_scale(along,
                      ways[way].x ? (double)ways[way].x / face->width : (double)ways[way].y / face->height);
}

/* What the relief on the box's side knows of a cliff here: how far the way from texel (x, y) its surface is,
 * at displacement d of this relief, in texels. No number unless that is between the texel and its neighbour.
 * A cliff in one relief is a height in the other, known to sixteen bits. */
static double place_from_side(const Finder *finder, int x, int y, int way, double d) {
    const Face *face = finder->face, *side = &finder->box->faces[finder->side[way]];
    Vec3 point = face_point(face, (x + 0.5) / face->width, (y + 0.5) / face->height, d);
    Vec3 at = vec3_sub(point, side->plane.origin), a = side->plane.a, b = side->plane.b;
    int column = (int)floor(vec3_dot(at, a) / vec3_dot(a, a) * side->width);
    int row = (int)floor(vec3_dot(at, b) / vec3_dot(b, b) * side->height);
    double farther = displacement_at(side, column, row) - vec3_dot(at, side->plane.f);
    double place = farther / vec3_length(pitch(face, way));
    return place >= -1e-3 && place <= 1.0 + 1e-3 ? clamp(place, 0.0, 1.0) : NAN;
}

/* Whether a texel and its neighbour belong to one surface. False where one of them is not there. */
static bool is_joined(const Finder *finder, int x, int y, int way) {
    const Face *face = finder->face;
    int next_x = x + ways[way].x, next_y = y + ways[way].y;
    double here = displacement_at(face, x, y), next = displacement_at(face, next_x, next_y);
    double slope = fabs(next - here) / vec3_length(pitch(face, way));
    if (finder->walls == WALLS_BRIDGED || slope <= STEEP) return !isnan(slope);
    if (!(slope <= STEEPEST) || finder->walls == WALLS_KEPT) return slope <= STEEPEST;
    double middle = (here + next) / 2.0;
    return isnan(next < here ? place_from_side(finder, x, y, way, middle)
                             : place_from_side(finder, next_x, next_y, opposite(way), middle));
}

/* ---- Where a surface ends ---- */

/* How far the surface of a texel reaches toward a neighbour that is lower, or not there: to where the side
 * sees it, just below this texel's height, in the first of its texels there; half a texel where it sees
 * something else. */
static double reach_over(const Finder *finder, int x, int y, int way) {
    const Face *face = finder->face, *side = &finder->box->faces[finder->side[way]];
    double across = fabs(vec3_dot(side->plane.a, face->plane.f)) / side->width;
    double up = fabs(vec3_dot(side->plane.b, face->plane.f)) / side->height;
    double place = place_from_side(finder, x, y, way, displacement_at(face, x, y) - fmax(across, up) / 2.0);
    return isnan(place) ? 0.5 : place;
}

/* The same toward any neighbour that is not joined: one that is higher ends where this one does. */
static double reach(const Finder *finder, int x, int y, int way) {
    int next_x = x + ways[way].x, next_y = y + ways[way].y;
    if (displacement_at(finder->face, next_x, next_y) > displacement_at(finder->face, x, y))
        return 1.0 - reach_over(finder, next_x, next_y, opposite(way));
    return reach_over(finder, x, y, way);
}

/* What a texel's displacement grows by on the way to a neighbour, as its other neighbour has it. */
static double slope_beyond(const Finder *finder, int x, int y, int way) {
    if (!is_joined(finder, x, y, opposite(way))) return 0.0;
    return displacement_at(finder->face, x, y) -
           displacement_at(finder->face, x - ways[way].x, y - ways[way].y);
}

static Spot spot_of(const Face *face, double x, double y, double d) {
    return (Spot){(float)((x + 0.5) / face->width), (float)((y + 0.5) / face->height), (float)d};
}

/* The point where a texel's surface ends: it goes straight on, but not out of the box. */
static Spot end_spot(const Finder *finder, int x, int y, int way) {
    double t = reach(finder, x, y, way);
    double d = displacement_at(finder->face, x, y) + t * slope_beyond(finder, x, y, way);
    return spot_of(finder->face, x + t * ways[way].x, y + t * ways[way].y, fmin(d, 0.0));
}

/* ---- Cells and rims ---- */

static void add_rim(Finder *finder, Spot a, Spot b, Spot c, size_t texel) {
    Face *face = finder->face;
    if (face->rim_count == finder->rim_room) {
        finder->rim_room = 2 * finder->rim_room + 256;
        face->rims = realloc(face->rims, (size_t)finder->rim_room * sizeof *face->rims);
        if (!face->rims) fail("out of memory");
    }
    face->rims[face->rim_count++] = (Rim){{a, b, c}, face->first + (uint32_t)texel};
}

/* Whether a texel is on a wall that goes on up on one side and down on the other, apart from both: it is left
 * to the relief on the side. */
static bool is_on_wall(const Finder *finder, int x, int y) {
    const Face *face = finder->face;
    bool on_wall = false;
    for (int way = 0; way < 2; way++) {
        double here = displacement_at(face, x, y);
        double before = displacement_at(face, x - ways[way].x, y - ways[way].y);
        double after = displacement_at(face, x + ways[way].x, y + ways[way].y);
        bool between = (before < here && here < after) || (after < here && here < before);
        on_wall =
            on_wall || (between && !is_joined(finder, x, y, way) && !is_joined(finder, x, y, opposite(way)));
    }
    return on_wall;
}

/* What is left of a cell around the corners first..first + count - 1, which are joined: a polygon through
 * them and through the two ends of their surface on the cell's sides, as triangles around the first end. */
static void add_run(Finder *finder, int x, int y, int first, int count) {
    const Face *face = finder->face;
    int before = (first + 3) % 4, last = (first + count - 1) % 4;
    Spot polygon[6];
    size_t texels[6];
    bool on_wall = true;
    for (int i = 0; i < count; i++) {
        int column = x + corners[(first + i) % 4].x, row = y + corners[(first + i) % 4].y;
        polygon[i + 1] = spot_of(face, column, row, displacement_at(face, column, row));
        texels[i + 1] = (size_t)row * face->width + column;
        on_wall = on_wall && is_on_wall(finder, column, row);
    }
    if (on_wall) return;
    polygon[0] = end_spot(finder, x + corners[first].x, y + corners[first].y, opposite(before));
    polygon[count + 1] = end_spot(finder, x + corners[last].x, y + corners[last].y, last);
    for (int i = 1; i <= count; i++) add_rim(finder, polygon[0], polygon[i], polygon[i + 1], texels[i]);
}

/* Cell (x, y), one of the four around each texel, so that some have corners beyond the image. Returns whether
 * it is whole; if not, runs of joined corners get their rims. */
static bool add_cell(Finder *finder, int x, int y) {
    bool joined[4];
    int cut = -1;
    for (int k = 0; k < 4; k++) {
        joined[k] = is_joined(finder, x + corners[k].x, y + corners[k].y, k);
        if (!joined[k]) cut = k;
    }
    if (cut < 0) return true;
    for (int k = 1; k <= 4;) { /* from the corner behind a cut */
        int first = (cut + k) % 4, count = 1;
        while (k + count <= 4 && joined[(first + count - 1) % 4]) count++;
        if (is_there(finder->face, x + corners[first].x, y + corners[first].y))
            add_run(finder, x, y, first, count);
        k += count;
    }
    return false;
}

/* ---- Normals ---- */

/* What the displacement grows by from texel (x, y) to the next along a way, as nearly straight surfaces have
 * it; no number beyond a cliff. */
static double step_along(const Face *face, int x, int y, int way) {
    double rise = displacement_at(face, x + ways[way].x, y + ways[way].y) - displacement_at(face, x, y);
    return fabs(rise) <= STEEPEST * vec3_length(pitch(face, way)) ? rise : NAN;
}

/* The slope at a texel along a way, of five texels in a row. Across an edge of the object a difference would
 * be of neither of its two sides: of the three texels before, the three around and the three after, those are
 * taken that are most nearly on a line. */
static double slope_at(const Face *face, int x, int y, int way) {
    double steps[4]; /* from -2 to -1, to 0, to 1, to 2 */
    for (int i = 0; i < 4; i++)
        steps[i] = step_along(face, x + (i - 2) * ways[way].x, y + (i - 2) * ways[way].y, way);
    const struct {
        double bend, slope; /* how far from a line; the parabola's slope at the texel */
    } parts[] = {{fabs(steps[2] - steps[1]) / 2.0, (steps[1] + steps[2]) / 2.0}, /* best where it is smooth */
                 {fabs(steps[1] - steps[0]), (3.0 * steps[1] - steps[0]) / 2.0},
                 {fabs(steps[3] - steps[2]), (3.0 * steps[2] - steps[3]) / 2.0}};
    double low = fmin(fmin(steps[0], steps[1]), fmin(steps[2], steps[3]));
    double high = fmax(fmax(steps[0], steps[1]), fmax(steps[2], steps[3]));
    bool all = !isnan(steps[0] + steps[1] + steps[2] + steps[3]);
    if (all && high - low < SMOOTH * vec3_length(pitch(face, way)))
        return (2.0 * (steps[0] + steps[3]) + 3.0 * (steps[1] + steps[2])) / 10.0;
    double best = INFINITY, slope = !isnan(steps[1]) ? steps[1] : !isnan(steps[2]) ? steps[2] : 0.0;
    for (int i = 0; i < 3; i++) {
        if (!(parts[i].bend < best)) continue; /* so for what is no number */
        best = parts[i].bend;
        slope = parts[i].slope;
    }
    return slope;
}

static void set_normal(const Face *face, int x, int y, Texel *texel) {
    Vec3 along_u = vec3_add(pitch(face, 0), vec3_scale(face->plane.f, slope_at(face, x, y, 0)));
    Vec3 along_v = vec3_add(pitch(face, 1), vec3_scale(face->plane.f, slope_at(face, x, y, 1)));
    Vec3 n = vec3_normalize(vec3_cross(along_u, along_v));
    const double xyz[] = {n.x, n.y, n.z};
    for (int i = 0; i < 3; i++) texel->values[4 + i] = (uint16_t)lround(65535.0 * (xyz[i] + 1.0) / 2.0);
    texel->values[7] = 65535;
}

/* ---- Tiles ---- */

/* The triangles of a tile, as spots; triangles has room for them. */
static int list_triangles(const Face *face, const Tile *tile, Spot (*triangles)[3]) {
    int count = 0;
    for (int y = tile->row; y < tile->row + tile->rows; y++) {
        for (int x = tile->column; x < tile->column + tile->columns; x++) {
            if (!face->cells[(size_t)y * (face->width - 1) + x]) continue;
            Spot spots[4];
            for (int k = 0; k < 4; k++)
                spots[k] = spot_of(face, x + corners[k].x, y + corners[k].y,
                                   displacement_at(face, x + corners[k].x, y + corners[k].y));
            for (int k = 0; k < 2; k++, count++)
                for (int i = 0; i < 3; i++) triangles[count][i] = spots[i ? i + k : 0];
        }
    }
    for (int i = 0; i < tile->rim_count; i++, count++)
        for (int k = 0; k < 3; k++) triangles[count][k] = face->rims[tile->first_rim + i].corners[k];
    return count;
}

static Vec3 normal_of(const Face *face, const Spot triangle[3]) {
    Vec3 points[3];
    for (int i = 0; i < 3; i++) points[i] = face_point(face, triangle[i].u, triangle[i].v, triangle[i].d);
    return vec3_cross(vec3_sub(points[1], points[0]), vec3_sub(points[2], points[0]));
}

static void bound_tile(const Face *face, Tile *tile, Spot (*triangles)[3], int count) {
    tile->low = (Spot){INFINITY, INFINITY, INFINITY};
    tile->high = (Spot){-INFINITY, -INFINITY, -INFINITY};
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            Spot spot = triangles[i][k];
            tile->low =
                (Spot){fminf(tile->low.u, spot.u), fminf(tile->low.v, spot.v), fminf(tile->low.d, spot.d)};
            tile->high =
                (Spot){fmaxf(tile->high.u, spot.u), fmaxf(tile->high.v, spot.v), fmaxf(tile->high.d, spot.d)};
        }
    }
    Vec3 low = face_point(face, tile->low.u, tile->low.v, tile->low.d);
    Vec3 high = face_point(face, tile->high.u, tile->high.v, tile->high.d);
    tile->centre = vec3_mix(low, high, 0.5);
    tile->radius = vec3_length(vec3_sub(high, low)) / 2.0;
}

static void face_tile(const Face *face, Tile *tile, Spot (*triangles)[3], int count) {
    Vec3 sum = {0};
    for (int i = 0; i < count; i++) sum = vec3_add(sum, normal_of(face, triangles[i]));
    tile->facing = vec3_length(sum) > 0.0 ? vec3_normalize(sum) : face->plane.f;
    for (int i = 0; i < count; i++) {
        Vec3 normal = normal_of(face, triangles[i]);
        double length = vec3_length(normal);
        if (!(length > 0.0)) continue; /* a rim without area is never drawn */
        double cosine = clamp(vec3_dot(normal, tile->facing) / length, -1.0, 1.0);
        tile->spread = fmax(tile->spread, acos(cosine));
    }
}

/* The tile whose first cell is in that column and row, unless nothing is in it. The cells half beyond the
 * image, of which only rims can come, go with the first and the last tile. */
static void add_tile(Finder *finder, int column, int row) {
    Face *face = finder->face;
    int last_column = face->width - 1, last_row = face->height - 1;
    Tile tile = {.column = column,
                 .row = row,
                 .columns = last_column - column < TILE ? last_column - column : TILE,
                 .rows = last_row - row < TILE ? last_row - row : TILE,
                 .first_rim = face->rim_count};
    int x0 = column == 0 ? -1 : column, x1 = column + tile.columns + (column + tile.columns == last_column);
    int y0 = row == 0 ? -1 : row, y1 = row + tile.rows + (row + tile.rows == last_row);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            if (add_cell(finder, x, y)) face->cells[(size_t)y * last_column + x] = 1;
    tile.rim_count = face->rim_count - tile.first_rim;
    Spot(*triangles)[3] = allocate((size_t)2 * TILE * TILE + tile.rim_count, sizeof *triangles);
    int count = list_triangles(face, &tile, triangles);
    if (count) {
        bound_tile(face, &tile, triangles, count);
        face_tile(face, &tile, triangles, count);
        face->tiles[face->tile_count++] = tile;
    }
    free(triangles);
}

/* ---- All of it ---- */

static void find_surfaces(Finder *finder) {
    Face *face = finder->face;
    for (int way = 0; way < 4; way++)
        for (int i = 0; i < FACES; i++)
            if (vec3_dot(vec3_normalize(pitch(face, way)), finder->box->faces[i].plane.f) > 0.5)
                finder->side[way] = i;
    int columns = (face->width - 2) / TILE + 1, rows = (face->height - 2) / TILE + 1;
    face->cells = allocate((size_t)(face->width - 1) * (face->height - 1), 1);
    face->tiles = allocate((size_t)columns * rows, sizeof *face->tiles);
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) add_tile(finder, column * TILE, row * TILE);
    for (int y = 0; y < face->height; y++)
        for (int x = 0; x < face->width; x++)
            if (is_there(face, x, y))
                set_normal(face, x, y, &finder->box->texels[face->first + (size_t)y * face->width + x]);
}

void box_find_surfaces(Box *box, Walls walls) {
    for (int i = 0; i < FACES; i++)
        find_surfaces(&(Finder){.box = box, .face = &box->faces[i], .walls = walls});
}
