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

// ---- height_ray: scale tangents, with literals, 9 u |across|; top adds one product and a sum; ray_uv: two more

CASE_EQUALS("60 degrees along u: down is away from the eye", 9 * 0.22 * 0x1p-24, "repeats",
            vec2(-0.21650635094610966, 0.0),
            height_ray(vec2(0.5, 0.5), vec3(0.86602540378443865, 0.0, 0.5), 0.125, 1.0, 1.0).across)
CASE_EQUALS("base 1: the polygon is the top", 0, "repeats", vec2(0.25, 0.75),
            height_ray(vec2(0.25, 0.75), vec3(0.6, 0.0, 0.8), 0.125, 1.0, 1.0).top)
CASE_EQUALS("base 0: the polygon is the bottom", 0, "repeats", vec2(0.375, 0.75),
            height_ray(vec2(0.25, 0.75), vec3(0.5, 0.0, 0.5), 0.125, 0.0, 1.0).top)
CASE_EQUALS("a wide texture", 0, "repeats", vec2(-0.125, -0.25),
            height_ray(vec2(0.25, 0.75), vec3(0.5, 0.5, 0.5), 0.125, 1.0, 0.5).across)
CASE_EQUALS("a view in the plane looks straight down", 0, "repeats", vec2(0.0, 0.0),
            height_ray(vec2(0.25, 0.75), vec3(0.6, 0.8, 0.0), 0.125, 0.5, 1.0).across)
CASE_EQUALS("and one from behind", 0, "repeats", vec2(0.25, 0.75),
            height_ray(vec2(0.25, 0.75), vec3(0.6, 0.0, -0.8), 0.125, 0.5, 1.0).top)
CASE("grazing", 9 * 200 * 0x1p-24, "repeats",
     height_ray(vec2(0.3, 0.7), vec3(0.6, -0.8, 0.0005), 0.125, 0.3, 1.0).across)
CASE_EQUALS("halfway down", 0, "repeats", vec2(0.5, 0.5),
            ray_uv(HeightRay(vec2(0.25, 0.75), vec2(0.5, -0.5)), 0.5))
CASE("somewhere", (2 * 0.9 + 2 * 0.7) * 0x1p-24, "repeats", ray_uv(HeightRay(vec2(0.3, 0.7), vec2(-0.9, 0.4)), 0.3))

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

// ---- The cells' searches: the maps that pyramid.h and cone.h describe, of peak, edge and slope

CASE_TEXTURE(peak_corners, 8, 8, vec4(x == 3 && y == 3, x == 2 && y == 3, x == 3 && y == 2, x == 2 && y == 2))
CASE_TEXTURE_MIPPED(peak_pyramid, 8, 8,
                    x <= 3 >> level && y <= 3 >> level && x >= 2 >> level && y >= 2 >> level ? 1.0 : 0.0)
CASE_TEXTURE(peak_cones, 8, 8, 1.5)
CASE_TEXTURE(edge_corners, 8, 4, vec4(x > 3, x > 2 && x < 7, x > 3, x > 2 && x < 7))
CASE_TEXTURE_MIPPED(edge_pyramid, 8, 4, x >= 3 >> level ? 1.0 : 0.0)
CASE_TEXTURE(edge_cones, 8, 4, 1.0)
CASE_TEXTURE(slope_corners, 16, 1,
             0.0625 * vec4(x < 8 ? x : 16 - x, x < 8 ? x + 1 : 15 - x, x < 8 ? x : 16 - x, x < 8 ? x + 1 : 15 - x))
CASE_TEXTURE_MIPPED(slope_pyramid, 16, 1,
                    0.0625 * float((x + 1) << level <= 8 ? (x + 1) << level : x << level < 8 ? 8 : 16 - (x << level)))
CASE_TEXTURE(slope_cones, 16, 1, 0.0625)
CASE_TEXTURE(flat_0_corners, 4, 4, vec4(0.0))
CASE_TEXTURE_MIPPED(flat_0_pyramid, 4, 4, 0.0)
CASE_TEXTURE(flat_1_corners, 4, 4, vec4(1.0))
CASE_TEXTURE_MIPPED(flat_1_pyramid, 4, 4, 1.0)
CASE_TEXTURE(no_cones, 4, 4, 0.0)
CASE_TEXTURE(one_corners, 1, 1, vec4(0.75))
CASE_TEXTURE_MIPPED(one_pyramid, 1, 1, 0.75)
CASE_TEXTURE(one_cones, 1, 1, 0.0)

