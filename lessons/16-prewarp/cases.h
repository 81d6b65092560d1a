// The hard cases of warped.glsl; tests/cases_glm.cpp says how this is written.
//
// One operation rounds by u = 2^-24 of its result, and so is a literal like 0.1; 0.125 is exact. Divisions are
// granted 2.5 units in the last place, 5 u, as GLSL does.

CASE_TEXTURE(one, 1, 1, vec4(0.5, 0.25, 0.75, 1.0))
CASE_TEXTURE(empty, 4, 2, vec4(0.0))
CASE_TEXTURE(whole, 4, 2, vec4(1.0))
CASE_TEXTURE(gap, 4, 2, vec4(x == 2 ? 0.0 : 1.0))    // a column of holes
CASE_TEXTURE(faint, 4, 2, vec4(x == 2 ? 0.125 : 1.0)) // one that is mostly transparent
CASE_TEXTURE(places, 4, 2, vec4((float(x) + 0.5) / 4.0, (float(y) + 0.5) / 2.0, 0.5, 0.0))   // where each texel was
CASE_TEXTURE(cliff, 4, 2, vec4(x < 2 ? 0.125 : 0.875, 0.5, x < 2 ? 0.0 : 1.0, 0.0)) // 3/4 of the source between them

// ---- landed_colour: a division, 5 u |c|

CASE_EQUALS("all of it landed", 5 * 0.5 * 0x1p-24, "", vec3(0.25, 0.5, 0.125), landed_colour(vec4(0.25, 0.5, 0.125, 1.0)))
CASE_EQUALS("half of it landed", 5 * 0.5 * 0x1p-24, "", vec3(0.25, 0.5, 0.125),
            landed_colour(vec4(0.125, 0.25, 0.0625, 0.5)))
CASE("a 65535th landed", 7 * 0x1p-24, "", landed_colour(vec4(vec3(0.5), 1.0) / 65535.0))
CASE_EQUALS("black", 0, "", vec3(0.0), landed_colour(vec4(0.0, 0.0, 0.0, 0.75)))

// ---- landed_normal: 2 c - a rounds by u |2 c - a|, and what a literal c is off counts twice; normalizing adds 6 u of
// each component (two sums and three products in the square, halved by the root, a root, a division)

CASE_EQUALS("straight up", 6 * 0x1p-24, "", vec3(0.0, 0.0, 1.0), landed_normal(vec4(0.5, 0.5, 1.0, 1.0)))
CASE_EQUALS("straight up; half landed", 6 * 0x1p-24, "", vec3(0.0, 0.0, 1.0), landed_normal(vec4(0.25, 0.25, 0.5, 0.5)))
CASE_EQUALS("tilted", (2 * 0.9 + 7) * 0x1p-24, "", vec3(0.8, 0.0, 0.6), landed_normal(vec4(0.9, 0.5, 0.8, 1.0)))
CASE("tilted; a 65535th landed", (4 * 0.9 + 7) * 0x1p-24, "", landed_normal(vec4(0.9, 0.5, 0.8, 1.0) / 65535.0))
CASE("the steepest that is stored", (4 * 1.0 + 7) * 0x1p-24, "", landed_normal(vec4(255.0, 127.0, 128.0, 255.0) / 255.0))
CASE("two sides of a ridge mixed: short and up", (4 * 0.51 / 0.02 + 7) * 0x1p-24, "",
     landed_normal(vec4(0.5, 0.5, 0.51, 1.0)))

// ---- landed_point: differences and products of numbers that are exact here

CASE_EQUALS("a point below a wide polygon", 0, "", vec3(0.25, -0.125, -0.0625),
            landed_point(vec3(0.75, 0.25, 0.5), 0.125, 1.0, 0.5))
CASE_EQUALS("one above a tall polygon", 0, "", vec3(-0.5, 1.0, 0.0625), landed_point(vec3(0.0, 1.0, 0.5), 0.125, 0.0, 2.0))

// ---- lit: a dot product of unit vectors, 3 u and a literal's 2 u; the mix adds 3 u, the product 1 u

CASE_EQUALS("along the normal", 0, "", vec3(0.5, 0.25, 1.0), lit(vec3(0.5, 0.25, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), 0.25))
CASE_EQUALS("at the horizon", 0, "", vec3(0.125, 0.0625, 0.25),
            lit(vec3(0.5, 0.25, 1.0), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), 0.25))
CASE_EQUALS("from behind", 0, "", vec3(0.125, 0.0625, 0.25),
            lit(vec3(0.5, 0.25, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), 0.25))
CASE("at the horizon but for rounding", 9 * 0x1p-24, "", lit(vec3(1.0), vec3(0.6, 0.0, 0.8), vec3(0.8, 0.0, -0.6), 0.0))
CASE("from the side", 9 * 0x1p-24, "", lit(vec3(0.9, 0.5, 0.1), vec3(0.36, 0.48, 0.8), vec3(0.6, 0.0, 0.8), 0.3))
CASE_EQUALS("all of it ambient", 0, "", vec3(0.5, 0.25, 1.0),
            lit(vec3(0.5, 0.25, 1.0), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), 1.0))

// ---- mixed_texel, mixed_weight: whole numbers, and products of numbers that are exact here

