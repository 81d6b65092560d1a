// A light-field texture T(u, v, s, t) (Gonçalves Dias and Zuffo 2024): where a ray meets the model, and with which
// angles each of the four texels around that point sees the eye. `count` is the texels along u, v, s, t; d is the unit
// vector toward the eye. Four neighbours are one vec4: lower left, lower right, upper left, upper right.

const float PI = 3.14159265358979323846;

// The angle of (x, y), as atan(y, x) has it: -pi..pi, and 0 for (0, 0). Within 45 degrees of the x axis it is an odd
// polynomial of y / x, the best of eleventh degree on -1..1 by Remez's algorithm, and never off by more than 1.7e-6;
// the rest by symmetry.
vec4 angle(vec4 y, vec4 x) {
    vec4 across = abs(x), up = abs(y);
    vec4 z = min(across, up) / max(max(across, up), vec4(1e-30)), q = z * z;
    vec4 a = z * (0.999977219 + q * (-0.332622828 + q * (0.193540379 + q * (-0.116426488 + q * (0.0526473579
           + q * -0.0117191382)))));
    a = mix(a, 0.5 * PI - a, greaterThan(up, across));
    a = mix(a, PI - a, lessThan(x, vec4(0.0)));
    return mix(a, -a, lessThan(y, vec4(0.0)));
}

// Sine and cosine of the sum of two angles, given by theirs.
vec2 turned(vec2 a, vec2 b) { return vec2(a.x * b.y + a.y * b.x, a.y * b.y - a.x * b.x); }

// Sine and cosine of an angle within 45 degrees, by their series; off by no more than 3.2e-7.
vec2 small_turn(float a) {
    float q = a * a;
    return vec2(a * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0)))),
                1.0 - q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0 - q * (1.0 / 40320.0)))));
}

// ---- Where a ray meets the model: the point, and w its distance, negative where it is missed ----

// A sphere around the origin: seen from outside at the nearer crossing (side -1), from inside at the other (1). What is
// under the root is written by the ray's distance from the centre, so it does not cancel far away.
vec4 meet_sphere(vec3 origin, vec3 way, float radius, float side) {
    float passing = -dot(origin, way);
    vec3 off = origin + passing * way;
    float inside = radius * radius - dot(off, off);
    if (!(inside >= 0.0)) return vec4(0.0, 0.0, 0.0, -1.0);
    float depth = passing + side * sqrt(inside);
    return vec4(off + (side * sqrt(inside)) * way, depth);
}

// The side of a cylinder around the y axis, from outside.
vec4 meet_cylinder(vec3 origin, vec3 way, float radius, float height) {
    vec2 from = vec2(origin.x, origin.z), along = vec2(way.x, way.z);
    float a = dot(along, along), c = from.x * along.y - from.y * along.x;
    float inside = a * radius * radius - c * c;
    if (!(inside >= 0.0 && a > 0.0)) return vec4(0.0, 0.0, 0.0, -1.0);
    float depth = (-dot(from, along) - sqrt(inside)) / a;
    vec3 at = origin + depth * way;
    if (abs(at.y) > 0.5 * height) return vec4(0.0, 0.0, 0.0, -1.0);
    return vec4(at, depth);
}

// ---- A point of the model: (u, v), and sine and cosine of theta (from +z toward +x) and phi (above the xz plane) ----

struct Spot {
    vec2 uv, theta, phi;
};

// Eq. 3, with the arc sine of Py / |OP| as atan2(Py, hypot(Px, Pz)): near the poles an arc sine has lost half its
// digits. At a pole itself theta is 0, so that u is 1/2.
Spot sphere_spot(vec3 p) {
    float level = length(vec2(p.x, p.z)), far = length(p);
    vec2 theta = level > 0.0 ? vec2(p.x, p.z) / level : vec2(0.0, 1.0);
    vec4 a = angle(vec4(p.x, p.y, 0.0, 0.0), vec4(p.z, level, 1.0, 1.0));
    return Spot(vec2(0.5 + a.x / (2.0 * PI), 0.5 + a.y / PI), theta, vec2(p.y, level) / far);
}

Spot cylinder_spot(vec3 p, float height) {
    float level = length(vec2(p.x, p.z));
    vec4 a = angle(vec4(p.x), vec4(p.z));
    return Spot(vec2(0.5 + a.x / (2.0 * PI), 0.5 + p.y / height), vec2(p.x, p.z) / level, vec2(0.0, 1.0));
}

// ---- The four texels around it ----

struct Around {
    ivec4 column, row; // texels of u and v
    vec2 part;         // how far the point is from the lower left one, in texels
    vec4 x, y, z;      // d . e_x, d . e_y, d . e_z (Eq. 4) in the frame of each
};

