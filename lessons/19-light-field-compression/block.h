/* The GPU's own block compression: 4 x 4 texels, here along u and v, all of one s and t, for neighbours there
 * are most alike. Each has two colours and for each texel its place between them.
 *
 * bc1 (S3TC's DXT1; EXT_texture_compression_s3tc): 8 bytes. Colours of 5, 6, 5 bits; 2 bits a texel. If the
 * first colour, as a number, is greater than the second: four places, 0, 3/3, 1/3, 2/3; else three, 0, 2/2,
 * 1/2, and black, which most texels of a light field are. bc7 (ARB_texture_compression_bptc), of whose eight
 * modes the encoder uses mode 6: 16 bytes. Colours of 7 bits and one more for all channels together; 4 bits a
 * texel, its first 3, for of its two colours either may be first.
 *
 * A plane is the texture's blocks, row for row. */
#ifndef LESSON_BLOCK_H
#define LESSON_BLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum { BC1_BYTES = 8, BC7_BYTES = 16 };

/* patch: 4 x 4 texels, three bytes of sRGB each, row for row. */
void bc1_encode(const uint8_t patch[48], uint8_t block[BC1_BYTES]);
void bc1_decode(const uint8_t block[BC1_BYTES], int texel, uint8_t colour[3]); /* texel: 0 to 15 */
void bc7_encode(const uint8_t patch[48], uint8_t block[BC7_BYTES]);
/* Mode 6 alone; false for a block of another. */
bool bc7_decode(const uint8_t block[BC7_BYTES], int texel, uint8_t colour[3]);

#endif
