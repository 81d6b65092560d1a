/* Four numbers at once: of each operation the compiler makes one instruction, and a comparison gives all bits
 * or none. (In plain loops it finds such vectors by itself only where there is nothing to choose.) */
#ifndef LESSON_LANES_H
#define LESSON_LANES_H

#include <stdint.h>
#include <string.h>

enum { LANES = 4 };

typedef float Floats __attribute__((vector_size(4 * LANES)));
typedef int32_t Ints __attribute__((vector_size(4 * LANES)));

static inline Floats floats(float x) { return (Floats){x, x, x, x}; }
static inline Ints ints(int32_t x) { return (Ints){x, x, x, x}; }

static inline Floats floats_load(const float *from) {
    Floats lanes;
    memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

static inline Ints ints_load(const uint32_t *from) {
    Ints lanes;
    memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

/* yes where a comparison held, no elsewhere. */
static inline Ints ints_choose(Ints held, Ints yes, Ints no) { return (yes & held) | (no & ~held); }
static inline Floats floats_choose(Ints held, Floats yes, Floats no) {
    return (Floats)ints_choose(held, (Ints)yes, (Ints)no);
}

/* Where a is no number: b. */
static inline Floats least(Floats a, Floats b) { return floats_choose(a < b, a, b); }
static inline Floats greatest(Floats a, Floats b) { return floats_choose(a > b, a, b); }

#endif
