// The surface between texel centres: cells, each a bilinear patch between four heights. What the searches that find
// the exact hit share.
#include "ray.glsl"

// A ray in cells: at t it is at start + t way, where cell (i, j) is i..i+1 by j..j+1 and has the centres of the texels
// (i, j), (i+1, j), (i, j+1), (i+1, j+1) of the repeated map for its corners.
struct CellRay {
    vec2 size;        // of the map
    vec2 start, way;
    vec2 ahead;       // start, moved on by more than rounding errs
    vec2 far;         // the side at which it leaves a cell or a block: 1 or 0
    vec2 t_per_cell;  // along x alone and along y alone
};

CellRay cell_ray(sampler2D corner_map, HeightRay ray) {
    vec2 size = vec2(textureSize(corner_map, 0));
    vec2 start = size * ray.top - 0.5, way = size * ray.across;
    vec2 slack = 0.000004 * (size + abs(way));
    vec2 far = vec2(way.x < 0.0 ? 0.0 : 1.0, way.y < 0.0 ? 0.0 : 1.0);
    vec2 rate = vec2(abs(way.x) < 1e-20 ? 1e-20 : way.x, abs(way.y) < 1e-20 ? 1e-20 : way.y); // so it never leaves
    return CellRay(size, start, way, start + slack * sign(way), far, 1.0 / rate);
}

// The cell that the ray is in at t, and on a border the one that it comes to.
vec2 cell_at(CellRay ray, float t) { return floor(ray.ahead + t * ray.way); }

// How many whole maps, in cells, lie before a cell: the map repeats.
vec2 cell_turns(CellRay ray, vec2 cell) { return ray.size * floor((cell + 0.5) / ray.size); }

// When the ray leaves a block of that side whose near corner is at corner.
float leaving_time(CellRay ray, vec2 corner, vec2 side) {
    vec2 t = (corner + ray.far * side - ray.start) * ray.t_per_cell;
    return min(t.x, t.y);
}

// The smallest s > 0 at which above + slope s + curve s^2 falls to 0, for above >= 0; negative, infinite or not a
// number where there is none. Without cancellation: w is the one of (-slope +- root) / 2 in which both have one
// sign, and the roots are above / w and w / curve (their product is above / curve).
float falling_root(float above, float slope, float curve) {
    float root = sqrt(slope * slope - 4.0 * curve * above);
    float w = 0.5 * (slope < 0.0 ? root - slope : -root - slope);
    return slope < 0.0 ? above / w : w / curve;
}

// A patch is c0 + c1 a + c2 b + c3 a b, with a and b from the cell's near corner; its corners' heights come as h00,
// h10, h01, h11.
vec4 patch_terms(vec4 corners) {
    vec2 rise = vec2(corners.y, corners.z) - corners.x;
    return vec4(corners.x, rise.x, rise.y, corners.w - corners.y - rise.y);
}

// How far the ray at t is above the patch of a cell.
float patch_clearance(CellRay ray, vec2 cell, vec4 c, float t) {
    vec2 at = ray.start + t * ray.way - cell;
    return 1.0 - t - (c.x + c.y * at.x + c.z * at.y + c.w * at.x * at.y);
}

// The first t in from..to at which the ray is at or below the patch, or a negative number. Along a line the patch is
// quadratic.
float patch_hit(CellRay ray, vec2 cell, vec4 c, float from, float to) {
    float above = patch_clearance(ray, cell, c, from);
    if (above <= 0.0) return from;
    vec2 at = ray.start + from * ray.way - cell;
    float slope = -1.0 - (c.y * ray.way.x + c.z * ray.way.y + c.w * (at.x * ray.way.y + at.y * ray.way.x));
    float s = falling_root(above, slope, -c.w * ray.way.x * ray.way.y);
    return s >= 0.0 && s <= to - from ? from + s : -1.0;
}
