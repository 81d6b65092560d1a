// The hard cases of light-field.glsl and solids.glsl; tests/cases_glm.cpp says how this is written.
//
// One operation rounds by u = 2^-24 of its result. `angle`: of the quotient (1 u), its square, and six terms of
// Horner's rule, all below 1, at most 6 u are left; pi/2 and pi and the two differences from them round by 4 u and
// 6 u. So 16 u, and where it is an angle in degrees over 180 or 360, 16 u / pi + 2 u < 8 u. A length under it
// rounds by 3 u, which turns the angle by no more than 1.5 u. Its polynomial's own 1.7e-6 is the same in float and
// in double, and shows only against what is known (CASE_EQUALS): 1.7e-6 + 16 u.

// ---- angle

CASE_EQUALS("along the axes", 16 * 0x1p-24, "rad", vec4(0.0, 0.5 * PI, PI, -0.5 * PI),
            angle(vec4(0.0, 1.0, 0.0, -1.0), vec4(1.0, 0.0, -1.0, 0.0)))
CASE_EQUALS("on the diagonals", 1.7e-6 + 16 * 0x1p-24, "rad", PI * vec4(0.25, 0.75, -0.75, -0.25),
            angle(vec4(1.0, 1.0, -1.0, -1.0), vec4(1.0, -1.0, -1.0, 1.0)))
CASE("next to the diagonals", 16 * 0x1p-24, "rad",
     angle(vec4(1.0, 1.0000001, -1.0, -1.0000001), vec4(1.0000001, -1.0, -1.0000001, 1.0)))
CASE_EQUALS("nothing", 0, "rad", vec4(0.0), angle(vec4(0.0, -0.0, 0.0, -0.0), vec4(0.0)))
CASE_EQUALS("minus zero in front", 16 * 0x1p-24, "rad", vec4(0.0, PI, PI, 0.0),
            angle(vec4(-0.0, 0.0, -0.0, 0.0), vec4(1.0, -1.0, -1.0, 1.0)))
CASE("small but not denormal", 16 * 0x1p-24, "rad",
     angle(vec4(8.673617379884035e-19, 8.077935669463161e-28, -8.673617379884035e-19, 1.0),
           vec4(8.673617379884035e-19, 8.673617379884035e-19, 8.470329472543003e-22, 8.673617379884035e-19)))
CASE("large", 16 * 0x1p-24, "rad",
     angle(vec4(1.2676506002282294e+30, 1.0, -1.2676506002282294e+30, 1125899906842624.0),
           vec4(1.2676506002282294e+30, 1.2676506002282294e+30, 1.0, -1.2676506002282294e+30)))
CASE_EQUALS("infinitely far along one", 16 * 0x1p-24, "rad", vec4(0.0, PI, 0.5 * PI, -0.5 * PI),
            angle(vec4(1.0, 1.0, 1.0 / 0.0, -1.0 / 0.0), vec4(1.0 / 0.0, -1.0 / 0.0, 1.0, 1.0)))
CASE_EQUALS("30 degrees", 1.7e-6 + 24 * 0x1p-24, "rad", PI / 6.0, angle(vec4(0.5), vec4(0.8660254037844386)).x)

// ---- small_turn: five products and sums below 1 each, 6 u. Its own 3.2e-7 shows against what is known; the
// angle itself, rounded, adds 1 u.

CASE_EQUALS("45 degrees", 3.2e-7 + 7 * 0x1p-24, "", vec2(0.7071067811865476), small_turn(0.25 * PI))
CASE_EQUALS("-45 degrees", 3.2e-7 + 7 * 0x1p-24, "", vec2(-0.7071067811865476, 0.7071067811865476),
            small_turn(-0.25 * PI))
CASE_EQUALS("no turn", 0, "", vec2(0.0, 1.0), small_turn(0.0))
CASE("the smallest turn", 0, "", small_turn(8.673617379884035e-19))

// ---- meet_sphere. Of an origin at a distance L, passing and off round by 3 u L, and a way's own rounding moves
// them as much again: 6 u L. The root is off by (2 |off| 6 u L + 4 u) / (2 sqrt(inside)) besides.

CASE_EQUALS("from ahead", 0, "", vec4(0.0, 0.0, 1.0, 3.0),
            meet_sphere(vec3(0.0, 0.0, 4.0), vec3(0.0, 0.0, -1.0), 1.0, -1.0))
CASE("1e5 radii away", 8e5 * 0x1p-24, "", meet_sphere(vec3(60000.0, 80000.0, 0.0), vec3(-0.6, -0.8, 0.0), 1.0, -1.0))
CASE_EQUALS("1e5 radii away along an axis", 0x1p-7, "", vec4(0.8660254, 0.5, 0.0, 99999.134),
            meet_sphere(vec3(1e5, 0.5, 0.0), vec3(-1.0, 0.0, 0.0), 1.0, -1.0))
