// The hard cases of light.glsl and pattern.glsl; tests/cases_glm.cpp says how this is written.
//
// One operation rounds by u = 2^-24 of its result, and so is a literal like 0.1; 0.125 is exact. Divisions
// and inversesqrt are granted 5 u. pow is exp2(y log2 x) in OpenGL, and drivers differ: log2 is granted
// 2^-20, as OSMesa's polynomials have it, so pow(x, 40) may be off by 40 ln 2 2^-20 of itself, 2.7e-5, and
// exp2's share.

// ---- lit: dot products round by 3 u and literals by 2 u, 8 u in all. Outside of the highlight that is all

CASE("facing away", 2 * 0.25 * 0x1p-24, "linear",
     lit(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), vec3(0.0, 0.0, 1.0)))
CASE("light along the surface", 2 * 0.25 * 0x1p-24, "linear",
     lit(vec3(1.0, 0.5, 0.25), vec3(0.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)))
CASE("no normal", 2 * 0.25 * 0x1p-24, "linear",
     lit(vec3(1.0, 0.5, 0.25), vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0)))
CASE("no number for a normal", 2 * 0.25 * 0x1p-24, "linear",
     lit(vec3(1.0, 0.5, 0.25), vec3(0.0 / 0.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0)))
CASE_EQUALS("straight on", 3e-5 * 0.25, "linear", vec3(1.1, 0.675, 0.4625),
            lit(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0)))
CASE("eye opposite the light: no middle", 8 * 0x1p-24, "linear",
     lit(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.6, 0.8), vec3(0.0, -0.6, -0.8)))
CASE("all but opposite", 8 * 0x1p-24, "linear",
     lit(vec3(1.0, 0.5, 0.25), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.6, 0.8), vec3(0.0, -0.6, -0.8001)))
CASE("black in the middle of the highlight", 6e-5 * 0.25, "linear",
     lit(vec3(0.0), vec3(0.0, 0.6, 0.8), vec3(0.0, 0.6, 0.8), vec3(0.0, 0.6, 0.8)))
CASE("black beside the highlight", 6e-5 * 0.25 * 0.5, "linear",
     lit(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.28, 0.0, 0.96), vec3(0.0, 0.0, 1.0)))
CASE("black far from the highlight", 1e-7, "linear",
     lit(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.96, 0.0, 0.28), vec3(0.6, 0.8, 0.0)))
CASE_FLIP("light along the surface but for rounding", 8 * 0x1p-24, "linear",
          lit(vec3(1.0), vec3(0.6, 0.8, 0.0), vec3(0.8, -0.6, 0.0), vec3(0.6, 0.8, 0.0)))

// ---- stored_normal: the difference cancels where the texel is near alpha / 2, by u / 2 of numbers up to 1;
// then the direction is off by that over its length

CASE_EQUALS("along x", 8 * 0x1p-24, "", vec3(1.0, 0.0, 0.0), stored_normal(vec4(1.0, 0.5, 0.5, 1.0)))
CASE_EQUALS("along -z and half covered", 8 * 0x1p-24, "", vec3(0.0, 0.0, -1.0),
            stored_normal(vec4(0.25, 0.25, 0.0, 0.5)))
CASE("slanted", 8 * 0x1p-24, "", stored_normal(vec4(0.8, 0.9, 0.5, 1.0)))
CASE("one 65535th of a texel", 8 * 0x1p-24, "", stored_normal(vec4(0.0, 0.0000152590, 0.0, 0.0000152590)))
CASE("two that cancel: no normal", 0, "", stored_normal(vec4(0.5, 0.5, 0.5, 1.0)))
CASE("two that all but cancel", 4 * 0x1p-24 / 0.001, "", stored_normal(vec4(0.501, 0.5, 0.5, 1.0)))
CASE("nothing", 0, "", stored_normal(vec4(0.0)))

// ---- stored_colour: a division and literals

CASE_EQUALS("covered", 0, "linear", vec3(0.5, 0.25, 1.0), stored_colour(vec4(0.5, 0.25, 1.0, 1.0)))
CASE_EQUALS("a quarter covered", 5 * 0x1p-24, "linear", vec3(0.5, 0.25, 1.0),
            stored_colour(vec4(0.125, 0.0625, 0.25, 0.25)))
CASE("one 65535th", 7 * 0x1p-24, "linear", stored_colour(vec4(0.0000152590, 0.0, 0.0000076295, 0.0000152590)))

// ---- coverage: the difference from 1/2 is divided by the width

CASE_EQUALS("nothing", 0, "1", 0.0, coverage(0.0, 0.5))
CASE_EQUALS("all", 0, "1", 1.0, coverage(1.0, 0.5))
CASE_EQUALS("half", 0, "1", 0.5, coverage(0.5, 0.5))
CASE_EQUALS("three eighths", 0, "1", 0.25, coverage(0.375, 0.5))
CASE("a narrow ramp", 3 * 0x1p-24 / 0.01, "1", coverage(0.501, 0.01))

// ---- wave, toy_tone, bunny_tone: x / length is off by 8 u of itself, so the sine by 2 pi times that, and by
// 2^-20 of OSMesa's own; three of them, times four, in toy_tone

CASE("no way", 1e-6, "1", wave(0.0, 1.0))
CASE("a quarter", 1e-6 + 2 * 3.15 * 0.25 * 8 * 0x1p-24, "1", wave(0.25, 1.0))
CASE("backwards three times around", 1e-6 + 2 * 3.15 * 3.1 * 8 * 0x1p-24, "1", wave(-3.1, 1.0))
CASE("the middle of a check", 3 * 4e-6, "linear", toy_tone(vec3(0.22, 0.22, 0.22)))
CASE("the edge of a check", 3 * 4e-6, "linear", toy_tone(vec3(0.11, 0.2, -0.3)))
CASE("the corner of the toy", 3 * 4e-6, "linear", toy_tone(vec3(1.05, -1.03, 1.01)))
CASE("the middle of the bunny", 4e-6, "linear", bunny_tone(vec3(0.0)))
CASE("the corner of the bunny", 16e-6, "linear", bunny_tone(vec3(1.0, 1.0, -0.8)))