CASE_EQUALS("the first", 0, "", ivec2(1, 0), mixed_texel(vec2(1.0, 0.0), 0, ivec2(4, 2)))
CASE_EQUALS("the last", 0, "", ivec2(2, 1), mixed_texel(vec2(1.0, 0.0), 3, ivec2(4, 2)))
CASE_EQUALS("before the first column and row", 0, "", ivec2(0, 0), mixed_texel(vec2(-1.0, -1.0), 0, ivec2(4, 2)))
CASE_EQUALS("beyond the last column and row", 0, "", ivec2(3, 1), mixed_texel(vec2(3.0, 1.0), 3, ivec2(4, 2)))
CASE_EQUALS("of one texel", 0, "", ivec2(0, 0), mixed_texel(vec2(0.0, -1.0), 1, ivec2(1, 1)))
CASE_EQUALS("on the first", 0, "", 1.0, mixed_weight(vec2(0.0, 0.0), 0))
CASE_EQUALS("right of it", 0, "", 0.1875, mixed_weight(vec2(0.25, 0.25), 1))
CASE_EQUALS("above it", 0, "", 0.375, mixed_weight(vec2(0.25, 0.5), 2))
CASE_EQUALS("right and above", 0, "", 0.125, mixed_weight(vec2(0.25, 0.5), 3))

// ---- landed_lookup: the place rounds by u, times the size; so do the weights, and what they mix differs by at most D.
// Four products, sums and a division: 9 u.

CASE_EQUALS("on a texel's centre", 5 * 0x1p-24, "", vec4(0.375, 0.25, 0.5, 1.0),
            landed_lookup(whole, places, vec2(0.375, 0.25), vec2(0.3, 0.6)))
CASE_EQUALS("between two texels", 5 * 0x1p-24, "", vec4(0.5, 0.25, 0.5, 1.0),
            landed_lookup(whole, places, vec2(0.5, 0.25), vec2(0.3, 0.6)))
CASE_EQUALS("among four", 5 * 0x1p-24, "", vec4(0.5, 0.5, 0.5, 1.0),
            landed_lookup(whole, places, vec2(0.5, 0.5), vec2(0.3, 0.6)))
CASE("anywhere among four", (4 * 0.25 + 9) * 0x1p-24, "", landed_lookup(whole, places, vec2(0.43, 0.61), vec2(0.3, 0.6)))
CASE_EQUALS("neighbours too far apart: the nearest", 5 * 0x1p-24, "", vec4(0.375, 0.25, 0.5, 0.75),
            landed_lookup(whole, places, vec2(0.4375, 0.25), vec2(0.2, 0.6)))
CASE_EQUALS("left of a cliff", 5 * 0x1p-24, "", vec4(0.125, 0.5, 0.0, 0.75),
            landed_lookup(whole, cliff, vec2(0.4375, 0.5), vec2(0.3, 0.6)))
CASE_EQUALS("right of it", 5 * 0x1p-24, "", vec4(0.875, 0.5, 1.0, 0.75),
            landed_lookup(whole, cliff, vec2(0.5625, 0.5), vec2(0.3, 0.6)))
CASE_EQUALS("in its middle: the first", 5 * 0x1p-24, "", vec4(0.125, 0.5, 0.0, 0.5),
            landed_lookup(whole, cliff, vec2(0.5, 0.5), vec2(0.3, 0.6)))
CASE_FLIP("in its middle but for rounding", 1.0, "", landed_lookup(whole, cliff, vec2(0.1 * 5.0, 0.5), vec2(0.3, 0.6)))
CASE_EQUALS("beside a hole", 5 * 0x1p-24, "", vec4(0.375, 0.25, 0.5, 0.75),
            landed_lookup(gap, places, vec2(0.4375, 0.25), vec2(0.3, 0.6)))
CASE_EQUALS("in a hole; beside what landed", 5 * 0x1p-24, "", vec4(0.375, 0.25, 0.5, 0.25),
            landed_lookup(gap, places, vec2(0.5625, 0.25), vec2(0.3, 0.6)))
CASE_EQUALS("in the middle of a hole", 0, "", vec4(0.0), landed_lookup(gap, places, vec2(0.625, 0.25), vec2(0.3, 0.6)))
CASE_EQUALS("nothing landed", 0, "", vec4(0.0), landed_lookup(empty, places, vec2(0.4, 0.3), vec2(0.3, 0.6)))
CASE_EQUALS("beside a faint texel; which weighs little", 9 * 0x1p-24, "", vec4(0.40277777777777779, 0.25, 0.5, 0.5625),
            landed_lookup(faint, places, vec2(0.5, 0.25), vec2(0.3, 0.6)))
CASE_EQUALS("in a corner", 5 * 0x1p-24, "", vec4(0.125, 0.25, 0.5, 1.0),
            landed_lookup(whole, places, vec2(0.0, 0.0), vec2(0.3, 0.6)))
CASE_EQUALS("in the other", 5 * 0x1p-24, "", vec4(0.875, 0.75, 0.5, 1.0),
            landed_lookup(whole, places, vec2(1.0, 1.0), vec2(0.3, 0.6)))
CASE_EQUALS("of one texel", 5 * 0x1p-24, "", vec4(0.5, 0.25, 0.75, 1.0),
            landed_lookup(one, one, vec2(0.3, 0.9), vec2(0.3, 0.6)))