CASE_EQUALS("the point itself keeps its digits", 8 * 0x1p-24, "", vec3(0.8660254037844386, 0.5, 0.0),
            meet_sphere(vec3(1e5, 0.5, 0.0), vec3(-1.0, 0.0, 0.0), 1.0, -1.0).xyz)
CASE_EQUALS("touched", 0, "", vec4(0.0, 1.0, 0.0, 4.0),
            meet_sphere(vec3(4.0, 1.0, 0.0), vec3(-1.0, 0.0, 0.0), 1.0, -1.0))
CASE_EQUALS("just missed", 0, "", vec4(0.0, 0.0, 0.0, -1.0),
            meet_sphere(vec3(4.0, 1.0000001, 0.0), vec3(-1.0, 0.0, 0.0), 1.0, -1.0))
CASE_EQUALS("from on it", 0, "", vec4(0.0, 1.0, 0.0, 0.0),
            meet_sphere(vec3(0.0, 1.0, 0.0), vec3(0.0, -1.0, 0.0), 1.0, -1.0))
CASE_EQUALS("from on it outward", 0, "", vec4(0.0, -1.0, 0.0, -2.0),
            meet_sphere(vec3(0.0, 1.0, 0.0), vec3(0.0, 1.0, 0.0), 1.0, -1.0))
CASE_EQUALS("from inside out", 0, "", vec4(0.0, 0.0, 1.0, 0.5),
            meet_sphere(vec3(0.0, 0.0, 0.5), vec3(0.0, 0.0, 1.0), 1.0, 1.0))
CASE_EQUALS("not a number", 0, "", -1.0, meet_sphere(vec3(0.0 / 0.0), vec3(0.0, 0.0, 1.0), 1.0, 1.0).w)
CASE_EQUALS("along the cylinder's axis", 0, "", -1.0,
            meet_cylinder(vec3(0.5, 4.0, 0.0), vec3(0.0, -1.0, 0.0), 1.0, 2.0).w)
CASE_EQUALS("onto the cylinder's edge", 0, "", vec4(0.0, 1.0, 1.0, 3.0),
            meet_cylinder(vec3(0.0, 1.0, 4.0), vec3(0.0, 0.0, -1.0), 1.0, 2.0))
CASE_EQUALS("over the cylinder's edge", 0, "", -1.0,
            meet_cylinder(vec3(0.0, 1.0000001, 4.0), vec3(0.0, 0.0, -1.0), 1.0, 2.0).w)

// ---- Eq. 3: 8 u

CASE_EQUALS("the upper pole", 8 * 0x1p-24, "", vec2(0.5, 1.0), sphere_spot(vec3(0.0, 3.5, 0.0)).uv)
CASE_EQUALS("the lower pole", 8 * 0x1p-24, "", vec2(0.5, 0.0), sphere_spot(vec3(0.0, -3.5, 0.0)).uv)
CASE("next to the upper pole", 8 * 0x1p-24, "", sphere_spot(vec3(9.5367431640625e-07, 3.5, -4.76837158203125e-07)).uv)
CASE("next to the upper pole", 6 * 0x1p-24, "",
     sphere_spot(vec3(9.5367431640625e-07, 3.5, -4.76837158203125e-07)).theta)
CASE("next to the upper pole", 6 * 0x1p-24, "", sphere_spot(vec3(9.5367431640625e-07, 3.5, -4.76837158203125e-07)).phi)
CASE_EQUALS("theta 180", 8 * 0x1p-24, "", vec2(1.0, 0.5), sphere_spot(vec3(0.0, 0.0, -3.5)).uv)
CASE_EQUALS("theta 180 by minus zero", 8 * 0x1p-24, "", vec2(1.0, 0.5), sphere_spot(vec3(-0.0, 0.0, -3.5)).uv)
CASE("just beyond theta 180", 8 * 0x1p-24, "", sphere_spot(vec3(-1e-20, 0.0, -3.5)).uv)
CASE_EQUALS("theta 0", 8 * 0x1p-24, "", vec2(0.5), sphere_spot(vec3(0.0, -0.0, 3.5)).uv)
CASE("|OP| 1e-6", 8 * 0x1p-24, "",
     sphere_spot(vec3(9.5367431640625e-07, 4.76837158203125e-07, -2.384185791015625e-07)).uv)
CASE("|OP| 1e6", 8 * 0x1p-24, "", sphere_spot(vec3(1048576.0, 524288.0, -262144.0)).uv)
CASE("|OP| 1e-6 phi", 6 * 0x1p-24, "",
     sphere_spot(vec3(9.5367431640625e-07, 4.76837158203125e-07, -2.384185791015625e-07)).phi)
CASE_EQUALS("the cylinder's seam", 8 * 0x1p-24, "", vec2(1.0, 0.75), cylinder_spot(vec3(0.0, 0.5, -1.0), 2.0).uv)

