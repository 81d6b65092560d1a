/* Several numbers at a time: the compiler's own vectors, which it turns into the machine's SIMD. What works
 * on them are macros, for a function may not take a vector wider than the machine surely has. */
#ifndef TEXEL_LANES_H
#define TEXEL_LANES_H

#include <stdint.h>
#include <string.h>

/* Part of every function that calls it: so it is compiled for AVX2 where the caller is. (A call from such
 * code to code that uses the older registers can make the machine wait.) */
#define INLINE static inline __attribute__((always_inline))

/* Eight where the program can choose as it starts between code for AVX2 and code for any x86-64 (WIDE asks
 * for both), else four, which every machine has. Who wants four anyway defines LANES so before. */
#if defined __x86_64__ && !defined LANES
#define LANES 8
#define WIDE __attribute__((target_clones("avx2", "default")))
#define RAMP ((Ints){0, 1, 2, 3, 4, 5, 6, 7})
#else
#ifndef LANES
#define LANES 4
#endif
#define WIDE
#define RAMP ((Ints){0, 1, 2, 3})
#endif

typedef float Floats __attribute__((vector_size(4 * LANES)));
typedef int32_t Ints __attribute__((vector_size(4 * LANES)));
typedef uint32_t Uints __attribute__((vector_size(4 * LANES)));
typedef uint16_t Shorts __attribute__((vector_size(2 * LANES)));

/* Comparisons make an Ints of -1 where they hold and 0 where not: `yes` in these. */
#define PICK_INTS(yes, a, b) (((a) & (yes)) | ((b) & ~(yes)))
#define PICK(yes, a, b) ((Floats)PICK_INTS(yes, (Ints)(a), (Ints)(b)))
/* By lane, for which compilers know one instruction; b where a is no number. */
#define LEAST(a, b) BY_LANE(<, a, b)
#define GREATEST(a, b) BY_LANE(>, a, b)
#define BY_LANE(before, a, b)                                                                                \
    __extension__({                                                                                          \
        Floats a_ = (a), b_ = (b), c_;                                                                       \
        for (int k_ = 0; k_ < LANES; k_++) c_[k_] = a_[k_] before b_[k_] ? a_[k_] : b_[k_];                  \
        c_;                                                                                                  \
    })

#define FLOATS_OF(ints) __builtin_convertvector(ints, Floats)
#define INTS_OF(floats) __builtin_convertvector(floats, Ints) /* toward 0 */
#define CEIL(floats) (INTS_OF(floats) - (FLOATS_OF(INTS_OF(floats)) < (floats)))
#define ALL(number) ((number) + (Floats){0})

/* The bits that any lane has, as one integer; and whether some or all lanes are `yes`. */
typedef int64_t LongInts __attribute__((vector_size(4 * LANES)));
#if LANES == 8
#define EITHER_LONG(longs) ((longs)[0] | (longs)[1] | (longs)[2] | (longs)[3])
#else
#define EITHER_LONG(longs) ((longs)[0] | (longs)[1])
#endif
#define EITHER(ints) (EITHER_LONG((LongInts)(ints)) | EITHER_LONG((LongInts)(ints)) >> 32)
#define ANY(yes) (EITHER_LONG((LongInts)(yes)) != 0)
#define ALL_OF(yes) (!ANY(~(yes)))

/* To and from memory, wherever that lies. */
#define FLOATS_AT(from)                                                                                      \
    __extension__({                                                                                          \
        Floats at_;                                                                                          \
        memcpy(&at_, from, sizeof at_);                                                                      \
        at_;                                                                                                 \
    })
#define LOAD(vector, from) memcpy(&(vector), from, sizeof(vector))
#define STORE(vector, to) memcpy(to, &(vector), sizeof(vector))

#endif
