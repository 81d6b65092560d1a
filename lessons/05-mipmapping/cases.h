// The hard cases of mipmap.glsl and summed-area.glsl; tests/cases_glm.cpp says how this is written.
//
// What is singular has a result all the same: a pixel on the horizon or above it is no hit, and the rest is
// 0; an infinite footprint reads the last level, or (area, summed_area) is cut to 65536 repeats.
//
// One operation rounds by u = 2^-24 of its result. Most bounds are made of three terms:
// - a place uv * size is rounded about three times (the literal, the product, a sum), so it is off by
//   3 u |uv size|, and what is read there by that times D, the largest difference of two neighbours;
// - a bilinear read of texels up to T multiplies and adds seven times, 8 u T; n n taps add n n u T;
// - the summed-area table: see below.

CASE_TEXTURE(one, 1, 1, 0.75)
CASE_TEXTURE(none, 1, 1, 0.0)
CASE_TEXTURE_MIPPED(line, 1, 7, 0.125 * float(1 + y) + float(level))        // T = 3, D = 1
CASE_TEXTURE_MIPPED(odd, 3, 5, 0.125 * float(1 + x + 3 * y) + float(level)) // T = 4, D = 2
CASE_TEXTURE_MIPPED(bright, 513, 257,
                    level == 2             ? 0.0    // a black level, and HDR:
                    : (x + 2 * y) % 5 == 0 ? 1000.0 // T = D = 1000
                                           : 0.03125 * float(x % 32))

// ---- footprint
//
// The floor `steep` has w = 2.4 - 0.01 y and its horizon at y = 240. The terms of w are below 2.4 and round
// four times in all, by 2.4 u; a pixel is worth 0.01. So the picture is off by 960 u pixels (and 40 u for the
// rest), however far the floor is, and derivatives, with w^2 below them, by 2 * 9.6 u / w of themselves.

CASE_GLSL(mat3 down() { return mat3(0.125, 0, 0, 0, 0.125, 0, 1, 2, 1); })
CASE_GLSL(mat3 steep() { return mat3(0.1, 0, 0, 0.03, 0, -0.01, -16, 50, 2.4); })
CASE_GLSL(mat3 exact() { return mat3(0.125, 0, 0, 0, 0.125, -1, 0, 0, 240); })

CASE("straight down", 0, "repeats", footprint(down(), vec2(3.5, 4.5)).uv)
CASE("straight down dx", 0, "repeats", footprint(down(), vec2(3.5, 4.5)).dx)
CASE("straight down dy", 0, "repeats", footprint(down(), vec2(3.5, 4.5)).dy)
CASE("half a pixel below the horizon", 1000 * 0x1p-24, "pixels",
     footprint(steep(), vec2(400.5, 239.5)).uv / vec2(12500.0, 20000.0))
CASE("half a pixel below the horizon dy", 4000 * 0x1p-24, "",
     footprint(steep(), vec2(400.5, 239.5)).dy / vec2(12500.0, 20000.0))
CASE("half a pixel below the horizon dx", 4000 * 0x1p-24, "",
     footprint(steep(), vec2(400.5, 239.5)).dx / 20.0)
CASE("far below the horizon", 1000 * 0x1p-24, "pixels",
     footprint(steep(), vec2(400.5, 0.5)).uv / vec2(0.075, 0.087))
CASE("on the horizon", 0, "", footprint(exact(), vec2(100.0, 240.0)).hit)
CASE("on the horizon uv", 0, "repeats", footprint(exact(), vec2(100.0, 240.0)).uv)
CASE("on the horizon dy", 0, "repeats", footprint(exact(), vec2(100.0, 240.0)).dy)
CASE("above the horizon", 0, "", footprint(exact(), vec2(100.0, 300.5)).hit)
CASE_FLIP("a thousandth of a pixel below the horizon", 1, "", footprint(exact(), vec2(100.0, 239.999)).hit)
CASE("nothing there", 0, "", footprint(mat3(0.0), vec2(3.5, 4.5)).hit)

