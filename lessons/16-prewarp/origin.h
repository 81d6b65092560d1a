/* Where a destination texel comes from, in four bytes; and the texel that lies there. */
#ifndef LESSON_ORIGIN_H
#define LESSON_ORIGIN_H

#include "lanes.h"
#include "warp.h"

/* u and v in 1/65536 of the source, v in the upper half: four bytes against a texel's eight. */
typedef uint32_t Origin;

static const Origin NOWHERE = 0xffffffff; /* which rounds to no u and v of a cell: v ends at 65534 */

static inline Origin origin_of(float u, float v) { return (uint32_t)(int)v << 16 | (uint32_t)(int)u; }

/* A number of 1/65536 of an axis of so many texels, in 1/65536 of a texel from the first one's centre. */
static inline int from_centre(uint32_t share, int texels) { return (int)share * texels - 32768; }

/* Where an origin lies: between texels column and right of rows row and above, and so many 1/256 on. The
 * image repeats. */
typedef struct {
    int column, right, row, above, s, t;
} Place;

INLINE Place place_of(const Source *source, Origin origin) {
    int width = source->width, height = source->height;
    int u = from_centre(origin & 65535, width), v = from_centre(origin >> 16, height);
    int i = u >> 16, j = v >> 16; /* from -1 */
    return (Place){.column = i < 0 ? width - 1 : i,
                   .right = i + 1 < width ? i + 1 : 0,
                   .row = j < 0 ? height - 1 : j,
                   .above = j + 1 < height ? j + 1 : 0,
                   .s = u >> 8 & 255,
                   .t = v >> 8 & 255};
}

/* The source's level at an origin, bilinear. */
INLINE float level_at(const Source *source, Origin origin) {
    Place p = place_of(source, origin);
    const uint16_t *row = source->levels + (size_t)p.row * source->width;
    const uint16_t *next = source->levels + (size_t)p.above * source->width;
    float s = (float)p.s / 256, t = (float)p.t / 256;
    float below = row[p.column] + s * (float)(row[p.right] - row[p.column]);
    float above = next[p.column] + s * (float)(next[p.right] - next[p.column]);
    return below + t * (above - below);
}

/* The texels at so many origins, bilinear, byte by byte in 1/256; where an origin is NOWHERE, all bytes are
 * 0. The origins lie at any address, each behind the texel that is made of it or in other memory. */
void origins_fetch(const Source *source, const uint8_t *origins, size_t count, Texel *texels);

/* The same for lookups: u, v and h, three floats an origin. */
void origins_lookup(const Source *source, const uint8_t *origins, size_t count, float *lookup);

#endif
