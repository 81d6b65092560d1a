// The hard cases of ray.glsl and the searches; tests/cases_glm.cpp says how this is written.
//
// One operation rounds by u = 2^-24 of its result; 0.125 is exact. Reading a bilinear height is off by
// 3 u |uv size| D + 8 u (a place rounded three times, D the largest difference of neighbours, eight
// operations).

CASE_TEXTURE(one, 1, 1, 0.75)
CASE_TEXTURE(flat_0, 4, 4, 0.0)
CASE_TEXTURE(flat_1, 4, 4, 1.0)
CASE_TEXTURE(peak, 8, 8, x == 3 && y == 3 ? 1.0 : 0.0)
CASE_TEXTURE(edge, 8, 4, x < 4 ? 0.0 : 1.0)
CASE_TEXTURE(slope, 16, 1, 0.0625 * float(x < 8 ? x : 16 - x)) // 1/16 a texel
CASE_TEXTURE(saddle, 2, 2, x == y ? 1.0 : 0.0) // along a diagonal quadratic, along an axis not
CASE_TEXTURE(odd, 7, 5, float((x * 3 + y * 5) % 7) / 8.0)
CASE_TEXTURE(thin, 1, 9, float(y % 3) / 4.0)
CASE_TEXTURE(bits, 16, 16, float((x * 7 + y * 3) % 16 + 100) / 255.0) // neighbours a few 8-bit steps apart

// ---- clearance: the place rounds by 2 u (|top| + |t across|) repeats, so with the read's own error
// e = (5 (|top| + |t across|) size D + 10) u

CASE("a 1x1 map", 10 * 0x1p-24, "heights", clearance(one, HeightRay(vec2(0.3, 0.7), vec2(-1.5, 2.5)), 0.3))
CASE_EQUALS("flat 0 at the bottom", 0, "heights", 0.0,
            clearance(flat_0, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.0)), 1.0))
CASE_EQUALS("flat 0 at the top", 0, "heights", 1.0,
            clearance(flat_0, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.0)), 0.0))
CASE_EQUALS("flat 1 at the top", 8 * 0x1p-24, "heights", 0.0,
            clearance(flat_1, HeightRay(vec2(0.3, 0.7), vec2(0.5, 0.0)), 0.0))
CASE_EQUALS("flat 1 at the bottom", 8 * 0x1p-24, "heights", -1.0,
            clearance(flat_1, HeightRay(vec2(0.3, 0.7), vec2(0.5, 0.0)), 1.0))
CASE_EQUALS("on a peak of one texel", 0, "heights", -0.5,
            clearance(peak, HeightRay(vec2(0.4375, 0.4375), vec2(0.0, 0.0)), 0.5))
CASE_EQUALS("a texel beside it", 0, "heights", 0.5,
            clearance(peak, HeightRay(vec2(0.5625, 0.4375), vec2(0.0, 0.0)), 0.5))
CASE_EQUALS("halfway between them", 0, "heights", 0.0,
            clearance(peak, HeightRay(vec2(0.5, 0.4375), vec2(0.0, 0.0)), 0.5))
CASE_EQUALS("across the border", 0, "heights", 0.0,
            clearance(edge, HeightRay(vec2(1.0, 0.5), vec2(0.0, 0.0)), 0.5))
CASE_EQUALS("three repeats away", 0, "heights", 0.0,
            clearance(edge, HeightRay(vec2(-2.0, 3.5), vec2(0.0, 0.0)), 0.5))
CASE("neither square nor a power of two", (5 * 2.2 * 7 + 10) * 0x1p-24, "heights",
     clearance(odd, HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 0.6))
CASE("one texel wide", (5 * 2.2 * 9 + 10) * 0x1p-24, "heights",
     clearance(thin, HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 0.6))
CASE("8 bits seen close", (5 * 0.7 * 16 * 16 / 255.0 + 10) * 0x1p-24, "heights",
     clearance(bits, HeightRay(vec2(0.3, 0.7), vec2(0.001, 0.002)), 0.5))
CASE("grazing: 19 repeats across", (5 * 10.3 * 8 + 10) * 0x1p-24, "heights",
     clearance(edge, HeightRay(vec2(0.3, 0.7), vec2(-19.08, 0.0)), 0.5))
CASE_FLIP("the largest tangents: no bit of the texel is left", 1, "heights",
          clearance(edge, HeightRay(vec2(0.3, 0.7), vec2(1e6, -1e6)), 0.7))

// ---- parallax: one read, e

