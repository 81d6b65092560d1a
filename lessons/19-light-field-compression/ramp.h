/* Ramps: blocks of 8 x 8 x 2 x 2 texels, cut into equal leaves; a leaf is two colours and a ramp between
 * them, which is a linear function of u, v, s, t cut off at 0 and 1.
 *
 * Whatever straight edge a light field shows, of an object seen past another, is such a ramp in all four
 * dimensions, one texel wide; so is smooth shading, in a small block. How finely a block is cut is its own
 * affair: that of least error + RAMP_PRICE (knob / 4)^2 for each leaf, in squared codes. A table says for
 * each block where its leaves are, and how often it is halved along each axis; black blocks share one leaf.
 *
 * A table's entry: bits 0-1 halvings along u, 2-3 along v, 4 along s, 5 along t, 6-31 its first leaf; its
 * other leaves follow, u fastest. Entry 0 is black. A leaf is three words of 32 bits, of two's complement
 * where negative. Word 0: bits 0-20 the first colour, 127 sqrt(light) in seven bits each, red in the lowest;
 * 21-31 the level. Word 1: 0-20 the second colour; 21-30 the slope along t; 31 the highest bit of e. Word 2:
 * ten bits each for the slopes along u, v and s; 30-31 the lower bits of e. A texel that is x from the leaf's
 * lowest one has, with the scale 2^e / 16, the share 1/2 + scale (level / 64 + slope . x / 512),   cut off at
 * 0 and 1, of the second colour. All is little endian. */
#ifndef LESSON_RAMP_H
#define LESSON_RAMP_H

#define RAMP_PRICE 192.0 /* what one code in all three channels of 64 texels comes to */
enum { RAMP_LEAF_BYTES = 12 };

#endif