// ---- Eq. 4 and the four neighbours, of 8 x 8 texels. A spot's uv is off by 8 u, so its place among 8 texels by
// 64 u + 4 u, which turn a column by 68 u 2 pi / 8 < 54 u; a dozen products and sums add 2 u each: 80 u |d|.

CASE_GLSL(Spot at(vec2 uv) {
    float a = (uv.x - 0.5) * 2.0 * PI, b = (uv.y - 0.5) * PI;
    return Spot(uv, vec2(sin(a), cos(a)), vec2(sin(b), cos(b)));
})
CASE_EQUALS("first column: across the seam", 0, "texel", ivec4(7, 0, 7, 0),
            around(at(vec2(0.03125, 0.5)), vec3(0.0, 0.0, 1.0), vec4(8.0), vec2(0.7071067811865476),
                   vec2(0.3826834323650898, 0.9238795325112867), 1.0).column)
CASE_EQUALS("last column: across the seam", 0, "texel", ivec4(7, 0, 7, 0),
            around(at(vec2(0.96875, 0.5)), vec3(0.0, 0.0, 1.0), vec4(8.0), vec2(0.7071067811865476),
                   vec2(0.3826834323650898, 0.9238795325112867), 1.0).column)
CASE_EQUALS("below the lowest row: half a turn on", 0, "texel", ivec4(6, 7, 2, 3),
            around(at(vec2(0.34375, 0.03125)), vec3(0.0, 0.0, 1.0), vec4(8.0), vec2(0.7071067811865476),
                   vec2(0.3826834323650898, 0.9238795325112867), 1.0).column)
CASE_EQUALS("below the lowest row", 0, "texel", ivec4(0),
            around(at(vec2(0.34375, 0.03125)), vec3(0.0, 0.0, 1.0), vec4(8.0), vec2(0.7071067811865476),
                   vec2(0.3826834323650898, 0.9238795325112867), 1.0).row)
CASE_EQUALS("above the highest row: half a turn on", 0, "texel", ivec4(2, 3, 6, 7),
            around(at(vec2(0.34375, 0.96875)), vec3(0.0, 0.0, 1.0), vec4(8.0), vec2(0.7071067811865476),
                   vec2(0.3826834323650898, 0.9238795325112867), 1.0).column)
CASE_EQUALS("a cylinder's rows end", 0, "texel", ivec4(2, 3, 2, 3),
            around(at(vec2(0.34375, 0.03125)), vec3(0.0, 0.0, 1.0), vec4(8.0), vec2(0.7071067811865476), vec2(0.0, 1.0),
                   1.0).column)
// At a pole, seen from above it, d.e_z is sin(78.75 degrees) and d.e_y its cosine, away from the point itself.
CASE_EQUALS("at the upper pole", 80 * 0x1p-24 + 7e-7, "", vec4(0.9807852804032304),
            around(sphere_spot(vec3(0.0, 1.0, 0.0)), vec3(0.0, 1.0, 0.0), vec4(8.0), vec2(0.7071067811865476),
                   vec2(0.3826834323650898, 0.9238795325112867), 1.0).z)
CASE_EQUALS("at the upper pole", 80 * 0x1p-24 + 7e-7, "", vec4(0.19509032201612825),
            around(sphere_spot(vec3(0.0, 1.0, 0.0)), vec3(0.0, 1.0, 0.0), vec4(8.0), vec2(0.7071067811865476),
                   vec2(0.3826834323650898, 0.9238795325112867), 1.0).y)
CASE("next to a pole", 80 * 0x1p-24, "",
     around(sphere_spot(vec3(9.5367431640625e-07, 1.0, -4.76837158203125e-07)), vec3(0.0, 0.0, 1.0), vec4(8.0),
            vec2(0.7071067811865476), vec2(0.3826834323650898, 0.9238795325112867), 1.0).x)
CASE("next to a pole", 80 * 0x1p-24, "",
     around(sphere_spot(vec3(9.5367431640625e-07, 1.0, -4.76837158203125e-07)), vec3(0.0, 0.0, 1.0), vec4(8.0),
            vec2(0.7071067811865476), vec2(0.3826834323650898, 0.9238795325112867), 1.0).y)
CASE("the seam", 80 * 0x1p-24, "",
     around(sphere_spot(vec3(0.0, 0.25, -1.0)), vec3(0.5, 0.5, -0.75), vec4(8.0), vec2(0.7071067811865476),
            vec2(0.3826834323650898, 0.9238795325112867), 1.0).x)
CASE("a neighbour behind the horizon", 80 * 0x1p-24, "",
     around(sphere_spot(vec3(0.0, 0.0, 1.0)), vec3(1.0, 0.0, 0.0), vec4(8.0), vec2(0.7071067811865476),
            vec2(0.3826834323650898, 0.9238795325112867), 1.0).z)
