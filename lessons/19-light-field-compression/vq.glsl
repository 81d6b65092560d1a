// Vector quantization: of a block of 4 x 4 texels along u and v there is the number of a code, and in the codebook's
// picture, 512 texels wide, each code is 4 x 4 texels.
#include "blocks.glsl"

vec3 vq_light(usampler2D codes, sampler2D book, ivec4 at, ivec2 across) {
    int code = int(texelFetch(codes, block_at(ivec2(at.xy) >> 2, ivec2(at.zw), across), 0).r);
    return texelFetch(book, in_rows(code, 7) * 4 + (ivec2(at.xy) & 3), 0).rgb;
}