// ---- cell_ray: size top - 0.5 rounds by u (2 |size top| + 1), as literals do; size across by 2 u |size across|;
// cell_at: floor, so a place less than that error from a border may fall on either side of it

CASE("the start", (2 * 5 + 1) * 0x1p-24, "cells",
     cell_ray(edge_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4))).start)
CASE("the way", 2 * 7.2 * 0x1p-24, "cells", cell_ray(edge_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4))).way)
CASE_EQUALS("the far sides", 0, "", vec2(1.0, 0.0),
            cell_ray(edge_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, -0.4))).far)
CASE_EQUALS("straight down it never leaves", 2e14, "", vec2(1e20, 1e20),
            cell_ray(edge_corners, HeightRay(vec2(0.3, 0.7), vec2(0.0, 0.0))).t_per_cell)
CASE_EQUALS("in the middle", 0, "cells", vec2(2.0, 1.0),
            cell_at(cell_ray(edge_corners, HeightRay(vec2(0.375, 0.5), vec2(0.5, 0.0))), 0.0))
CASE_EQUALS("on a border: the cell it comes to", 0, "cells", vec2(3.0, 1.0),
            cell_at(cell_ray(edge_corners, HeightRay(vec2(0.0625, 0.5), vec2(0.5, 0.0))), 0.75))
CASE_EQUALS("on a border backward", 0, "cells", vec2(2.0, 1.0),
            cell_at(cell_ray(edge_corners, HeightRay(vec2(0.8125, 0.5), vec2(-0.5, 0.0))), 0.75))
CASE_EQUALS("before the first texel's centre", 0, "cells", vec2(-1.0, -1.0),
            cell_at(cell_ray(edge_corners, HeightRay(vec2(0.03125, 0.0625), vec2(0.0, 0.0))), 0.0))
CASE_EQUALS("no turn", 0, "cells", vec2(0.0, 0.0),
            cell_turns(cell_ray(edge_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4))), vec2(7.0, 0.0)))
CASE_EQUALS("one on and one back", 0, "cells", vec2(8.0, -4.0),
            cell_turns(cell_ray(edge_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4))), vec2(8.0, -1.0)))
CASE_EQUALS("ten thousand turns of three texels", 0, "cells", vec2(30000.0, -30000.0),
            cell_turns(CellRay(vec2(3.0), vec2(0.0), vec2(1.0), vec2(0.0), vec2(1.0), vec2(1.0)),
                  vec2(30002.0, -30000.0)))

// ---- leaving_time: a sum of places off by u (2 |start| + 1), over |way|, rounded twice more: here 8 u

CASE_EQUALS("through the side", 8 * 0x1p-24, "", 0.25,
            leaving_time(cell_ray(edge_corners, HeightRay(vec2(0.0625, 0.375), vec2(0.5, 0.0))), vec2(0.0, 1.0),
                  vec2(1.0)))
CASE_EQUALS("backward through the top of a block", 8 * 0x1p-24, "", 0.375,
            leaving_time(cell_ray(edge_corners, HeightRay(vec2(0.3125, 0.5), vec2(-0.25, 1.0))), vec2(0.0, 1.0),
                  vec2(2.0)))
CASE("grazing", 8 * 0x1p-24, "",
     leaving_time(cell_ray(edge_corners, HeightRay(vec2(0.3, 0.7), vec2(-19.08, 3.1))), vec2(-6.0, 2.0), vec2(1.0)))

// ---- patch_terms: two sums; patch_clearance: the place is off by 4 u (|start| + |way|) and ten operations add 10 u

CASE_EQUALS("a saddle", 0, "heights", vec4(0.25, 0.5, 0.25, -0.75), patch_terms(vec4(0.25, 0.75, 0.5, 0.25)))
CASE("heights of no exact kind", 4 * 0x1p-24, "heights", patch_terms(vec4(0.3, 0.7, 0.1, 0.9)))
CASE_EQUALS("in a saddle's middle", 0, "heights", 0.0625,
            patch_clearance(cell_ray(peak_corners, HeightRay(vec2(0.375, 0.375), vec2(0.0, 0.0))), vec2(2.0, 2.0),
                            patch_terms(vec4(0.25, 0.75, 0.5, 0.25)), 0.5))
CASE("anywhere", (4 * 10 + 10) * 0x1p-24, "heights",
     patch_clearance(cell_ray(peak_corners, HeightRay(vec2(0.3, 0.4), vec2(0.9, 0.4))), vec2(2.0, 2.0),
                     patch_terms(vec4(0.3, 0.7, 0.1, 0.9)), 0.1))

