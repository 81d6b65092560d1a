/* Ramps: blocks of 8 x 8 x 2 x 2 texels, cut into equal leaves; a leaf is two colours and a ramp between
 * them, which is a linear function of u, v, s, t cut off at 0 and 1.
 *
 * Whatever straight edge a light field shows, of an object seen past another, is such a ramp in all four
 * dimensions, one texel wide; so is smooth shading, in a small block. How finely a block is cut is its own
 * affair: that of least error + RAMP_PRICE (knob / 4)^2 for each leaf, in squared codes of sRGB. A table says
 * for each block where its leaves are, and how often it is halved along each axis; black blocks share one
 * leaf.
 *
 * A table's entry: bits 0-1 halvings along u, 2-3 along v, 4 along s, 5 along t, 6-31 its first leaf; its
 * other leaves follow, u fastest. A leaf: bytes 0-2 the first colour, as 255 sqrt(light); 3 and 7 the low and
 * the high byte of 1024 level; 4-6 the second colour; then 4096 slope along u, v, s, t, sixteen bits each.
 * All are little endian and in two's complement. A texel that is x from the leaf's lowest one has the share
 * level + slope . x, cut off at 0 and 1, of the second colour. */
#ifndef LESSON_RAMP_H
#define LESSON_RAMP_H

#define RAMP_PRICE 192.0 /* what one code in all three channels of 64 texels comes to */

#endif
