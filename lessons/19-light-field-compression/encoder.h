/* Encoding by a program of its own, build/19-encode, so that the memory it takes is its own, and what is
 * shown is what was in a file. */
#ifndef LESSON_ENCODER_H
#define LESSON_ENCODER_H

#include "codec.h"

typedef struct {
    double seconds, peak_memory_mib; /* synthesis not counted; the most memory that the program ever had */
    uint64_t bytes;                  /* of the file */
} Encoder;

/* Encodes the composed scene as a field of that size, 7 rays a texel, or the raw light field in the file
 * `from`, if it is not NULL, and reads what came out. Ends the program with a line if the other one failed.
 */
Encoder encoder_run(const Field *field, const char *from, const Codec *codec, int knob, Encoded *encoded);

#endif
