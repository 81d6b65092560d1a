// The surface between texel centres: each cell is a bilinear patch between four heights. Where a ray meets it, and its
// normal.
#include "cells.glsl"

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

// The unit normal of the surface at uv: of the bilinear patch between the four texel centres around it.
vec3 patch_normal(sampler2D height_map, vec2 uv, float scale, float aspect) {
    ivec2 size = textureSize(height_map, 0);
    vec2 at = uv * vec2(size) - 0.5, corner = floor(at), inside = at - corner;
    ivec2 low = ivec2(mod(corner, vec2(size))), high = ivec2(mod(corner + 1.0, vec2(size)));
    float h00 = texelFetch(height_map, low, 0).x, h11 = texelFetch(height_map, high, 0).x;
    float h10 = texelFetch(height_map, ivec2(high.x, low.y), 0).x;
    float h01 = texelFetch(height_map, ivec2(low.x, high.y), 0).x;
    vec2 slope = vec2(mix(h10 - h00, h11 - h01, inside.y), mix(h01 - h00, h11 - h10, inside.x)) * vec2(size);
    return normalize(vec3(-scale * slope.x, -scale * slope.y / aspect, 1.0));
}
