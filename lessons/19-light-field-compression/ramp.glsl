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

// Ten bits of a word as a number from -512 on; above: how many bits are above them.
float ten_bits(uint word, uint above) { return float(int(word << above) >> 22); }

// Colours are 127 roots of light; the ramp is in units of its own scale.
vec3 ramp_light(uvec3 leaf, ivec4 within) {
    vec3 a = vec3(leaf.x & 127u, leaf.x >> 7u & 127u, leaf.x >> 14u & 127u);
    vec3 b = vec3(leaf.y & 127u, leaf.y >> 7u & 127u, leaf.y >> 14u & 127u);
    float scale = float(1u << (leaf.z >> 30u | leaf.y >> 31u << 2u)) * (1.0 / 16.0 / 512.0);
    float level = float(int(leaf.x) >> 21);
    vec4 slope = vec4(ten_bits(leaf.z, 22u), ten_bits(leaf.z, 12u), ten_bits(leaf.z, 2u), ten_bits(leaf.y, 1u));
    vec3 root = mix(a, b, clamp(0.5 + scale * (8.0 * level + dot(slope, vec4(within))), 0.0, 1.0));
    return root * root * (1.0 / 16129.0);
}

vec3 ramp_texel(usampler2D leaves, uint entry, ivec4 at) {
    RampPlace place = ramp_place(entry, at);
    return ramp_light(texelFetch(leaves, in_rows(place.leaf, RAMP_LEAVES), 0).rgb, place.within);
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
