// The GPU's own blocks, 4 x 4 texels along u and v, which its texture unit decodes.
#include "field.inc"
#include "blocks.glsl"

uniform sampler2D blocks;
uniform vec4 across; // blocks along u, v, s, t

vec3 texel(ivec4 at) {
    return texelFetch(blocks, block_at(ivec2(at.xy) >> 2, ivec2(at.zw), ivec2(across.zw)) * 4 + (ivec2(at.xy) & 3), 0).rgb;
}

#include "taps.inc"
#include "shown.inc"