CASE("normals inward", 80 * 0x1p-24, "",
     around(sphere_spot(vec3(0.5, 0.25, 1.0)), vec3(-0.5, 0.0, -0.75), vec4(8.0), vec2(0.7071067811865476),
            vec2(0.3826834323650898, 0.9238795325112867), -1.0).z)
// Where u is on a texel's centre, float and double may take either pair of columns.
CASE_FLIP("on a texel's centre", 1, "texel",
          around(sphere_spot(vec3(0.3826834323650898, 0.1, 0.9238795325112867)), vec3(0.0, 0.0, 1.0), vec4(8.0),
                 vec2(0.7071067811865476), vec2(0.3826834323650898, 0.9238795325112867), 1.0).part.x)
CASE("the point's own frame", 12 * 0x1p-24, "", own_frame(sphere_spot(vec3(0.5, 0.25, 1.0)), vec3(0.5, 0.0, 0.75), 1.0))
CASE("grazing: d.N is 0", 12 * 0x1p-24, "", own_frame(sphere_spot(vec3(0.0, 0.0, 1.0)), vec3(0.75, 0.5, 0.0), 1.0))
CASE("grazing: d.N is 1e-7", 12 * 0x1p-24, "",
     own_frame(sphere_spot(vec3(0.0, 0.0, 1.0)), vec3(0.75, 0.5, 1.1920928955078125e-07), 1.0))
CASE("nearest at the seam", 80 * 0x1p-24, "",
     nearest(sphere_spot(vec3(0.0, 0.25, -1.0)), vec3(0.5, 0.5, -0.75), vec4(8.0),
             vec2(0.3826834323650898, 0.9238795325112867), 1.0).z)
CASE_EQUALS("nearest at the upper pole", 0, "texel", ivec4(7),
            nearest(sphere_spot(vec3(0.0, 1.0, 0.0)), vec3(0.0, 1.0, 0.0), vec4(8.0),
                    vec2(0.3826834323650898, 0.9238795325112867), 1.0).row)

// ---- Eq. 5: 8 u. The four components are four directions.

CASE_EQUALS("d along +-e_x and e_z: s is 1 and 0 and a half", 8 * 0x1p-24, "", vec4(1.0, 0.0, 0.5, 0.5),
            linear_angles(vec4(1.0, -1.0, 0.0, 0.0), vec4(0.0), vec4(0.0, 0.0, 1.0, 0.0)).s)
CASE_EQUALS("d along +-e_y: t is 1 and 0", 8 * 0x1p-24, "", vec4(1.0, 0.0, 1.0, 0.0),
            linear_angles(vec4(0.0), vec4(1.0, -1.0, 1.0, -1.0), vec4(0.0, -0.0, 0.0, 0.0)).t)
CASE_EQUALS("d perpendicular to e_x and e_z: s is a half", 8 * 0x1p-24, "", vec4(0.5),
            linear_angles(vec4(0.0), vec4(1.0, -1.0, 1.0, -1.0), vec4(0.0)).s)
CASE("grazing", 8 * 0x1p-24, "",
     linear_angles(vec4(0.75, -0.75, 0.75, -0.75), vec4(0.5),
                   vec4(0.0, 1.1920928955078125e-07, -1.1920928955078125e-07, 0.0)).s)
CASE_EQUALS("behind the horizon: s goes on beyond 1 and 0", 1.7e-6 + 8 * 0x1p-24, "", vec4(1.25, -0.25, 1.25, -0.25),
            linear_angles(vec4(0.5, -0.5, 1.0, -1.0), vec4(0.0), vec4(-0.5, -0.5, -1.0, -1.0)).s)
CASE("next to 90 degrees", 8 * 0x1p-24, "",
     linear_angles(vec4(1.0), vec4(0.0), vec4(0.0009765625, 0.000244140625, 0.0001220703125, 6.103515625e-05)).s)
CASE("t next to 90 degrees", 8 * 0x1p-24, "",
     linear_angles(vec4(0.0009765625, 0.000244140625, 0.0001220703125, 6.103515625e-05), vec4(1.0), vec4(0.0)).t)

// The same by arc sines, whose argument p is off by 4 u: near 90 degrees that is an angle of sqrt(2 * 4 u), and
// s is off by sqrt(8 u) / pi = 2.2e-4, where the arc tangent's is by 5e-7. OSMesa's asin is a polynomial
// that is off by up to 1e-4 more (empirical: 2.4e-5 of s at 45 degrees).
CASE("arc sine next to 90 degrees", 2.2e-4 + 1e-4, "",
     arcsine_angles(vec4(1.0), vec4(0.0), vec4(0.0009765625, 0.000244140625, 0.0001220703125, 6.103515625e-05)).s)