CASE_EQUALS("flat 0", 0, "", 1.0, parallax(flat_0, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.0)), 1.0))
CASE_EQUALS("flat 1", 8 * 0x1p-24, "", 0.0, parallax(flat_1, HeightRay(vec2(0.3, 0.7), vec2(0.5, 0.0)), 1.0))
CASE_EQUALS("base 0 reads at the bottom", 0, "", 0.5,
            parallax(edge, HeightRay(vec2(0.25, 0.5), vec2(0.25, 0.0)), 0.0))
CASE("base 0.3", (5 * 1.5 * 7 + 10) * 0x1p-24, "",
     parallax(odd, HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 0.3))

// ---- linear_search: t is i / steps, rounded once, u / 2; exact where steps is a power of two. Which i, is a
// comparison: where the ray touches the surface at a step, rounding may choose the next

CASE_EQUALS("flat 1: met at the top", 0, "", 0.0,
            linear_search(edge, HeightRay(vec2(0.75, 0.5), vec2(0.0, 0.0)), 32).below)
CASE_EQUALS("flat 0: met at the bottom", 0, "", 1.0,
            linear_search(flat_0, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4)), 32).below)
CASE_EQUALS("flat 0: above until the last step", 0, "", 0.96875,
            linear_search(flat_0, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4)), 32).above)
CASE_EQUALS("one step", 0, "", 1.0, linear_search(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 1).below)
CASE("the clearance above", (5 * 0.8 * 16 / 16.0 + 10) * 0x1p-24, "heights",
     linear_search(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 32).over)
CASE("the clearance below", (5 * 0.8 * 16 / 16.0 + 10) * 0x1p-24, "heights",
     linear_search(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 32).under)
CASE("thirty steps", 0x1p-24, "", linear_search(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 30).below)
// A peak two texels wide below a ray of 16 steps, each 4 texels long: not seen, though it stands in the way
CASE_EQUALS("a peak between two steps", 0, "", 1.0,
            linear_search(peak, HeightRay(vec2(0.1875, 0.4375), vec2(8.0, 0.0)), 16).below)
CASE_EQUALS("a peak on a step", 0, "", 0.0625,
            linear_search(peak, HeightRay(vec2(-0.0625, 0.4375), vec2(8.0, 0.0)), 16).below)
CASE_EQUALS("along a cell's edge", 0, "", 0.5,
            linear_search(saddle, HeightRay(vec2(0.5, 0.25), vec2(0.0, 0.0)), 16).below)
CASE_FLIP("touching at a step", 1 / 10.0, "",
          linear_search(one, HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 20).below)

// ---- steep: the same t

CASE_EQUALS("flat 0", 0, "", 1.0, steep(flat_0, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4)), 32))
CASE_EQUALS("a 1x1 map", 0, "", 0.25, steep(one, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.0)), 32))
CASE("a slope", 0, "", steep(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 32))
CASE("grazing", 0, "", steep(edge, HeightRay(vec2(0.3, 0.7), vec2(-19.08, 0.0)), 32))

// ---- occlusion: between above and below, s apart, at over / (over - under), off by 2 e / (over - under) + 4
// u; then 3 u

CASE_EQUALS("flat 0: the last step ends on it", 0, "", 1.0,
            occlusion(flat_0, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.0)), 32))
CASE_EQUALS("flat 1: nothing to divide by", 0, "", 0.0,
            occlusion(edge, HeightRay(vec2(0.75, 0.5), vec2(0.0, 0.0)), 32))
CASE_EQUALS("a plane is found exactly", 24 * 0x1p-24, "", 0.25,
            occlusion(one, HeightRay(vec2(0.3, 0.7), vec2(0.5, 0.0)), 3))
// The slope falls from its top at u = 17/32 as h = 33/32 - u: 1 - t = 33/32 - 0.3 - 0.5 t, so t = 2 (0.3 -
// 1/32)
CASE_EQUALS("a slope is found exactly", (2 * (5 * 0.8 + 10) / 0.5 + 7) * 0x1p-24, "", 0.5375,
            occlusion(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 32))
CASE("8 bits seen close", (2 * (5 * 0.7 * 16 * 16 / 255.0 + 10) + 7) * 0x1p-24, "",
     occlusion(bits, HeightRay(vec2(0.3, 0.7), vec2(0.001, 0.002)), 32))
CASE("a diagonal through corners", (2 * (5 * 1.0 * 2 + 10) + 7) * 0x1p-24, "",
     occlusion(saddle, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.5)), 32))
CASE("neither square nor a power of two", (2 * (5 * 1.7 * 7 + 10) + 7) * 0x1p-24, "",
     occlusion(odd, HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 32))
// The wall of the edge is 1 texel, the ray's step 8 * 19 / 32 = 5: the clearance changes by up to 1 within s
// = 1/32
CASE("grazing", (1 / 32.0 * 2 * (5 * 19 * 8 + 10) + 7) * 0x1p-24 * 4, "",
     occlusion(edge, HeightRay(vec2(0.3, 0.7), vec2(-19.08, 0.0)), 32))