// The frames themselves are never made. With a = d.x cos(theta) - d.z sin(theta) and b = d.x sin(theta) + d.z cos(theta),
//     d.e_x = a,   d.e_y = d.y cos(phi) - b sin(phi),   d.e_z = b cos(phi) + d.y sin(phi),
// so a column needs one pair a, b and a row one sine and cosine: those of the spot turned by a part of a texel, and the
// next by a whole one. Beyond a pole is the same row half a turn on, whose e_x and e_y point the other way: there the
// turned cosine is negative. step_theta and step_phi: sine and cosine of a texel's angle (0, 1 where rows do not turn).
// facing -1: normals point inward.
Around around(Spot spot, vec3 d, vec4 count, vec2 step_theta, vec2 step_phi, float facing) {
    vec2 texel = spot.uv * vec2(count.xy) - 0.5, first = floor(texel), part = texel - first;
    float a = d.x * spot.theta.y - d.z * spot.theta.x, b = d.x * spot.theta.x + d.z * spot.theta.y;
    vec2 left = turned(vec2(a, b), small_turn(part.x * 2.0 * PI / count.x));
    vec2 right = turned(left, vec2(-step_theta.x, step_theta.y));
    bool turns = step_phi.x != 0.0;
    vec2 low = turns ? turned(spot.phi, small_turn(-part.y * PI / count.y)) : spot.phi;
    vec2 high = turned(low, step_phi);
    vec4 as = vec4(left.x, right.x, left.x, right.x), bs = vec4(left.y, right.y, left.y, right.y);
    vec4 sine = vec4(low.x, low.x, high.x, high.x), cosine = vec4(low.y, low.y, high.y, high.y);
    vec4 over = mix(vec4(1.0), vec4(-1.0), lessThan(cosine, vec4(0.0)));
    int columns = int(count.x), rows = int(count.y), c = int(first.x), r = int(first.y);
    ivec2 at = ivec2(c < 0 ? c + columns : c, c + 1 < columns ? c + 1 : 0);
    ivec2 beyond = turns ? (ivec2(at) + columns / 2) % columns : at;
    ivec2 below = r < 0 ? beyond : at, above = r + 1 < rows ? at : beyond;
    ivec2 row = ivec2(max(r, 0), min(r + 1, rows - 1));
    return Around(ivec4(below.x, below.y, above.x, above.y), ivec4(row.x, row.x, row.y, row.y), part,
                  as * (over * facing), (d.y * cosine - bs * sine) * over, (bs * cosine + d.y * sine) * facing);
}

// d . e_x, d . e_y, d . e_z in the frame of the spot itself.
vec3 own_frame(Spot spot, vec3 d, float facing) {
    float a = d.x * spot.theta.y - d.z * spot.theta.x, b = d.x * spot.theta.x + d.z * spot.theta.y;
    return vec3(a * facing, d.y * spot.phi.y - b * spot.phi.x, (b * spot.phi.y + d.y * spot.phi.x) * facing);
}

// The texel that holds the spot, four times, with its own frame: `around` with nothing between texels.
Around nearest(Spot spot, vec3 d, vec4 count, vec2 step_phi, float facing) {
    vec2 texel = min(floor(spot.uv * vec2(count.xy)), vec2(count.xy) - 1.0);
    vec2 aside = texel + 0.5 - spot.uv * vec2(count.xy);
    vec2 theta = turned(spot.theta, small_turn(aside.x * 2.0 * PI / count.x));
    vec2 phi = step_phi.x != 0.0 ? turned(spot.phi, small_turn(aside.y * PI / count.y)) : spot.phi;
    vec3 own = own_frame(Spot(spot.uv, theta, phi), d, facing);
    return Around(ivec4(int(texel.x)), ivec4(int(texel.y)), vec2(0.0), vec4(own.x), vec4(own.y), vec4(own.z));
}

// ---- Eq. 5: from d in a frame to s and t ----

struct Angles {
    vec4 s, t;
};

// The paper's: angles divided by 180 degrees. Where d.e_z < 0, behind the neighbour's horizon, s is beyond 0..1.
Angles linear_angles(vec4 x, vec4 y, vec4 z) {
    return Angles(0.5 + angle(x, z) / PI, 0.5 + angle(y, sqrt(x * x + z * z)) / PI);
}

// The same with the arc sines of Eq. 5, for comparison: behind the horizon they fold s back, and near 90 degrees
// rounding has cost them half their digits.
Angles arcsine_angles(vec4 x, vec4 y, vec4 z) {
    vec4 p = x / max(sqrt(x * x + z * z), vec4(1e-30));
    return Angles(0.5 + asin(clamp(p, -1.0, 1.0)) / PI, 0.5 + asin(clamp(y, -1.0, 1.0)) / PI);
}

// Their sines in place of the angles: no arc function at all, and finer around the normal.
Angles sine_angles(vec4 x, vec4 y, vec4 z) {
    vec4 p = x / max(sqrt(x * x + z * z), vec4(1e-30));
    p = mix(p, sign(x), lessThan(z, vec4(0.0)));
    return Angles(0.5 + 0.5 * p, 0.5 + 0.5 * y);
}

// The tangents of half of them: tan(a/2) = sin a / (1 + cos a).
Angles stereographic_angles(vec4 x, vec4 y, vec4 z) {
    vec4 level = sqrt(x * x + z * z);
    vec4 p = clamp(x / max(level + z, vec4(1e-30)), -1.0, 1.0);
    return Angles(0.5 + 0.5 * p, 0.5 + 0.5 * y / (1.0 + level));
}

// ---- Texels along s and t ----

// Where among the centres of n texels: 0..n - 1, clamped to the outermost.
vec2 among(vec2 angles, vec2 n) { return clamp(angles * n - 0.5, vec2(0.0), n - 1.0); }
