/* Vector quantization (M. Levoy and P. Hanrahan, "Light Field Rendering", 1996, section 4.2): a block of 4 x
 * 4 texels along u and v, all of one s and t, is a vector of 48 numbers, and is replaced by the nearest of a
 * codebook of at most 2^knob. Levoy and Hanrahan's blocks are 2 x 2 x 2 x 2; but neighbours along u here are
 * a tenth of the angle apart that neighbours along s are.
 *
 * The codebook is trained on some bands' vectors, each distinct one counted as often as it is there (Linde,
 * Buzo and Gray 1980): begin with the mean; move each code to the mean of the vectors that are nearest to it,
 * some times; split those with the largest error, into themselves and their farthest vector; and so on. Code
 * 0 is black.
 *
 * Planes: the codebook, 48 bytes of sRGB a code, u fastest; and a block's code, one byte for knobs up to 8,
 * else two, little endian. */
#ifndef LESSON_VQ_H
#define LESSON_VQ_H

enum { VQ_ROUNDS_MOST = 16 };

/* Bytes of a code in the plane of codes. */
static inline int vq_code_bytes(int knob) { return knob <= 8 ? 1 : 2; }

#endif