// ---- nearest: exact, but on a border between two texels

CASE("1x1", 0, "", nearest(one, vec2(0.3, -7.6)).x)
CASE("1x7 left of the seam", 0, "", nearest(line, vec2(-0.01, -0.01)).x)
CASE("3x5 just left of the seam where fract is 1", 0, "", nearest(odd, vec2(-1e-9, 0.5)).x)
CASE("513x257 HDR", 0, "", nearest(bright, vec2(0.3, 0.7)).x)
CASE_FLIP("on a texel's border", 0.125, "", nearest(odd, vec2(0.1 / 0.3, 0.5)).x)

// ---- bilinear: 3 u (|u| width + |v| height) D + 8 u T

CASE("1x1", 8 * 0.75 * 0x1p-24, "", bilinear(one, vec2(0.3, -7.6)).x)
CASE("1x7 across the seam", (3 * 0.1 * 7 * 1 + 8) * 0x1p-24, "", bilinear(line, vec2(0.4, -0.02)).x)
CASE("3x5 across both seams", (3 * (0.02 * 3 + 1.01 * 5) * 2 + 8 * 2) * 0x1p-24, "",
     bilinear(odd, vec2(-0.02, 1.01)).x)
CASE("513x257 HDR", (3 * (0.3 * 513 + 0.7 * 257) * 1000 + 8000) * 0x1p-24, "",
     bilinear(bright, vec2(0.3, 0.7)).x)
CASE("3x5 a thousand repeats away", (3 * (1000.3 * 3 + 0.7 * 5) * 2 + 16) * 0x1p-24, "",
     bilinear(odd, vec2(1000.3, 0.7)).x)

// ---- levels

CASE("1x1", 0, "level", last_level(one))
CASE("1x7", 0, "level", last_level(line))
CASE("3x5", 0, "level", last_level(odd))
CASE("513x257", 0, "level", last_level(bright))

// log2 of OpenGL is not a correctly rounded one: 2^-20 is empirical.
CASE("magnified", 0, "level", level_of_detail(vec2(0.2, 0.1), vec2(0.0, 0.3), 9.0))
CASE("no footprint", 0, "level", level_of_detail(vec2(0.0), vec2(0.0), 9.0))
CASE("one texel", 0x1p-20, "level", level_of_detail(vec2(1.0, 0.0), vec2(0.0, 1.0), 9.0))
CASE("eight texels", 0x1p-20, "level", level_of_detail(vec2(1.0, 0.0), vec2(0.0, 8.0), 9.0))
CASE("a slanted footprint", 0x1p-20, "level", level_of_detail(vec2(3.1, 2.2), vec2(-0.7, 10.3), 9.0))
CASE("the last level", 0x1p-20, "level", level_of_detail(vec2(512.0, 0.0), vec2(0.0, 1.0), 9.0))
CASE("a footprint larger than the texture", 0, "level",
     level_of_detail(vec2(1500.0, 0.0), vec2(0.0, 1.0), 9.0))
CASE("1x1", 0, "level", level_of_detail(vec2(3.0, 0.0), vec2(0.0, 3.0), 0.0))
CASE("horizon: the square overflows", 0, "level", level_of_detail(vec2(1e30, 0.0), vec2(0.0, 1e30), 9.0))
CASE("horizon: infinite", 0, "level", level_of_detail(vec2(1.0 / 0.0, 1.0), vec2(0.0, 1.0), 9.0))

// ---- a level, and two: as bilinear, with the size and texels of the level

CASE("1x1", 6 * 0x1p-24, "", mip_nearest(one, vec2(0.3, 0.3), 0.0).x)
CASE("a half goes to the finer level", 16 * 0x1p-24, "", mip_nearest(odd, vec2(0.5, 0.5), 0.5).x)
CASE("just over a half", 16 * 0x1p-24, "", mip_nearest(odd, vec2(0.5, 0.5), 0.500001).x)
CASE("a black level", 0, "", mip_nearest(bright, vec2(0.3, 0.7), 2.0).x)
CASE("beyond the last level", 8 * 4 * 0x1p-24, "", mip_nearest(odd, vec2(0.3, 0.7), 7.0).x)
CASE("1x7", (3 * 0.7 * 3 + 16) * 0x1p-24, "", mip_nearest(line, vec2(0.3, 0.7), 1.0).x)

