#include "origin.h"

/* Two times two texels that are neighbours in a row, byte by byte or two bytes a word. */
typedef uint16_t Words __attribute__((vector_size(32)));
typedef uint64_t Pair __attribute__((vector_size(16)));
typedef uint64_t Longs __attribute__((vector_size(32)));

/* (1 - weight / 256) a + weight / 256 b, rounded: exact in 16 bits. */
#define MIX(a, b, weight) (((a) * (256 - (weight)) + (b) * (weight) + 128) >> 8)

/* The texel at an origin, wherever that lies. */
INLINE Texel texel_at(const Source *source, Origin origin) {
    Texel texel = {0};
    if (origin == NOWHERE) return texel;
    Place p = place_of(source, origin);
    const Texel *row = source->texels + (size_t)p.row * source->width;
    const Texel *next = source->texels + (size_t)p.above * source->width;
    const uint8_t *p00 = row[p.column].colour, *p10 = row[p.right].colour;
    const uint8_t *p01 = next[p.column].colour, *p11 = next[p.right].colour;
    uint8_t *bytes = (uint8_t *)&texel;
    for (int c = 0; c < 8; c++)
        bytes[c] = (uint8_t)MIX(MIX(p00[c], p01[c], p.t), MIX(p10[c], p11[c], p.t), p.s);
    return texel;
}

static void fetch_lookup(const Source *source, Origin origin, float *lookup) {
    lookup[0] = (float)(origin & 65535) / 65536;
    lookup[1] = (float)(origin >> 16) / 65536;
    lookup[2] = level_at(source, origin) / 65535;
}

/* A word is two bytes of a texel; both are mixed at once, each in a vector of its own. */
#define LOW(words) ((words)&255)
#define HIGH(words) ((words) >> 8)

/* Texels `first` and `second` of a block, each with its right neighbour, mixed with those above by t: the
 * even bytes and the odd ones. */
#define MIX_ROWS(even, odd, first, second)                                                                   \
    {                                                                                                        \
        const Texel *p_ = source->texels + index[first], *q_ = source->texels + index[second];               \
        Pair p0_, p1_, q0_, q1_;                                                                             \
        LOAD(p0_, p_), LOAD(q0_, q_), LOAD(p1_, p_ + width), LOAD(q1_, q_ + width);                          \
        Words a_ = (Words)__builtin_shufflevector(p0_, q0_, 0, 1, 2, 3),                                     \
              b_ = (Words)__builtin_shufflevector(p1_, q1_, 0, 1, 2, 3);                                     \
        Words t_ = (Words)__builtin_shufflevector(t, t, first, first, first, first, second, second, second,  \
                                                  second);                                                   \
        even = MIX(LOW(a_), LOW(b_), t_), odd = MIX(HIGH(a_), HIGH(b_), t_);                                 \
    }

/* Texels first to first + 3 of a block. */
#define FETCH_FOUR(first)                                                                                    \
    {                                                                                                        \
        Words even0, even1, odd0, odd1;                                                                      \
        MIX_ROWS(even0, odd0, first, first + 2)                                                              \
        MIX_ROWS(even1, odd1, first + 1, first + 3)                                                          \
        Words s_ = (Words)__builtin_shufflevector(s, s, first, first, first + 1, first + 1, first + 2,       \
                                                  first + 2, first + 3, first + 3);                          \
        Words even = MIX(LEFT(even0, even1), RIGHT(even0, even1), s_);                                       \
        Words odd = MIX(LEFT(odd0, odd1), RIGHT(odd0, odd1), s_);                                            \
        Words both = even | odd << 8;                                                                        \
        STORE(both, texels + n + (first));                                                                   \
    }
#define LEFT(a, b) ((Words)__builtin_shufflevector((Longs)(a), (Longs)(b), 0, 4, 2, 6))
#define RIGHT(a, b) ((Words)__builtin_shufflevector((Longs)(a), (Longs)(b), 1, 5, 3, 7))

WIDE static void fetch_texels(const Source *source, const uint8_t *origins, size_t count, Texel *texels) {
    const int width = source->width, height = source->height;
    size_t n = 0, even = width > 1 && height > 1 ? count / LANES * LANES : 0;
    for (; n < even; n += LANES) {
        Uints origin;
        LOAD(origin, origins + n * sizeof(Origin));
        Ints x = (Ints)(origin & 65535) * width - 32768, y = (Ints)(origin >> 16) * height - 32768;
        Ints i = x >> 16, j = y >> 16;
        Ints edge = ((Uints)i >= (uint32_t)(width - 1)) | ((Uints)j >= (uint32_t)(height - 1));
        Ints nowhere = origin == NOWHERE;
        if (ANY(edge) && ALL_OF(nowhere)) {
            memset(texels + n, 0, LANES * sizeof *texels);
            continue;
        }
        Ints at = (j * width + i) & ~edge;
        int index[LANES];
        STORE(at, index);
        x = x >> 8 & 255, y = y >> 8 & 255;
        Ints s = x | x << 16, t = y | y << 16;
        FETCH_FOUR(0)
        if (LANES > 4) FETCH_FOUR(4)
        if (ANY(edge))
            for (int k = 0; k < LANES; k++)
                if (edge[k]) texels[n + k] = texel_at(source, origin[k]);
    }
    for (; n < count; n++) {
        Origin origin;
        memcpy(&origin, origins + n * sizeof origin, sizeof origin);
        texels[n] = texel_at(source, origin);
    }
}

void origins_fetch(const Source *source, const uint8_t *origins, size_t count, Texel *texels) {
    fetch_texels(source, origins, count, texels);
}

void origins_lookup(const Source *source, const uint8_t *origins, size_t count, float *lookup) {
    for (size_t n = 0; n < count; n++, lookup += 3) {
        Origin origin;
        memcpy(&origin, origins + n * sizeof origin, sizeof origin);
        if (origin == NOWHERE)
            lookup[0] = lookup[1] = lookup[2] = 0;
        else
            fetch_lookup(source, origin, lookup);
    }
}
