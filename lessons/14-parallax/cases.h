// The hard cases of parallax.glsl; tests/cases_glm.cpp says how this is written.
//
// One operation rounds by u = 2^-24 of its result, and so is a literal like 0.1; 0.125 is exact. Divisions are
// granted 2.5 units in the last place, 5 u, as GLSL does.

CASE_TEXTURE(one, 1, 1, 0.75)
CASE_TEXTURE(gentle, 16, 1, 0.0625 * float(x < 8 ? x : 16 - x)) // slope 1: 1/16 a texel, 16 texels
CASE_TEXTURE(cliff, 8, 4, x < 4 ? 0.0 : 1.0)                    // slope 8 between two texels, else flat

// ---- displacement: two operations, 2 u |d|; 0.1 adds one, 0.3 another of 0.3 scale

CASE("depth 0: the base", 0, "widths", displacement(1.0, 0.125, 1.0))
CASE("depth 1", 2 * 0.125 * 0x1p-24, "widths", displacement(0.0, 0.125, 1.0))
CASE("base 0", (3 * 0.1 + 0.1) * 0x1p-24, "widths", displacement(1.0, 0.1, 0.0))
CASE("just below the base", (3 * 0.1 + 0.1) * 0x1p-24, "widths", displacement(0.9999, 0.1, 1.0))
CASE("no scale", 0, "widths", displacement(0.3, 0.0, 1.0))

// ---- to_polygon: three products and two sums round by 3 u |v|; the cross product by 3 u |v| more, literals by
// 2 u |v|: 8 u |v|

CASE("along the axes", 0, "", to_polygon(vec3(0.5, 0.25, 1.0), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), 1.0))
CASE_EQUALS("mirrored", 0, "", vec3(0.5, -0.25, 1.0),
            to_polygon(vec3(0.5, 0.25, 1.0), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), -1.0))
CASE_EQUALS("turned", 8 * 0x1p-24, "", vec3(0.024, 0.64, 0.768),
            to_polygon(vec3(0.48, 0.64, 0.6), vec3(0.6, 0.0, 0.8), vec3(0.8, 0.0, -0.6), 1.0))
CASE_EQUALS("turned and mirrored", 8 * 0x1p-24, "", vec3(0.024, -0.64, 0.768),
            to_polygon(vec3(0.48, 0.64, 0.6), vec3(0.6, 0.0, 0.8), vec3(0.8, 0.0, -0.6), -1.0))
CASE("in the plane: z cancels", 8 * 0x1p-24, "",
     to_polygon(vec3(0.8, 0.0, -0.6), vec3(0.6, 0.0, 0.8), vec3(0.8, 0.0, -0.6), 1.0))
CASE("no vector", 0, "", to_polygon(vec3(0.0), vec3(0.6, 0.0, 0.8), vec3(0.8, 0.0, -0.6), 1.0))

// ---- view_tangents: a division and two literals, 7 u |t|. Where z has the absolute error e, t = x / z has
// e / z = e t / x of itself: after to_polygon, 8 u t^2 more. That is what grazing costs.

CASE("along the normal", 0, "", view_tangents(vec3(0.0, 0.0, 1.0)))
CASE("at 45 degrees", 0, "", view_tangents(vec3(0.5, -0.5, 0.5)))
CASE("at 60 degrees", 7 * 1.7321 * 0x1p-24, "", view_tangents(vec3(0.8660254, 0.0, 0.5)))
CASE("grazing", 7e3 * 0x1p-24, "", view_tangents(vec3(0.6, -0.8, 0.001)))
CASE("grazing after to_polygon", (7 * 100.0 + 8 * 100.0 * 100.0) * 0x1p-24, "",
     view_tangents(to_polygon(vec3(0.806, 0.0, -0.592), vec3(0.6, 0.0, 0.8), vec3(0.8, 0.0, -0.6), 1.0)))
CASE("just above the plane", 7 * 5e5 * 0x1p-24, "", view_tangents(vec3(1.0, 0.5, 2e-6)))
CASE("in the plane", 0, "", view_tangents(vec3(0.6, 0.8, 0.0)))
CASE("in the plane but for rounding", 0, "", view_tangents(vec3(0.6, 0.8, 1e-7)))
CASE("the smallest z", 0, "", view_tangents(vec3(0.6, 0.8, 1e-38)))
CASE("behind the polygon", 0, "", view_tangents(vec3(0.6, 0.0, -0.8)))
CASE("no view", 0, "", view_tangents(vec3(0.0)))
CASE("no number", 0, "", view_tangents(vec3(0.0 / 0.0, 1.0, 0.0 / 0.0)))
CASE_FLIP("on the border of the plane", 1.000001e6, "", view_tangents(vec3(1.0, 0.0, 0.1 * 0.00001)))

// ---- parallax: the product, the division by aspect, the sum and literals, 9 u (|u| + |d t|)

