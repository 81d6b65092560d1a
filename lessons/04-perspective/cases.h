// The hard cases of perspective.glsl and clip.glsl; tests/cases_glm.cpp says how this is written.
//
// One operation rounds by u = 2^-24 of its result, and so is a literal like 0.1; 0.125 is exact. Divisions
// are granted 2.5 units in the last place, 5 u, as GLSL does: 10 u M of span.h becomes 14 u M.

// ---- linear_at: the step, the product and the sum round, by u |step k| each, and the start: 4 u (|start| +
// |step k|)

CASE("the far end", 0, "", linear_at(0.125, 0.75, 0.0))
CASE("a span of one pixel", 4 * 0.4 * 0x1p-24, "", linear_at(0.1, 0.3, 1.0))
CASE("the widest span", 4 * 4915.0 * 0x1p-24, "", linear_at(0.1, 0.3, 16383.0))
CASE("1/w from the far end: small stays exact", 4 * 0.00017 * 0x1p-24, "", linear_at(0.00015, 0.00002, 1.0))
CASE("1/w from the near end: it cancels", 4 * 2.0 * 0x1p-24, "", linear_at(1.0, -0.00006103, 16383.0))
CASE("s of 10000", 4 * 10016.0 * 0x1p-24, "", linear_at(10000.0, -0.001, 16000.0))

// ---- at_least and between return one of their arguments: no rounding but that of literals, no jump

CASE("above", 0, "", at_least(0.5, 0.25))
CASE("1/w = 0: on the horizon", 0, "", at_least(0.0, 0.25))
CASE("1/w below 0: beyond the horizon", 0, "", at_least(-3.0, 0.25))
CASE("no number", 0, "", at_least(0.0 / 0.0, 0.25))
CASE("on the border but for rounding", 0.3 * 0x1p-24, "", at_least(0.1 + 0.2, 0.3))

CASE("inside", 0, "", between(0.5, -1.0, 2.0))
CASE("below", 0, "", between(-9.0, -1.0, 2.0))
CASE("above", 0, "", between(9.0, -1.0, 2.0))
CASE("without end", 0, "", between(1.0 / 0.0, -1.0, 2.0))
CASE("no number", 0, "", between(0.0 / 0.0, -1.0, 2.0))
CASE("a range of one value", 0, "", between(0.5, 0.25, 0.25))

// ---- perspective_at: 14 u M, M the largest |s| from the far end on

CASE("the far end", 14 * 0x1p-24, "repeats", perspective_at(0.001, 0.01, 0.001, 0.01, 0.0005, 0.0))
CASE("the middle of a tilted quad", 14 * 0x1p-24, "repeats",
     perspective_at(0.3, 0.0007, 0.3, 0.0009, 0.15, 320.0))
CASE("w the same everywhere", 14 * 0x1p-24, "repeats", perspective_at(0.0, 0.00078, 0.8, 0.0, 0.4, 639.0))
CASE("the widest span", 14 * 0x1p-24, "repeats",
     perspective_at(0.001, 0.0002, 0.001, 0.0003, 0.0005, 16383.0))
CASE("s passes through 0", 14 * 0.7 * 0x1p-24, "repeats",
     perspective_at(-0.07, 0.0007, 0.1, 0.003, 0.05, 100.0))
CASE("s from 9800", 14 * 9800.0 * 0x1p-24, "repeats",
     perspective_at(0.49, 0.0001, 0.00005, 0.0001, 0.000025, 1.0))
CASE("s from 9800 at its near end", 14 * 9800.0 * 0x1p-24, "repeats",
     perspective_at(0.49, 0.0001, 0.00005, 0.0001, 0.000025, 639.0))
// 1/w = 0 and less happens just outside of a polygon: there `least` is what counts
CASE("on the horizon", 14 * 500.0 * 0x1p-24, "repeats", perspective_at(0.5, 0.25, 0.0, 0.125, 0.001, 0.0))
CASE("beyond the horizon", 14 * 8.0 * 0x1p-24, "repeats", perspective_at(0.5, 0.25, -0.5, 0.125, 0.0625, 1.0))
CASE("w of 1e6: as far as clip_vertex goes", 14 * 0x1p-24, "repeats",
     perspective_at(0.000001, 0.0001, 0.000001, 0.0002, 0.0000005, 20.0))
