// The hard cases of this lesson's functions. u is float's unit roundoff, 2^-24. What is whole numbers has no
// rounding at all: bounds of 0, the same from GLSL and from GLM.

// ---- block_at, in_rows: the first and the last

CASE_EQUALS("first block", 0, "", ivec2(0, 0), block_at(ivec2(0, 0), ivec2(0, 0), ivec2(16, 16)))
CASE_EQUALS("last along s and t beside the next u and v", 0, "", ivec2(47, 31),
            block_at(ivec2(2, 1), ivec2(15, 15), ivec2(16, 16)))
CASE_EQUALS("one block along s and t", 0, "", ivec2(7, 3), block_at(ivec2(7, 3), ivec2(0, 0), ivec2(1, 1)))
CASE_EQUALS("last of a row", 0, "", ivec2(4095, 0), in_rows(4095, 12))
CASE_EQUALS("first of the next row", 0, "", ivec2(0, 1), in_rows(4096, 12))
CASE_EQUALS("the last leaf that 26 bits can name", 0, "", ivec2(4095, 16383), in_rows(67108863, 12))

// ---- ramp_place: entries as ramp.h has them

CASE_EQUALS("black", 0, "", 0, ramp_place(0u, ivec4(511, 255, 31, 31)).leaf)
CASE_EQUALS("one leaf: its last texel", 0, "", ivec4(7, 7, 1, 1), ramp_place(64u, ivec4(15, 7, 1, 3)).within)
CASE_EQUALS("one leaf: the first texel behind a border on all sides", 0, "", ivec4(0, 0, 0, 0),
            ramp_place(64u, ivec4(8, 16, 2, 30)).within)
CASE_EQUALS("halved along u alone: the left leaf", 0, "", 5, ramp_place(0x141u, ivec4(3, 7, 1, 1)).leaf)
CASE_EQUALS("halved along u alone: the right leaf", 0, "", 6, ramp_place(0x141u, ivec4(4, 7, 1, 1)).leaf)
CASE_EQUALS("halved along t alone", 0, "", 6, ramp_place(0x160u, ivec4(7, 7, 1, 1)).leaf)
CASE_EQUALS("halved along s alone: its place goes", 0, "", ivec4(7, 7, 0, 1),
            ramp_place(0x150u, ivec4(7, 7, 1, 1)).within)
CASE_EQUALS("halved as often as can be: the last leaf", 0, "", 260,
            ramp_place(0x17fu, ivec4(7, 7, 1, 1)).leaf)
CASE_EQUALS("halved as often as can be: a leaf is a texel", 0, "", ivec4(0),
            ramp_place(0x17fu, ivec4(5, 6, 1, 0)).within)
CASE_EQUALS("u before v before s", 0, "", 30, ramp_place(0x15au, ivec4(3, 5, 1, 0)).leaf)
CASE_EQUALS("v alone in four", 0, "", 8, ramp_place(0x148u, ivec4(7, 6, 0, 0)).leaf)
CASE_EQUALS("the last leaf that 26 bits can name: no sign", 0, "", 1,
            ramp_place(0xffffffc0u, ivec4(0)).leaf - 67108862)

// ---- ten_bits: two's complement

CASE_EQUALS("-1 in the lowest", 0, "", -1.0, ten_bits(0x000003ffu, 22u))
CASE_EQUALS("-1 in the middle", 0, "", -1.0, ten_bits(0x000ffc00u, 12u))
CASE_EQUALS("the most: all bits around", 0, "", 511.0, ten_bits(0xdffffffeu, 2u))
CASE_EQUALS("the least: no bits around", 0, "", -512.0, ten_bits(0x20000000u, 2u))
CASE_EQUALS("below the highest bit", 0, "", -1.0, ten_bits(0x7fe00000u, 1u))

// ---- ramp_light: the root is 127 or less, off by 3 u of that after the mix and by what the share is off,
// which is of numbers up to 256: 256 * 3 u; a square doubles it. Cases whose share is a whole number have the
// end's colour.

CASE_EQUALS("first colour: cut off below", 6 * 0x1p-24, "linear", vec3(1.0, 0.0, 0.253952508),
            ramp_light(uvec3(0x8030007fu, 0x80000000u, 0xc0000000u), ivec4(7, 7, 1, 1)))
CASE_EQUALS("second colour: a share of 1", 6 * 0x1p-24, "linear", vec3(0.0, 1.0, 0.253952508),
            ramp_light(uvec3(0x4000007fu, 0x00103f80u, 0u), ivec4(7, 7, 1, 1)))
CASE_EQUALS("cut off above: the steepest", 6 * 0x1p-24, "linear", vec3(1.0, 1.0, 1.0),
            ramp_light(uvec3(0x7fe00000u, 0xbfffffffu, 0xdff7fdffu), ivec4(7, 7, 1, 1)))
CASE_EQUALS("half way is a quarter of the light", 6 * 0x1p-24, "linear", vec3(0.25, 0.25, 0.25),
            ramp_light(uvec3(0u, 0x001fffffu, 0u), ivec4(7, 7, 1, 1)))