CASE("arc sine t next to 90 degrees", 2.2e-4 + 1e-4, "",
     arcsine_angles(vec4(0.0009765625, 0.000244140625, 0.0001220703125, 6.103515625e-05),
                    vec4(0.9999995, 0.99999994, 1.0, 1.0), vec4(0.0)).t)
CASE_EQUALS("arc sine behind the horizon: folded back", 1e-4, "", vec4(0.75, 0.25, 0.75, 0.25),
            arcsine_angles(vec4(0.5, -0.5, 1.0, -1.0), vec4(0.0), vec4(-0.5, -0.5, -1.0, -1.0)).s)

// The other scales: 4 u.
CASE_EQUALS("sine at the ends", 4 * 0x1p-24, "", vec4(1.0, 0.0, 1.0, 0.0),
            sine_angles(vec4(1.0, -1.0, 1.0, -1.0), vec4(0.0), vec4(0.0, 0.0, -1.0, -1.0)).s)
CASE_EQUALS("sine of d along e_y", 4 * 0x1p-24, "", vec4(0.5), sine_angles(vec4(0.0), vec4(1.0), vec4(0.0)).s)
CASE("sine", 4 * 0x1p-24, "",
     sine_angles(vec4(0.5, 0.25, -0.5, 9.5367431640625e-07), vec4(0.0), vec4(0.5, 1.0, 9.5367431640625e-07, 0.5)).s)
CASE_EQUALS("stereographic at the ends", 4 * 0x1p-24, "", vec4(1.0, 0.0, 1.0, 0.0),
            stereographic_angles(vec4(1.0, -1.0, 1.0, -1.0), vec4(0.0), vec4(0.0, 0.0, -0.5, -0.5)).s)
CASE_EQUALS("stereographic of d along e_y", 4 * 0x1p-24, "", vec4(0.5),
            stereographic_angles(vec4(0.0), vec4(1.0), vec4(0.0)).s)
CASE("stereographic", 4 * 0x1p-24, "",
     stereographic_angles(vec4(0.5, 0.25, -0.5, 9.5367431640625e-07), vec4(0.0),
                          vec4(0.5, 1.0, 9.5367431640625e-07, 0.5)).s)

// ---- Texels along s and t: clamped to the outermost centres

CASE_EQUALS("beyond both ends", 0, "texel", vec2(0.0, 15.0), among(vec2(-0.25, 1.25), vec2(16.0)))
CASE_EQUALS("at both ends", 0, "texel", vec2(0.0, 15.0), among(vec2(0.0, 1.0), vec2(16.0)))
CASE_EQUALS("on the outermost centres", 0, "texel", vec2(0.0, 15.0), among(vec2(0.03125, 0.96875), vec2(16.0)))

// ---- solids.glsl. Row 0 a ball of radius 1 at 0; row 1 an upright cylinder of radius 1/2 and height 2 at x = 4; row 2
// the same with its axis along (0.6, 0.8, 0), at y = 4; row 3 a box of 1 x 2 x 1/2 at x = -4.

CASE_TEXTURE(solids, 6, 4,
             vec4(x == 0   ? vec3(y == 0 ? 1.0 : 0.5, 1.0, y == 0 ? 1.0 : y == 3 ? 0.25 : 0.5)
                  : x == 1 ? vec3(y == 1 ? 4.0 : y == 3 ? -4.0 : 0.0, y == 2 ? 4.0 : 0.0, 0.0)
                  : x == 2 ? (y == 2 ? vec3(0.8, -0.6, 0.0) : vec3(1.0, 0.0, 0.0))
                  : x == 3 ? (y == 2 ? vec3(0.6, 0.8, 0.0) : vec3(0.0, 1.0, 0.0))
                  : x == 4 ? vec3(0.0, 0.0, 1.0)
                           : vec3(0.25 * float(y), 0.5, 0.125),
                  1.0))
CASE_GLSL(Struck nothing() { return Struck(-1.0, vec3(0.0), vec3(0.0)); })
CASE_GLSL(Struck something() { return Struck(2.0, vec3(0.0, 1.0, 0.0), vec3(0.5)); })

CASE_EQUALS("the last number of the last row", 0, "", vec3(0.75, 0.5, 0.125), solid_number(solids, 5, 3))

CASE_EQUALS("before the other", 0, "", 1.0, nearer(something(), 1.0, vec3(0.0), vec3(1.0)).depth)
CASE_EQUALS("as far as the other", 0, "", vec3(0.5), nearer(something(), 2.0, vec3(0.0), vec3(1.0)).colour)
CASE_EQUALS("behind the origin", 0, "", 2.0, nearer(something(), -1e-30, vec3(0.0), vec3(1.0)).depth)
CASE_EQUALS("at the origin", 0, "", vec3(1.0), nearer(something(), -0.0, vec3(0.0), vec3(1.0)).colour)
CASE_EQUALS("the first", 0, "", 1e10, nearer(nothing(), 1e10, vec3(0.0), vec3(1.0)).depth)
CASE_EQUALS("not a number", 0, "", 2.0, nearer(something(), 0.0 / 0.0, vec3(0.0), vec3(1.0)).depth)