// ---- falling_root: eight operations, none of which cancels, 8 u s

CASE_EQUALS("straight: no quadratic term", 0, "", 2.0, falling_root(1.0, -0.5, 0.0))
CASE_EQUALS("the first of two", 0, "", 1.0, falling_root(2.0, -3.0, 1.0))
CASE_EQUALS("rising first", 0, "", 2.0, falling_root(2.0, 1.0, -1.0))
CASE_EQUALS("on the surface and falling", 0, "", 0.0, falling_root(0.0, -1.0, 1.0))
CASE_EQUALS("on the surface and rising", 0, "", 1.0, falling_root(0.0, 1.0, -1.0))
CASE_EQUALS("touching", 0, "", 1.0, falling_root(1.0, -2.0, 1.0))
CASE_EQUALS("neither falling nor rising", 0, "", 0.5, falling_root(0.25, 0.0, -1.0))
CASE("hardly bent", 8 * 0x1p-24, "", falling_root(1.0, -1.0, 0.000000001))
CASE("hardly above and rising", 8 * 0x1p-24, "", falling_root(0.000001, 1.0, -1.0))
CASE("far away", 8 * 1e6 * 0x1p-24, "", falling_root(1.0, -0.000001, 0.000000000000001))

// ---- patch_hit: the place is off by 4 u (|start| + |way|) cells, here 8 cells on a slope of 1 a cell; ten operations
// on heights add 10 u: 42 u, over a closing speed of at least 1

CASE_EQUALS("a ray along an axis: no quadratic term", 42 * 0x1p-24, "", 0.375,
            patch_hit(cell_ray(peak_corners, HeightRay(vec2(0.0625, 0.4375), vec2(0.875, 0.0))), vec2(2.0, 2.0),
                      patch_terms(vec4(0.0, 0.0, 0.0, 1.0)), 0.28571429, 0.42857143))
CASE_EQUALS("along the diagonal", 42 * 0x1p-24, "", 0.39667696,
            patch_hit(cell_ray(peak_corners, HeightRay(vec2(0.0625, 0.0625), vec2(0.875, 0.875))), vec2(2.0, 2.0),
                      patch_terms(vec4(0.0, 0.0, 0.0, 1.0)), 0.28571429, 0.42857143))
CASE_EQUALS("below from the start", 0, "", 0.75,
            patch_hit(cell_ray(peak_corners, HeightRay(vec2(0.4375, 0.4375), vec2(0.0, 0.0))), vec2(3.0, 3.0),
                      patch_terms(vec4(1.0, 0.0, 0.0, 0.0)), 0.75, 1.0))
CASE_EQUALS("over it", 0, "", -1.0,
            patch_hit(cell_ray(peak_corners, HeightRay(vec2(0.0625, 0.0625), vec2(0.875, 0.875))), vec2(2.0, 2.0),
                      patch_terms(vec4(0.0, 0.0, 0.0, 0.5)), 0.28571429, 0.42857143))

// ---- maximum and cone: as patch_hit, 42 u. What the ray meets is known by hand; rows and columns through texel
// centres are the borders of cells

CASE_EQUALS("along an edge onto a peak", 42 * 0x1p-24, "", 0.375,
            maximum(peak_pyramid, peak_corners, HeightRay(vec2(0.0625, 0.4375), vec2(0.875, 0.0))))
CASE_EQUALS("and backward", 42 * 0x1p-24, "", 0.5,
            maximum(peak_pyramid, peak_corners, HeightRay(vec2(0.9375, 0.4375), vec2(-0.875, 0.0))))
CASE_EQUALS("through corners onto a peak", 42 * 0x1p-24, "", 0.39667696007181547,
            maximum(peak_pyramid, peak_corners, HeightRay(vec2(0.0625, 0.0625), vec2(0.875, 0.875))))
CASE_EQUALS("repeats away", 42 * 4 * 0x1p-24, "", 0.39667696007181547,
            maximum(peak_pyramid, peak_corners, HeightRay(vec2(-2.9375, 3.0625), vec2(0.875, 0.875))))
CASE_EQUALS("beside a peak: two texels off it lies flat", 42 * 0x1p-24, "", 1.0,
            maximum(peak_pyramid, peak_corners, HeightRay(vec2(0.0625, 0.6875), vec2(0.875, 0.0))))
CASE_EQUALS("straight down a peak's side", 42 * 0x1p-24, "", 0.5,
            maximum(peak_pyramid, peak_corners, HeightRay(vec2(0.375, 0.4375), vec2(0.0, 0.0))))