CASE("1x1", 6 * 0x1p-24, "", trilinear(one, vec2(0.3, 0.3), 0.0).x)
CASE("3x5 in the middle of two levels", (3 * (0.3 * 3 + 0.7 * 5) * 2 + 8 * 3) * 0x1p-24, "",
     trilinear(odd, vec2(0.3, 0.7), 0.5).x)
CASE("1x7 to the last level", (3 * 0.7 * 3 + 8 * 3) * 0x1p-24, "", trilinear(line, vec2(0.3, 0.7), 1.75).x)
CASE("513x257 HDR to a black level", (3 * (0.3 * 256 + 0.7 * 128) * 1000 + 10000) * 0x1p-24, "",
     trilinear(bright, vec2(0.3, 0.7), 1.25).x)
CASE("a black level", 0, "", trilinear(bright, vec2(0.3, 0.7), 2.0).x)
CASE("the last level of HDR", 8 * 1000 * 0x1p-24, "", trilinear(bright, vec2(0.3, 0.7), 9.0).x)

// ---- area: 3 u ((|u| + |dx|) width + (|v| + |dy|) height) D + (8 + n n) u T

CASE("1x1", 24 * 0x1p-24, "", area(one, vec2(0.3, 0.3), vec2(0.5, 0.1), vec2(0.2, 0.9), 4).x)
CASE("one tap", (3 * (0.3 * 3 + 0.7 * 5) * 2 + 16) * 0x1p-24, "",
     area(odd, vec2(0.3, 0.7), vec2(0.5, 0.0), vec2(0.0, 0.5), 1).x)
CASE("1x7", (3 * 1.6 * 7 + 24) * 0x1p-24, "", area(line, vec2(0.3, 0.7), vec2(0.5, 0.0), vec2(0.0, 0.9), 4).x)
CASE("513x257 HDR", (3 * (0.4 * 513 + 0.8 * 257) * 1000 + 264000) * 0x1p-24, "",
     area(bright, vec2(0.3, 0.7), vec2(0.1, 0.02), vec2(-0.03, 0.1), 16).x)
CASE("a footprint larger than the texture", (3 * (3.1 * 3 + 2.2 * 5) * 2 + 72) * 0x1p-24, "",
     area(odd, vec2(0.3, 0.7), vec2(2.8, 0.0), vec2(0.0, 1.5), 8).x)
// Cut to 65536 repeats, a tap's place is known to a hundredth of a texel: 3 u 65537 (3 + 5) D. Which texels
// the nine taps meet is chance; that the result is finite and of the texture's range is what counts.
CASE("horizon: the footprint overflows", 3 * 65537.0 * 8 * 2 * 0x1p-24, "",
     area(odd, vec2(0.3, 0.7), vec2(1e30, 0.0), vec2(0.0, 1e30), 3).x)
CASE("horizon: the footprint is infinite", 3 * 65537.0 * 8 * 2 * 0x1p-24, "",
     area(odd, vec2(0.3, 0.7), vec2(1.0 / 0.0, 0.0), vec2(0.0, 1.0), 3).x)

// ---- Summed-area tables
//
// Rows and columns of these images rise and fall: texel (x, y) = p(x) p(y), with p = 0.3, 0.75, 0.3, ... or,
// for HDR, 0.125, 30, 0.125, ...; n of them sum to the functions below. `far` is what is left of 4096 x 4096
// texels beside one of 1e5: its first texel holds what all texels before it sum to, its texel (2, 2) is 1e5.
// The q of each table is chain.h's.

