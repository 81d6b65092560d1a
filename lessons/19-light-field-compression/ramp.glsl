// Ramps (ramp.h): a table says where a block's leaves are, and a leaf is two colours and a ramp between them.
#include "blocks.glsl"

const int RAMP_LEAVES = 12; // a row of their texture has 2^12

// The number of a texel's leaf, and the texel's place in it.
struct RampPlace {
    int leaf;
    ivec4 within;
};

// entry: of the block's, in the table. Its halvings: two bits for u and for v, one for s and for t; a leaf is what
// they leave of 8 x 8 x 2 x 2 texels. The first leaf is above them.
RampPlace ramp_place(uint entry, ivec4 at) {
    ivec4 halved = ivec4(uvec4(entry, entry >> 2u, entry >> 4u, entry >> 5u) & uvec4(3u, 3u, 1u, 1u));
    ivec4 size = ivec4(3, 3, 1, 1) - halved, within = at & ivec4(7, 7, 1, 1), cell = within >> size;
    int number = ((cell.w << halved.z | cell.z) << halved.y | cell.y) << halved.x | cell.x;
    return RampPlace(int(entry >> 6u) + number, within & ((ivec4(1) << size) - 1));
}

// Sixteen bits as a number from -32768 on: the lower half, and the upper.
float low_half(uint bits) { return float(int(bits << 16u) >> 16); }
float high_half(uint bits) { return float(int(bits) >> 16); }

// Colours are 255 roots of light, the ramp is in units of 1/1024, its slopes in 1/4096.
vec3 ramp_light(uvec4 leaf, ivec4 within) {
    vec3 a = vec3(leaf.x & 255u, leaf.x >> 8u & 255u, leaf.x >> 16u & 255u);
    vec3 b = vec3(leaf.y & 255u, leaf.y >> 8u & 255u, leaf.y >> 16u & 255u);
    float level = float((int(leaf.y) >> 24) * 256 + int(leaf.x >> 24u));
    vec4 slope = vec4(low_half(leaf.z), high_half(leaf.z), low_half(leaf.w), high_half(leaf.w));
    vec3 root = mix(a, b, clamp(level * (1.0 / 1024.0) + dot(slope, vec4(within)) * (1.0 / 4096.0), 0.0, 1.0));
    return root * root * (1.0 / 65025.0);
}

vec3 ramp_texel(usampler2D leaves, uint entry, ivec4 at) {
    RampPlace place = ramp_place(entry, at);
    return ramp_light(texelFetch(leaves, in_rows(place.leaf, RAMP_LEAVES), 0), place.within);
}

// Four texels, at and one further along s, along t, and along both, mixed by part. Their blocks are one, or two, or
// four: the table's texture holds with a block's entry (x) those of the next along s (y), t (z) and both (w), so that one
// fetch does for all.
vec3 ramp_four(usampler2D table, usampler2D leaves, ivec4 at, vec2 part, ivec2 across) {
    uvec4 entries = texelFetch(table, block_at(ivec2(at.xy) >> 3, ivec2(at.zw) >> 1, across), 0);
    bool next_s = (at.z & 1) != 0, next_t = (at.w & 1) != 0;
    uint right = next_s ? entries.y : entries.x, up = next_t ? entries.z : entries.x;
    uint both = next_t ? (next_s ? entries.w : entries.z) : right;
    vec3 low = mix(ramp_texel(leaves, entries.x, at), ramp_texel(leaves, right, at + ivec4(0, 0, 1, 0)), part.x);
    vec3 high = mix(ramp_texel(leaves, up, at + ivec4(0, 0, 0, 1)), ramp_texel(leaves, both, at + ivec4(0, 0, 1, 1)),
                    part.x);
    return mix(low, high, part.y);
}
