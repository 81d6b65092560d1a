// The hard cases of this lesson's functions. u is float's unit roundoff, 2^-24. What is whole numbers has no
// rounding at all: bounds of 0, the same from GLSL and from GLM.

// ---- block_at, in_rows: the first and the last

CASE_EQUALS("first block", 0, "", ivec2(0, 0), block_at(ivec2(0, 0), ivec2(0, 0), ivec2(16, 16)))
CASE_EQUALS("last along s and t beside the next u and v", 0, "", ivec2(47, 31), block_at(ivec2(2, 1), ivec2(15, 15), ivec2(16, 16)))
CASE_EQUALS("one block along s and t", 0, "", ivec2(7, 3), block_at(ivec2(7, 3), ivec2(0, 0), ivec2(1, 1)))
CASE_EQUALS("last of a row", 0, "", ivec2(4095, 0), in_rows(4095, 12))
CASE_EQUALS("first of the next row", 0, "", ivec2(0, 1), in_rows(4096, 12))
CASE_EQUALS("the last leaf that 26 bits can name", 0, "", ivec2(4095, 16383), in_rows(67108863, 12))

// ---- ramp_place: entries as ramp.h has them

CASE_EQUALS("black", 0, "", 0, ramp_place(0u, ivec4(511, 255, 31, 31)).leaf)
CASE_EQUALS("one leaf: its last texel", 0, "", ivec4(7, 7, 1, 1),
            ramp_place(64u, ivec4(15, 7, 1, 3)).within)
CASE_EQUALS("one leaf: the first texel behind a border on all sides", 0, "", ivec4(0, 0, 0, 0),
            ramp_place(64u, ivec4(8, 16, 2, 30)).within)
CASE_EQUALS("halved along u alone: the left leaf", 0, "", 5,
            ramp_place(0x141u, ivec4(3, 7, 1, 1)).leaf)
CASE_EQUALS("halved along u alone: the right leaf", 0, "", 6,
            ramp_place(0x141u, ivec4(4, 7, 1, 1)).leaf)
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

// ---- low_half, high_half: two's complement

CASE_EQUALS("-1 below", 0, "", -1.0, low_half(0x0000ffffu))
CASE_EQUALS("-1 above", 0, "", -1.0, high_half(0xffff0000u))
CASE_EQUALS("most below: all bits above", 0, "", 32767.0, low_half(0xffff7fffu))
CASE_EQUALS("least above: all bits below", 0, "", -32768.0, high_half(0x8000ffffu))
CASE_EQUALS("least below", 0, "", -32768.0, low_half(0x00008000u))

// ---- ramp_light: the root is 255 or less, off by 3 u of that after the mix and by what the share is off,
// which is of numbers up to 40: 40 * 4 u; a square doubles it. Cases whose share is a whole number have the
// end's colour.

CASE_EQUALS("first colour", 6 * 0x1p-24, "linear", vec3(1.0, 0.0, 0.251964629),
            ramp_light(uvec4(0x8000ffu, 0x00ff00u, 0u, 0u), ivec4(7, 7, 1, 1)))
CASE_EQUALS("second colour: a level of 1", 6 * 0x1p-24, "linear", vec3(0.0, 1.0, 0.251964629),
            ramp_light(uvec4(0x0000ffu, 0x0480ff00u, 0u, 0u), ivec4(7, 7, 1, 1)))
CASE_EQUALS("cut off above", 6 * 0x1p-24, "linear", vec3(1.0),
            ramp_light(uvec4(0x000000u, 0x7fffffffu, 0x7fff7fffu, 0x7fff7fffu), ivec4(7, 7, 1, 1)))
CASE_EQUALS("cut off below: a level of -32", 0, "linear", vec3(0.0),
            ramp_light(uvec4(0x000000u, 0x80ffffffu, 0u, 0u), ivec4(0)))
CASE("a slope along each axis", 2 * 40 * 4 * 0x1p-24, "linear",
     ramp_light(uvec4(0x00102030u, 0x01ffe0d0u, 0x0123fed4u, 0xfc180345u), ivec4(3, 2, 1, 1)))
CASE("steep: what is left of two that all but cancel", 2 * 40 * 4 * 0x1p-24, "linear",
     ramp_light(uvec4(0x9a000000u, 0xe0ffffffu, 0x00004000u, 0x00001000u), ivec4(2, 0, 0, 0)))
CASE_EQUALS("half way is a quarter of the light", 2 * 40 * 4 * 0x1p-24, "linear", vec3(0.25),
            ramp_light(uvec4(0x00000000u, 0x02ffffffu, 0u, 0u), ivec4(1)))

// ---- vq_light: a code from one block's place, a texel from that code's patch

CASE_NUMBERS(codes, 6, 4, uvec4(uint(6 * y + x + 120), 0u, 0u, 0u))
CASE_TEXTURE(book, 512, 8, vec4(float(x) / 512.0, float(y) / 8.0, 0.5, 1.0))

CASE_EQUALS("first of a patch", 0, "linear", vec3(0.9375, 0.0, 0.5), vq_light(codes, book, ivec4(0, 0, 0, 0), ivec2(3, 2)))
CASE_EQUALS("last of a patch", 0, "linear", vec3(0.943359375, 0.375, 0.5),
            vq_light(codes, book, ivec4(3, 3, 0, 0), ivec2(3, 2)))
CASE_EQUALS("the next row of patches", 0, "linear", vec3(0.009765625, 0.625, 0.5),
            vq_light(codes, book, ivec4(5, 1, 0, 1), ivec2(3, 2)))

// ---- ramp_texel, ramp_four: 8 x 8 x 2 x 2 texels are a block; in entry n of the table (`blocks`) the four are leaves 4n, 4n + 1, ...

CASE_NUMBERS(blocks, 6, 4, uvec4(uint(4 * (6 * y + x)) << 6u, uint(4 * (6 * y + x) + 1) << 6u,
                                uint(4 * (6 * y + x) + 2) << 6u, uint(4 * (6 * y + x) + 3) << 6u))
CASE_NUMBERS(leaves, 128, 1, uvec4(uint(x), uint(x), 0u, 0u))

CASE_EQUALS("a texel of leaf 101", 4 * 0x1p-24, "linear", vec3(0.156878125, 0.0, 0.0),
            ramp_texel(leaves, 0x1940u, ivec4(7, 7, 1, 1)))
CASE_EQUALS("four of one block: the last", 4 * 0x1p-24, "linear", vec3(0.012056901, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 2, 2), vec2(1.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: the first", 4 * 0x1p-24, "linear", vec3(0.012056901, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(0.0, 0.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: next along s", 4 * 0x1p-24, "linear", vec3(0.012933487, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(1.0, 0.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: next along t", 4 * 0x1p-24, "linear", vec3(0.013840830, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(0.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("four of four blocks: next along both", 4 * 0x1p-24, "linear", vec3(0.014778931, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 3), vec2(1.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("two blocks along s: next along t is the same", 4 * 0x1p-24, "linear", vec3(0.012056901, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 3, 2), vec2(0.0, 1.0), ivec2(3, 2)))
CASE_EQUALS("two blocks along t: next along both is next along t", 4 * 0x1p-24, "linear", vec3(0.013840830, 0.0, 0.0),
            ramp_four(blocks, leaves, ivec4(7, 7, 2, 3), vec2(1.0, 1.0), ivec2(3, 2)))