CASE("w of 1e-6: as near", 14 * 0x1p-24, "repeats",
     perspective_at(900000.0, 90.0, 1000000.0, 100.0, 500000.0, 20.0))
CASE("a polygon without area: level planes", 14 * 0x1p-24, "repeats",
     perspective_at(0.25, 0.0, 0.5, 0.0, 0.25, 639.0))
// Why k counts from the far end. The same span from its near end: 1/w = 1 - 0.99936 has an absolute error of
// 4 u 2, and so a relative one of 8 u / 0.00063
CASE("from the near end", 27.0 * (8 / 0.00063 + 8 / 0.017 + 5) * 0x1p-24, "repeats",
     perspective_at(1.0, -0.00006, 1.0, -0.000061, 0.0000001, 16383.0))
CASE("from the far end", 14 * 27.0 * 0x1p-24, "repeats",
     perspective_at(0.01702, 0.00006, 0.000637, 0.000061, 0.0003, 0.0))

// ---- span_step: the difference by u, and by u |start| + u |end| of literals; the division by 5 u

CASE("one pixel", (2 * 0.4 + 6 * 0.2) * 0x1p-24, "repeats", span_step(0.1, 0.3, 1.0))
CASE("the same at both ends", 0, "repeats", span_step(0.25, 0.25, 64.0))
CASE("neighbours at 10000: the difference is exact", 5 * 0.0625 * 0x1p-24, "repeats",
     span_step(9999.5, 10000.5, 16.0))
CASE("neighbours at 10000 that were rounded", (2e4 + 6 * 0.2) / 16 * 0x1p-24, "repeats",
     span_step(9999.9, 10000.1, 16.0))
CASE("the widest span", (2 * 2.0 + 6) / 16383 * 0x1p-24, "repeats", span_step(-1.0, 0.1, 16383.0))

// ---- clip_parameter: inside >= 0 > outside, so the difference is a sum and nothing cancels: 8 u t

CASE("half way", 0, "", clip_parameter(1.0, -1.0))
CASE("the inner end on the plane", 0, "", clip_parameter(0.0, -1.0))
CASE("the outer end almost on it", 8 * 0x1p-24, "", clip_parameter(1.0, -1e-30))
CASE("the outer end in the eye: w = 0", 8 * 0x1p-24, "", clip_parameter(0.999999, -0.000001))
CASE("the outer end behind the eye", 8 * 0x1p-24, "", clip_parameter(0.3, -7.1))
CASE("the inner end almost in the eye", 8 * 1e-7 * 0x1p-24, "", clip_parameter(0.0000001, -1.0))
CASE("both almost on it", 8 * 0x1p-24, "", clip_parameter(2e-38, -3e-38))
CASE("both far away", 8 * 0x1p-24, "", clip_parameter(1e38, -1.3e38))

// ---- clip_mix: 1 - t, two products, a sum and literals: 6 u (|a| + |b|)

CASE("t = 0: a itself", 0, "", clip_mix(0.125, 100000000.0, 0.0))
CASE("t = 1: b itself", 0, "", clip_mix(100000000.0, 0.125, 1.0))
CASE("between equals", 6 * 0.6 * 0x1p-24, "", clip_mix(0.3, 0.3, 0.7))
CASE("16384 pixels off on either side", 0, "", clip_mix(16384.0, -16384.0, 0.5))
CASE("w cancels", 6 * 2.0 * 0x1p-24, "", clip_mix(0.999999, -0.7, 0.5882349))
CASE("the largest numbers", 6 * 2e8 * 0x1p-24, "", clip_mix(1e8, -1e8, 0.3))
CASE("an edge cut by the near plane", 6 * 12.0 * 0x1p-24, "",
     clip_mix(2.0, -10.0, clip_parameter(1.9, -10.1)))