CASE_EQUALS("up along u: the next texel", 6 * 0x1p-24, "linear", vec3(1.0, 1.0, 1.0),
            ramp_light(uvec3(0u, 0x801fffffu, 0x00000100u), ivec4(1, 0, 0, 0)))
CASE_EQUALS("up along u and no other axis", 6 * 0x1p-24, "linear", vec3(0.25, 0.25, 0.25),
            ramp_light(uvec3(0u, 0x801fffffu, 0x00000100u), ivec4(0, 7, 1, 1)))
CASE_EQUALS("up along v: the next texel", 6 * 0x1p-24, "linear", vec3(1.0, 1.0, 1.0),
            ramp_light(uvec3(0u, 0x801fffffu, 0x00040000u), ivec4(0, 1, 0, 0)))
CASE_EQUALS("up along v and no other axis", 6 * 0x1p-24, "linear", vec3(0.25, 0.25, 0.25),
            ramp_light(uvec3(0u, 0x801fffffu, 0x00040000u), ivec4(7, 0, 1, 1)))
CASE_EQUALS("up along s: the next texel", 6 * 0x1p-24, "linear", vec3(1.0, 1.0, 1.0),
            ramp_light(uvec3(0u, 0x801fffffu, 0x10000000u), ivec4(0, 0, 1, 0)))
CASE_EQUALS("up along s and no other axis", 6 * 0x1p-24, "linear", vec3(0.25, 0.25, 0.25),
            ramp_light(uvec3(0u, 0x801fffffu, 0x10000000u), ivec4(7, 7, 0, 1)))
CASE_EQUALS("up along t: the next texel", 6 * 0x1p-24, "linear", vec3(1.0, 1.0, 1.0),
            ramp_light(uvec3(0u, 0xa01fffffu, 0u), ivec4(0, 0, 0, 1)))
CASE_EQUALS("up along t and no other axis", 6 * 0x1p-24, "linear", vec3(0.25, 0.25, 0.25),
            ramp_light(uvec3(0u, 0xa01fffffu, 0u), ivec4(7, 7, 1, 0)))
CASE("a slope along each axis", 2 * 256 * 3 * 0x1p-24, "linear",
     ramp_light(uvec3(0x01e12345u, 0x8ed9abcdu, 0x31f0c86fu), ivec4(3, 2, 1, 1)))
CASE("steep: what is left of two that all but cancel", 2 * 256 * 3 * 0x1p-24, "linear",
     ramp_light(uvec3(0xf2000000u, 0x801fffffu, 0xc00000ffu), ivec4(7, 0, 0, 0)))

// ---- vq_light: a code from one block's place, a texel from that code's patch

CASE_NUMBERS(codes, 6, 4, uvec4(uint(6 * y + x + 120), 0u, 0u, 0u))
CASE_TEXTURE(book, 512, 8, vec4(float(x) / 512.0, float(y) / 8.0, 0.5, 1.0))

CASE_EQUALS("first of a patch", 0, "linear", vec3(0.9375, 0.0, 0.5),
            vq_light(codes, book, ivec4(0, 0, 0, 0), ivec2(3, 2)))
CASE_EQUALS("last of a patch", 0, "linear", vec3(0.943359375, 0.375, 0.5),
            vq_light(codes, book, ivec4(3, 3, 0, 0), ivec2(3, 2)))
CASE_EQUALS("the next row of patches", 0, "linear", vec3(0.009765625, 0.625, 0.5),
            vq_light(codes, book, ivec4(5, 1, 0, 1), ivec2(3, 2)))

// ---- ramp_texel, ramp_four: 8 x 8 x 2 x 2 texels are a block; in entry n of the table (`blocks`) the four
// are leaves 4n, 4n + 1, ...

CASE_NUMBERS(blocks, 6, 4,
             uvec4(uint(4 * (6 * y + x)) << 6u, uint(4 * (6 * y + x) + 1) << 6u,
                   uint(4 * (6 * y + x) + 2) << 6u, uint(4 * (6 * y + x) + 3) << 6u))
CASE_NUMBERS(leaves, 128, 1, uvec4(uint(x), uint(x), 0u, 0u))

CASE_EQUALS("a texel of leaf 101", 6 * 0x1p-24, "linear", vec3(0.632463265, 0.0, 0.0),
            ramp_texel(leaves, 0x1940u, ivec4(7, 7, 1, 1)))
CASE_EQUALS("four of one block: the last", 6 * 0x1p-24, "linear", vec3(0.048608097, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 2, 2), vec2(1.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: the first", 6 * 0x1p-24, "linear", vec3(0.048608097, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(0.0, 0.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: next along s", 6 * 0x1p-24, "linear", vec3(0.052142104, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(1.0, 0.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: next along t", 6 * 0x1p-24, "linear", vec3(0.055800112, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(0.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: next along both", 6 * 0x1p-24, "linear", vec3(0.059582119, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(1.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("two blocks along s: next along t is the same", 6 * 0x1p-24, "linear",
            vec3(0.048608097, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 2), vec2(0.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("two blocks along t: next along both is next along t", 6 * 0x1p-24, "linear",
            vec3(0.055800112, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 2, 3), vec2(1.0, 1.0), ivec2(3, 2)))