CASE_EQUALS("straight down on its tip", 0, "", 0.0,
            maximum(peak_pyramid, peak_corners, HeightRay(vec2(0.4375, 0.4375), vec2(0.0, 0.0))))
CASE_EQUALS("up an edge", 42 * 0x1p-24, "", 0.8,
            maximum(edge_pyramid, edge_corners, HeightRay(vec2(0.0625, 0.375), vec2(0.5, 0.0))))
CASE_EQUALS("along v in the middle of a cell", 42 * 0x1p-24, "", 0.5,
            maximum(edge_pyramid, edge_corners, HeightRay(vec2(0.5, 0.375), vec2(0.0, 2.5))))
CASE_EQUALS("across the border: the edge that falls", 42 * 2 * 0x1p-24, "", 7 / 9.0,
            maximum(edge_pyramid, edge_corners, HeightRay(vec2(1.375, 0.375), vec2(-0.4375, 0.0))))
CASE_EQUALS("one texel high: onto the ridge", 42 * 2 * 0x1p-24, "", 0.5,
            maximum(slope_pyramid, slope_corners, HeightRay(vec2(0.03125, 0.5), vec2(1.0, 0.3))))
CASE_EQUALS("flat 0", 0, "", 1.0,
            maximum(flat_0_pyramid, flat_0_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4))))
CASE_EQUALS("flat 1", 0, "", 0.0,
            maximum(flat_1_pyramid, flat_1_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4))))
CASE_EQUALS("a 1x1 map", 2 * 0x1p-24, "", 0.25,
            maximum(one_pyramid, one_corners, HeightRay(vec2(0.3, 0.7), vec2(-1.5, 2.5))))
CASE("grazing: 19 repeats across", 5 * 20 * 8 * 0x1p-24, "",
     maximum(edge_pyramid, edge_corners, HeightRay(vec2(0.1, 0.7), vec2(-19.08, 3.1))))
CASE_FLIP("the largest tangents", 1, "",
          maximum(edge_pyramid, edge_corners, HeightRay(vec2(0.1, 0.7), vec2(1e6, -1e6))))

CASE_EQUALS("one step leads to the next cell", 0, "", 0.25,
            cone(edge_cones, edge_corners, HeightRay(vec2(0.0625, 0.375), vec2(0.5, 0.0)), 1))
CASE_EQUALS("and one on a gentle slope farther", 42 * 0x1p-24, "", 0.5,
            cone(slope_cones, slope_corners, HeightRay(vec2(0.03125, 0.5), vec2(1.0, 0.0)), 1))
CASE_EQUALS("up an edge", 42 * 0x1p-24, "", 0.8,
            cone(edge_cones, edge_corners, HeightRay(vec2(0.0625, 0.375), vec2(0.5, 0.0)), 8))
CASE_EQUALS("along an edge onto a peak", 42 * 0x1p-24, "", 0.375,
            cone(peak_cones, peak_corners, HeightRay(vec2(0.0625, 0.4375), vec2(0.875, 0.0)), 8))
CASE_EQUALS("through corners onto a peak", 42 * 0x1p-24, "", 0.39667696007181547,
            cone(peak_cones, peak_corners, HeightRay(vec2(0.0625, 0.0625), vec2(0.875, 0.875)), 8))
CASE_EQUALS("straight down a peak's side", 42 * 0x1p-24, "", 0.5,
            cone(peak_cones, peak_corners, HeightRay(vec2(0.375, 0.4375), vec2(0.0, 0.0)), 8))
CASE_EQUALS("flat 0", 0, "", 1.0, cone(no_cones, flat_0_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4)), 8))
CASE_EQUALS("flat 1", 0, "", 0.0, cone(no_cones, flat_1_corners, HeightRay(vec2(0.3, 0.7), vec2(0.9, 0.4)), 8))
CASE_EQUALS("a 1x1 map", 2 * 0x1p-24, "", 0.25,
            cone(one_cones, one_corners, HeightRay(vec2(0.3, 0.7), vec2(-1.5, 2.5)), 8))
CASE("grazing: 19 repeats across", 5 * 20 * 8 * 0x1p-24, "",
     cone(edge_cones, edge_corners, HeightRay(vec2(0.1, 0.7), vec2(-19.08, 3.1)), 64))
CASE_FLIP("the largest tangents", 1, "",
          cone(edge_cones, edge_corners, HeightRay(vec2(0.1, 0.7), vec2(1e6, -1e6)), 64))
