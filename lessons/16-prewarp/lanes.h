/* Eight numbers at a time: the compiler's own vectors, which it turns into whatever SIMD the machine has.
 * What works on them are macros, for a function may not take so wide a vector where the machine has none. */
#ifndef LESSON_LANES_H
#define LESSON_LANES_H

#include <stdint.h>
#include <string.h>

enum { LANES = 8 };

typedef float Floats __attribute__((vector_size(32)));
typedef int32_t Ints __attribute__((vector_size(32)));

/* Comparisons make an Ints of -1 where they hold and 0 where not: `yes` in these. */
#define PICK(yes, a, b) ((Floats)(((Ints)(a) & (yes)) | ((Ints)(b) & ~(yes))))
#define LEAST(a, b) PICK((a) < (b), a, b)
#define GREATEST(a, b) PICK((a) > (b), a, b)

#define FLOATS_OF(ints) __builtin_convertvector(ints, Floats)
#define INTS_OF(floats) __builtin_convertvector(floats, Ints) /* toward 0 */
#define CEIL(floats) (INTS_OF(floats) - (FLOATS_OF(INTS_OF(floats)) < (floats)))
#define ALL(number) ((number) + (Floats){0})

/* To and from memory, wherever that lies. */
#define LOAD(vector, from) memcpy(&(vector), from, sizeof(vector))
#define STORE(vector, to) memcpy(to, &(vector), sizeof(vector))

/* A function compiled twice, for machines with AVX2 and for all others; the program takes the one it can run.
 */
#ifdef __x86_64__
#define WIDE __attribute__((target_clones("avx2", "default")))
#else
#define WIDE
#endif

#endif