CASE_GLSL(float even(int n) { return 0.3 * float(n) + 0.45 * float(n / 2); })
CASE_GLSL(float hdr(int n) { return 0.125 * float(n) + 29.875 * float(n / 2); })
CASE_GLSL(float far_sum(int x, int y) {
    return 8388608.0 + (x >= 2 && y >= 2 ? 1e5 : 0.0) + even(x + 1) * even(y + 1);
})
CASE_GLSL(float coarse(float sum, float q) { return q * floor(sum / q + 0.5); })

CASE_TEXTURE(line_high, 1, 7, coarse(0.3 * even(y + 1), 0x1p-22))
CASE_TEXTURE(line_low, 1, 7, 0.3 * even(y + 1) - coarse(0.3 * even(y + 1), 0x1p-22))
CASE_TEXTURE(odd_high, 3, 5, coarse(even(x + 1) * even(y + 1), 0x1p-21))
CASE_TEXTURE(odd_low, 3, 5, even(x + 1) * even(y + 1) - coarse(even(x + 1) * even(y + 1), 0x1p-21))
CASE_TEXTURE(hdr_high, 513, 257, coarse(hdr(x + 1) * hdr(y + 1), 4.0))
CASE_TEXTURE(hdr_low, 513, 257, hdr(x + 1) * hdr(y + 1) - coarse(hdr(x + 1) * hdr(y + 1), 4.0))
CASE_TEXTURE(far_high, 8, 8, coarse(far_sum(x, y), 2.0))
CASE_TEXTURE(far_low, 8, 8, far_sum(x, y) - coarse(far_sum(x, y), 2.0))

// cover: `centre - width / 2`, reduced to the texture and again at the end: 5 u (|centre| + width).
CASE("a texel", 0, "texels", cover(2.5, 1.0, 8).edges)
CASE("a texel", 0, "texels", cover(2.5, 1.0, 8).weights)
CASE("across the end", 5 * 10.2 * 0x1p-24, "texels", cover(7.7, 2.5, 8).weights)
CASE("across the end", 0, "texels", cover(7.7, 2.5, 8).edges)
CASE("one texel of one", 5 * 1.4 * 0x1p-24, "texels", cover(0.4, 1.0, 1).weights)
CASE("many repeats", 5 * 42.4 * 0x1p-24, "texels", cover(-5.3, 37.1, 5).weights)
CASE("many repeats", 0, "texels", cover(-5.3, 37.1, 5).edges)

// What is subtracted of `high` is exact: no error is allowed at all.
CASE("no texels to the left", 0, "", corner(far_high, 0, 3).x)
CASE("no texels below", 0, "", corner(far_high, 3, 0).x)
CASE("all texels", 0, "", corner(far_high, 8, 8).x)
CASE("beside 1e5", 0, "", pieces(far_high, 4, ivec4(2, 3, 6, 7)).first.x)
CASE("beside 1e5 whole", 0, "", pieces(far_high, 4, ivec4(2, 3, 6, 7)).whole.x)
CASE("beside 1e5", 0, "",
     between(pieces(far_high, 3, ivec4(2, 3, 6, 7)), pieces(far_high, 4, ivec4(2, 3, 6, 7)),
             vec4(1.0, 1.0, 0.0, 0.0))
         .x)
CASE("beside 1e5", 0, "", box_sum(far_high, cover(3.5, 1.0, 8), cover(2.5, 1.0, 8)).x)

// summed_area. Of the box's sum, an edge off by 5 u (|centre| + width) adds that times T times the other
// side; each of `low`'s pieces is below 2 q, and so is what is left of `high`'s: at most nine of either
// (whole repeats aside, which are as many times larger as the box is), four roundings of each, two for
// weights, sixteen sums of at most 18 q: 2 (9 * 2 * 6 + 16 * 18) q < 800 q; and 10 u T for the texels
// themselves. Over an area of A:
//     10 u T ((|u| width + w) / w + (|v| height + h) / h + 1) + 800 q u / A
// Where edges are on texels' borders and u, v are powers of two apart, only one piece is not 0: 8 q u + u T.