CASE("depth 0", 0, "repeats", parallax(vec2(0.25, 0.75), 0.0, vec2(1.5, -2.5), 1.0))
CASE("depth 1", 9 * 0.7 * 0x1p-24, "repeats", parallax(vec2(0.3, 0.7), -0.1, vec2(1.5, -2.5), 1.0))
CASE("a wide texture", 9 * (0.7 + 0.5) * 0x1p-24, "repeats", parallax(vec2(0.3, 0.7), -0.1, vec2(1.5, -2.5), 0.5))
CASE("the largest tangents", 9 * 1e5 * 0x1p-24, "repeats", parallax(vec2(0.3, 0.7), -0.1, vec2(1e6, -1e6), 1.0))
CASE("depth 0 and the largest tangents", 0, "repeats", parallax(vec2(0.25, 0.75), 0.0, vec2(1e6, -1e6), 1.0))
CASE("a view in the plane shifts nothing", 0, "repeats",
     parallax(vec2(0.25, 0.75), -0.1, view_tangents(vec3(0.6, 0.8, 0.0)), 1.0))
CASE("mirrored", 9 * (0.75 + 0.1) * 0x1p-24, "repeats",
     parallax(vec2(0.25, 0.75), -0.1,
              view_tangents(to_polygon(vec3(0.5, 0.25, 1.0), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), -1.0)), 1.0))

// ---- offset_limit: the same with |t| at most 1; a view in the plane is no special case

CASE("along the normal", 0, "repeats", offset_limit(vec2(0.25, 0.75), -0.125, vec3(0.0, 0.0, 1.0), 1.0))
CASE("in the plane", 9 * 0.8 * 0x1p-24, "repeats", offset_limit(vec2(0.3, 0.7), -0.1, vec3(0.6, 0.8, 0.0), 1.0))
CASE("depth 0", 0, "repeats", offset_limit(vec2(0.25, 0.75), 0.0, vec3(0.6, 0.8, 0.0), 1.0))
CASE("a wide texture", 9 * 0.9 * 0x1p-24, "repeats", offset_limit(vec2(0.3, 0.7), -0.1, vec3(0.6, 0.8, 0.0), 0.5))

// ---- iterated: each iteration adds e = 9 u (|u| + |d t|) + |t| scale r, where r, the error of the height read, is
// 3 u |uv size| D + 8 u (a place rounded three times, D the largest difference of neighbours, eight operations); what
// was wrong before it multiplies by q = |t| scale max|grad h|. So k iterations are off by at most
// e (1 + q + ... + q^(k-1)): for q < 1 by e / (1 - q), however many. The bilinear height is continuous, so even at a
// step and in a fold nothing jumps, but q > 1 multiplies what rounding began.

CASE("a 1x1 map", (9 * 1.0 + 2.5 * 0.1 * 11) * 0x1p-24, "repeats",
     iterated(vec2(0.3, 0.7), one, 0.1, 1.0, vec2(1.5, -2.5), 1.0, 16))
CASE("depth 0 everywhere", 0, "repeats", iterated(vec2(0.25, 0.75), one, 0.125, 0.75, vec2(1.5, -2.5), 1.0, 16))
CASE("no scale", 0, "repeats", iterated(vec2(0.25, 0.75), cliff, 0.0, 1.0, vec2(1.5, -2.5), 1.0, 16))
CASE("a view in the plane shifts nothing", 0, "repeats",
     iterated(vec2(0.25, 0.75), cliff, 0.1, 1.0, view_tangents(vec3(1.0, 0.0, 0.0)), 1.0, 16))
// q = 2 * 0.125 * 1 = 1/4
CASE("one iteration", (9 * 0.6 + 2 * 0.125 * (3 * 0.3 * 16 / 16.0 + 8)) * 0x1p-24, "repeats",
     iterated(vec2(0.3, 0.5), gentle, 0.125, 1.0, vec2(2.0, 0.0), 1.0, 1))
CASE("contracting: q = 1/4", (9 * 0.6 + 2 * 0.125 * (3 * 0.3 * 16 / 16.0 + 8)) * 4 / 3.0 * 0x1p-24, "repeats",
     iterated(vec2(0.3, 0.5), gentle, 0.125, 1.0, vec2(2.0, 0.0), 1.0, 16))
// q = 2 * 0.125 * 8 = 2: after 4 iterations 15 e, after 16 65535 e; e from |u| <= 0.5, |d t| <= 0.25, D = 1
CASE("a step in depth: q = 2", 15 * (9 * 0.75 + 0.25 * (3 * 0.5 * 8 + 8)) * 0x1p-24, "repeats",
     iterated(vec2(0.6, 0.5), cliff, 0.125, 1.0, vec2(2.0, 0.0), 1.0, 4))
CASE("a fold: it swings for ever", 65535 * (9 * 0.75 + 0.25 * (3 * 0.5 * 8 + 8)) * 0x1p-24, "repeats",
     iterated(vec2(0.6, 0.5), cliff, 0.125, 1.0, vec2(2.0, 0.0), 1.0, 16))
CASE("on the step's edge", 15 * (9 * 0.75 + 0.25 * (3 * 0.5 * 8 + 8)) * 0x1p-24, "repeats",
     iterated(vec2(0.5, 0.5), cliff, 0.125, 1.0, vec2(2.0, 0.0), 1.0, 4))
// A tangent of 1e6 leads 1e5 repeats away, where a float's texel is all but lost: the second read may be any height
CASE_FLIP("the largest tangents", 1e5, "repeats",
          iterated(vec2(0.3, 0.7), cliff, 0.1, 1.0, vec2(1e6, 0.0), 1.0, 2))