// A ball from a distance L = 1000: passing and off round by 6 u L (meet_sphere), the root by (2 |off| 6 u L) / (2
// sqrt(inside)) = 3.5 u L, the depth by u L: 12 u L. Its normal adds a product and a sum at L: 14 u L.
CASE_EQUALS("from ahead", 0, "", 3.0,
            strike_sphere(nothing(), solids, 0, vec3(0.0, 0.0, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("from ahead", 0, "", vec3(0.0, 0.0, 1.0),
            strike_sphere(nothing(), solids, 0, vec3(0.0, 0.0, 4.0), vec3(0.0, 0.0, -1.0)).normal)
CASE_EQUALS("touched", 0, "", 4.0, strike_sphere(nothing(), solids, 0, vec3(4.0, 1.0, 0.0), vec3(-1.0, 0.0, 0.0)).depth)
CASE_EQUALS("touched", 0, "", vec3(0.0, 1.0, 0.0),
            strike_sphere(nothing(), solids, 0, vec3(4.0, 1.0, 0.0), vec3(-1.0, 0.0, 0.0)).normal)
CASE_EQUALS("just missed", 0, "", -1.0,
            strike_sphere(nothing(), solids, 0, vec3(4.0, 1.0000001, 0.0), vec3(-1.0, 0.0, 0.0)).depth)
CASE("1000 radii away", 12e3 * 0x1p-24, "",
     strike_sphere(nothing(), solids, 0, vec3(600.0, 800.0, 0.5), vec3(-0.6, -0.8, 0.0)).depth)
CASE("1000 radii away", 14e3 * 0x1p-24, "",
     strike_sphere(nothing(), solids, 0, vec3(600.0, 800.0, 0.5), vec3(-0.6, -0.8, 0.0)).normal)
CASE_EQUALS("from on it", 0, "", 0.0,
            strike_sphere(nothing(), solids, 0, vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("from inside", 0, "", -1.0, strike_sphere(nothing(), solids, 0, vec3(0.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("from beyond it", 0, "", -1.0,
            strike_sphere(nothing(), solids, 0, vec3(0.0, 0.0, -4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("something is nearer", 0, "", vec3(0.5),
            strike_sphere(something(), solids, 0, vec3(0.0, 0.0, 4.0), vec3(0.0, 0.0, -1.0)).colour)

CASE_EQUALS("from below", 0, "", vec2(3.0, 5.0), layer(-4.0, 1.0, 1.0))
CASE_EQUALS("from above", 0, "", vec2(3.0, 5.0), layer(4.0, -1.0, 1.0))
CASE_EQUALS("within and parallel: never entered", 0, "", 1.0, layer(0.25, 0.0, 0.5).x < -1e30)
CASE_EQUALS("within and parallel: never left", 0, "", 1.0, layer(0.25, 0.0, 0.5).y > 1e30)
CASE_EQUALS("parallel by minus zero: never entered", 0, "", 1.0, layer(0.25, -0.0, 0.5).x < -1e30)
CASE_EQUALS("parallel by minus zero: never left", 0, "", 1.0, layer(0.25, -0.0, 0.5).y > 1e30)
CASE_EQUALS("parallel outside: entered too late", 0, "", 1.0, layer(0.75, 0.0, 0.5).y < -1e30)

// Along the axis the ends alone count: depth (1 - at) / along, of at 4 u * 3 and along 3 u * 2, and its own: 20 u.
CASE_EQUALS("along its axis", 0, "", 3.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.25, 4.0, 0.0), vec3(0.0, -1.0, 0.0)).depth)
CASE_EQUALS("along its axis", 0, "", vec3(0.0, 1.0, 0.0),
            strike_cylinder(nothing(), solids, 1, vec3(4.25, 4.0, 0.0), vec3(0.0, -1.0, 0.0)).normal)
CASE_EQUALS("along its axis from below", 0, "", vec3(0.0, -1.0, 0.0),
            strike_cylinder(nothing(), solids, 1, vec3(4.25, -4.0, 0.0), vec3(0.0, 1.0, 0.0)).normal)
CASE_EQUALS("along its side", 0, "", 3.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.5, 4.0, 0.0), vec3(0.0, -1.0, 0.0)).depth)
CASE_EQUALS("along its axis beside it", 0, "", -1.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.75, 4.0, 0.0), vec3(0.0, -1.0, 0.0)).depth)
CASE_EQUALS("1e-7 off its axis: taken as parallel", 0, "", 3.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.25, 4.0, 0.0), vec3(1e-7, -1.0, 0.0)).depth)
CASE_EQUALS("2e-6 off its axis: not parallel", 0, "", 3.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.25, 4.0, 0.0), vec3(2e-6, -1.0, 0.0)).depth)
CASE_EQUALS("2e-6 off its axis from afar: not parallel", 0, "", 262144.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.75, 262145.0, 0.0), vec3(-2e-6, -1.0, 0.0)).depth)
CASE("along a slanting axis", 20 * 0x1p-24, "",
     strike_cylinder(nothing(), solids, 2, vec3(2.0, 6.25, 0.0), vec3(-0.6, -0.8, 0.0)).depth)