// ---- relief: halvings of a bracket whose ends are powers of two lose nothing, so without a flip the error
// is 0; with one it is the width of the last, 2^-b / steps

CASE_EQUALS("flat 0", 0, "", 1.0, relief(flat_0, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4)), 32, 6))
CASE_EQUALS("flat 1: met at the top", 0, "", 0.0,
            relief(edge, HeightRay(vec2(0.75, 0.5), vec2(0.0, 0.0)), 32, 6))
CASE_EQUALS("a plane on a power of two", 0, "", 0.25,
            relief(one, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.0)), 2, 6))
CASE_EQUALS("no halvings: steep", 0, "", 0.5625,
            relief(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 32, 0))
CASE_EQUALS("a slope", 1 / 2048.0, "", 0.5375,
            relief(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 32, 6))
CASE("a diagonal through corners", 0, "", relief(saddle, HeightRay(vec2(0.25, 0.75), vec2(0.5, 0.5)), 32, 6))
CASE("8 bits seen close", 0, "", relief(bits, HeightRay(vec2(0.3, 0.7), vec2(0.001, 0.002)), 32, 6))
CASE("neither square nor a power of two", 0, "",
     relief(odd, HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 32, 6))
CASE("one texel wide", 0, "", relief(thin, HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 32, 6))
CASE("grazing", 0, "", relief(edge, HeightRay(vec2(0.3, 0.7), vec2(-19.08, 0.0)), 32, 6))
// The wall from -1/16 to 1/16 hides the ray at step 1, though step 0 is above and the wall's far side is free
// again: halving stays in the bracket that the steps gave, and finds what is in it
CASE_EQUALS("a step that jumped is not repaired", 0, "", 1.0,
            relief(peak, HeightRay(vec2(0.1875, 0.4375), vec2(8.0, 0.0)), 16, 6))
CASE_FLIP("many halvings: rounding decides the last", 0x1p-22, "",
          relief(slope, HeightRay(vec2(0.3, 0.5), vec2(0.5, 0.0)), 32, 20))

// ---- patch_normal: texels are exact, the place within the cell is off by 2 u |uv size|, so a slope s =
// scale size D by s (2 |uv size| + 6) u, and normalizing adds 4 u. On a texel's centre rounding chooses the
// cell: the normal may jump

CASE_EQUALS("flat", 0, "", vec3(0.0, 0.0, 1.0), patch_normal(flat_1, vec2(0.3, 0.7), 0.1, 1.0))
CASE_EQUALS("a 1x1 map", 0, "", vec3(0.0, 0.0, 1.0), patch_normal(one, vec2(0.3, 0.7), 0.1, 1.0))
// The edge rises by 1 in 1/8 width: slope 8 * 0.125 = 1
CASE_EQUALS("an edge of 45 degrees", 4 * 0x1p-24, "", vec3(-0.70710678118654752, 0.0, 0.70710678118654752),
            patch_normal(edge, vec2(0.5, 0.375), 0.125, 1.0))
CASE_EQUALS("falling across the border", 4 * 0x1p-24, "", vec3(0.70710678118654752, 0.0, 0.70710678118654752),
            patch_normal(edge, vec2(1.0, 0.375), 0.125, 1.0))
CASE_EQUALS("a repeat below", 4 * 0x1p-24, "", vec3(0.70710678118654752, 0.0, 0.70710678118654752),
            patch_normal(edge, vec2(-1.0, -0.625), 0.125, 1.0))
// 1/4 a texel, 9 texels, the texture 9/32 as high as wide: slope 1/8 * 9/4 * 32/9 = 1
CASE_EQUALS("along v in a wide texture", 4 * 0x1p-24, "",
            vec3(0.0, -0.70710678118654752, 0.70710678118654752),
            patch_normal(thin, vec2(0.5, 0.1), 0.125, 0.28125))
CASE_EQUALS("a saddle's middle is flat", 0, "", vec3(0.0, 0.0, 1.0),
            patch_normal(saddle, vec2(0.5, 0.5), 0.1, 1.0))
CASE("neither square nor a power of two", (0.1 * 7 * (2 * 7 + 6) + 4) * 0x1p-24, "",
     patch_normal(odd, vec2(0.3, 0.7), 0.1, 1.0))
CASE("8 bits seen close", (0.1 * 16 * 16 / 255.0 * (2 * 16 + 6) + 4) * 0x1p-24, "",
     patch_normal(bits, vec2(0.3, 0.7), 0.1, 1.0))
CASE_FLIP("on a texel's centre", 2, "", patch_normal(edge, vec2(0.4375, 0.375), 0.1, 1.0))