CASE("1x1", 8 * 0x1p-24, "", summed_area(one, none, vec2(0.5, 0.5), vec2(0.5, 0.0), vec2(0.0, 0.5)).x)
CASE("1x1 off the middle", 40 * 0x1p-24, "",
     summed_area(one, none, vec2(0.3, -0.6), vec2(0.5, 0.0), vec2(0.0, 0.5)).x)
CASE("1x7", 10 * 0.6 * (2 + (0.4 * 7 + 2.1) / 2.1 + 1) * 0x1p-24, "",
     summed_area(line_high, line_low, vec2(0.5, 0.4), vec2(0.3, 0.0), vec2(0.0, 0.3)).x)
CASE("3x5 one texel wide", 10 * 0.6 * (0.6 * 3 + 1 + 0.9 * 5 + 1 + 1) * 0x1p-24, "",
     summed_area(odd_high, odd_low, vec2(0.6, 0.9), vec2(0.0), vec2(0.0)).x)
CASE("3x5 where the left edge rounds onto the right end", 10 * 0.6 * (0.5 + 1 + 0.5 + 1 + 1) * 0x1p-24, "",
     summed_area(odd_high, odd_low, vec2(0.16666666, 0.1), vec2(0.0), vec2(0.0)).x)
CASE("3x5 larger than the texture", 10 * 0.6 * (2 + 2 + 1) * 0x1p-24, "",
     summed_area(odd_high, odd_low, vec2(0.6, 0.9), vec2(2.3, 0.0), vec2(0.3, 4.9)).x)
CASE("513x257 HDR one texel wide", (10 * 900 * (0.3 * 513 + 0.7 * 257 + 3) + 3200) * 0x1p-24, "",
     summed_area(hdr_high, hdr_low, vec2(0.3, 0.7), vec2(0.0), vec2(0.0)).x)
CASE("513x257 HDR", 10 * 900 * ((0.3 * 513 + 24) / 24 + (0.7 * 257 + 31) / 31 + 2) * 0x1p-24, "",
     summed_area(hdr_high, hdr_low, vec2(0.3, 0.7), vec2(0.04, 0.02), vec2(-0.007, 0.1)).x)
CASE("513x257 HDR across both seams", 10 * 900 * ((513 + 24) / 24 + 257 / 31 + 2) * 0x1p-24, "",
     summed_area(hdr_high, hdr_low, vec2(-0.01, 1.0), vec2(0.04, 0.02), vec2(-0.007, 0.1)).x)
CASE("4096x4096 one texel wide", (8 * 2 + 1) * 0x1p-24, "",
     summed_area(far_high, far_low, vec2(0.6875, 0.5625), vec2(0.125, 0.0), vec2(0.0, 0.125)).x)
CASE("one texel wide beside 1e5", (8 * 2 + 1) * 0x1p-24, "",
     summed_area(far_high, far_low, vec2(0.4375, 0.3125), vec2(0.125, 0.0), vec2(0.0, 0.125)).x)
CASE("4096x4096 between texels", (10 * (5 + 1 + 5 + 1 + 1) + 1600) * 0x1p-24, "",
     summed_area(far_high, far_low, vec2(0.63, 0.6), vec2(0.0), vec2(0.0)).x)
CASE("half on 1e5", (10 * 1e5 * (3 + 1 + 2.5 + 1 + 1) + 1600) * 0x1p-24, "",
     summed_area(far_high, far_low, vec2(0.37, 0.3), vec2(0.0), vec2(0.0)).x)
CASE("horizon: the footprint overflows", 10 * 900 * 5 * 0x1p-24, "",
     summed_area(hdr_high, hdr_low, vec2(0.3, 0.7), vec2(1e30, 0.0), vec2(0.0, 1e30)).x)
CASE("horizon: the footprint is infinite", 10 * 900 * 5 * 0x1p-24, "",
     summed_area(hdr_high, hdr_low, vec2(0.3, 0.7), vec2(1.0 / 0.0, 0.0), vec2(0.0, 1.0 / 0.0)).x)