CASE_EQUALS("along a slanting axis", 0x1p-24, "", vec3(0.6, 0.8, 0.0),
            strike_cylinder(nothing(), solids, 2, vec3(2.0, 6.25, 0.0), vec3(-0.6, -0.8, 0.0)).normal)
// Its side, met from above: at is off by 15 u, level by 20 u, across by 5 u, a = 0.36 by 8 u, b = 2.16 by 36 u, the
// root by 5 u: (36 + 5 + 2) u / a + 5.17 * 8 u / a = 234 u.
CASE_EQUALS("onto a slanting side", 240 * 0x1p-24, "", 5.166666666666667,
            strike_cylinder(nothing(), solids, 2, vec3(0.0, 10.0, 0.0), vec3(0.0, -1.0, 0.0)).depth)
CASE_EQUALS("touched", 0, "", 4.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.5, 0.0, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("touched", 0, "", vec3(1.0, 0.0, 0.0),
            strike_cylinder(nothing(), solids, 1, vec3(4.5, 0.0, 4.0), vec3(0.0, 0.0, -1.0)).normal)
CASE_EQUALS("just missed", 0, "", -1.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.5000005, 0.0, 4.0), vec3(0.0, 0.0, -1.0)).depth)
// In the plane of an end: it may be met, or not, but nothing else may come of it.
CASE_FLIP("in an end's plane", 3.5 + 1.0, "",
          strike_cylinder(nothing(), solids, 1, vec3(4.0, 1.0, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("just below an end's plane", 0, "", 3.5,
            strike_cylinder(nothing(), solids, 1, vec3(4.0, 0.9999999, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("just above an end's plane", 0, "", -1.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.0, 1.0000001, 4.0), vec3(0.0, 0.0, -1.0)).depth)
// Where the side and an end are entered at once: b is off by 3 u * 2.5, a = 1/2 by 3 u: 40 u of a depth of 4.2.
CASE("onto its rim", 40 * 0x1p-24, "",
     strike_cylinder(nothing(), solids, 1, vec3(4.0, 4.0, 3.5),
                     vec3(0.0, -0.7071067811865476, -0.7071067811865476)).depth)
// L = 1000: a and b are off by 4 u and 2 u of themselves, their quotient by 8 u L; the normal has that twice, and a
// product and a sum at L, over the radius 1/2: 20 u L.
CASE("1000 away", 8e3 * 0x1p-24, "",
     strike_cylinder(nothing(), solids, 1, vec3(4.25, 600.0, 800.0), vec3(0.0, -0.6, -0.8)).depth)
CASE("1000 away", 20e3 * 0x1p-24, "",
     strike_cylinder(nothing(), solids, 1, vec3(4.25, 600.0, 800.0), vec3(0.0, -0.6, -0.8)).normal)
CASE_EQUALS("from inside", 0, "", -1.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("from beyond it", 0, "", -1.0,
            strike_cylinder(nothing(), solids, 1, vec3(4.0, 0.0, -4.0), vec3(0.0, 0.0, -1.0)).depth)

// A layer's depth rounds by 3 u of itself, its ray's way besides by 1 u.
CASE_EQUALS("onto a face", 0, "", 3.75,
            strike_box(nothing(), solids, 3, vec3(-4.25, 0.25, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("onto a face", 0, "", vec3(0.0, 0.0, 1.0),
            strike_box(nothing(), solids, 3, vec3(-4.25, 0.25, 4.0), vec3(0.0, 0.0, -1.0)).normal)
CASE_EQUALS("the same by minus zero", 0, "", 3.75,
            strike_box(nothing(), solids, 3, vec3(-4.25, 0.25, 4.0), vec3(-0.0, -0.0, -1.0)).depth)
CASE_EQUALS("from the left", 0, "", vec3(-1.0, 0.0, 0.0),
            strike_box(nothing(), solids, 3, vec3(-8.0, 0.25, 0.125), vec3(1.0, 0.0, 0.0)).normal)
CASE_EQUALS("from above", 0, "", vec3(0.0, 1.0, 0.0),
            strike_box(nothing(), solids, 3, vec3(-4.0, 8.0, 0.125), vec3(0.0, -1.0, 0.0)).normal)
CASE_FLIP("in a face's plane", 3.75 + 1.0, "",
          strike_box(nothing(), solids, 3, vec3(-3.5, 0.25, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_FLIP("along an edge", 3.75 + 1.0, "",
          strike_box(nothing(), solids, 3, vec3(-3.5, 1.0, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("just inside a face's plane", 0, "", 3.75,
            strike_box(nothing(), solids, 3, vec3(-3.5000002, 0.25, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("just outside a face's plane", 0, "", -1.0,
            strike_box(nothing(), solids, 3, vec3(-3.4999998, 0.25, 4.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("onto a corner", 5.2 * 4 * 0x1p-24, "", 5.196152422706632,
            strike_box(nothing(), solids, 3, vec3(-0.5, 4.0, 3.25), vec3(-0.5773502691896258)).depth)
CASE("1000 away", 4e3 * 0x1p-24, "",
     strike_box(nothing(), solids, 3, vec3(-4.0, 600.0, 800.0), vec3(0.0, -0.6, -0.8)).depth)
CASE_EQUALS("from inside", 0, "", -1.0,
            strike_box(nothing(), solids, 3, vec3(-4.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("from beyond it", 0, "", -1.0,
            strike_box(nothing(), solids, 3, vec3(-4.0, 0.0, -4.0), vec3(0.0, 0.0, -1.0)).depth)

CASE_EQUALS("the box before the ball and the cylinder", 0, "", vec3(0.75, 0.5, 0.125),
            strike(solids, ivec3(1, 3, 4), vec3(-10.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0)).colour)
CASE_EQUALS("the cylinder before the ball and the box", 0, "", vec3(0.25, 0.5, 0.125),
            strike(solids, ivec3(1, 3, 4), vec3(10.0, 0.0, 0.0), vec3(-1.0, 0.0, 0.0)).colour)
CASE_EQUALS("from between them", 0, "", 1.0,
            strike(solids, ivec3(1, 3, 4), vec3(-2.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0)).depth)
CASE_EQUALS("the second cylinder", 0, "", vec3(0.5, 0.5, 0.125),
            strike(solids, ivec3(1, 3, 4), vec3(0.0, 10.0, 0.0), vec3(0.0, -1.0, 0.0)).colour)
CASE_EQUALS("from beyond everything", 0, "", -1.0,
            strike(solids, ivec3(1, 3, 4), vec3(0.0, 0.0, 10.0), vec3(0.0, 0.0, 1.0)).depth)
CASE_EQUALS("past the ball: no cylinder or box is there", 0, "", -1.0,
            strike(solids, ivec3(1, 3, 4), vec3(0.875, 0.875, 10.0), vec3(0.0, 0.0, -1.0)).depth)
CASE_EQUALS("past the cylinder: no box is there", 0, "", -1.0,
            strike(solids, ivec3(1, 3, 4), vec3(4.375, 10.0, 0.375), vec3(0.0, -1.0, 0.0)).depth)
CASE_EQUALS("no solids", 0, "", -1.0, strike(solids, ivec3(0), vec3(0.0, 0.0, 10.0), vec3(0.0, 0.0, -1.0)).depth)

// phong: eight operations below 1. Its power multiplies the 5 u of shine by 32, of 0.3: 48 u. pow is exp2(y log2 x) in
// OpenGL, and log2 is granted 2^-20, as OSMesa's polynomials have it: 0.3 * 32 ln 2 2^-20 = 6.4e-6.
CASE_EQUALS("light along the surface", 0x1p-24, "", vec3(0.15, 0.075, 0.0375),
            phong(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0)))
CASE_EQUALS("light from behind", 0x1p-24, "", vec3(0.15, 0.075, 0.0375),
            phong(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0), vec3(0.0, 0.0, -1.0)))
CASE_EQUALS("light and normal and eye are one", 8 * 0x1p-24 + 6.4e-6, "", vec3(1.0, 0.65, 0.475),
            phong(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, -1.0)))
CASE_EQUALS("mirrored exactly", 56 * 0x1p-24 + 6.4e-6, "",
            vec3(0.8389087296526012, 0.5694543648263006, 0.4347271824131503),
            phong(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(0.7071067811865476, 0.0, 0.7071067811865476),
                  vec3(0.7071067811865476, 0.0, -0.7071067811865476)))
CASE_EQUALS("mirrored behind the eye", 2 * 0x1p-24, "", vec3(0.7, 0.35, 0.175),
            phong(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0)))
CASE("the light has just risen", 56 * 0x1p-24 + 6.4e-6, "",
     phong(vec3(1.0, 0.5, 0.25), vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 1.1920928955078125e-07),
           vec3(1.0, 0.0, -1.1920928955078125e-07)))
CASE_EQUALS("a highlight's slope: 0.96^32", 56 * 0x1p-24 + 6.4e-6, "",
            vec3(0.5612457612004255, 0.3212457612004254, 0.2012457612004254),
            phong(vec3(1.0, 0.5, 0.25), vec3(0.6, 0.0, 0.8), vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, -1.0)))
