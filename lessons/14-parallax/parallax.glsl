// Parallax mapping (Kaneko et al. 2001) and what came of it, in the terms of polygon.glsl: d is the displacement
// along the normal, in texture widths, and results are texture coordinates.
#include "polygon.glsl"

// Where the eye sees the point that lies d above (u, v): u' = u + M00 d, v' = v + M11 d (the paper
// calls both d's du and dv), for the same tangents over the whole polygon or for each pixel's own.
vec2 parallax(vec2 uv, float d, vec2 tangents, float aspect) {
    return uv + d * vec2(tangents.x, tangents.y / aspect);
}

// Welsh 2004: without the division by view.z the shift is at most d, whatever the angle.
vec2 offset_limit(vec2 uv, float d, vec3 view, float aspect) {
    return uv + d * vec2(view.x, view.y / aspect);
}

// depth(u, v) = depth(u', v') is what the paper assumes. Asking for the depth again at u' repairs it where
// tan(theta) max|grad d| < 1, for there each step brings u' nearer to the ray's true point.
vec2 iterated(vec2 uv, sampler2D height_map, float scale, float base, vec2 tangents, float aspect, int steps) {
    vec2 shifted = uv;
    for (int i = 0; i < steps; i++) {
        float d = displacement(textureLod(height_map, shifted, 0.0).x, scale, base);
        shifted = parallax(uv, d, tangents, aspect);
    }
    return shifted;
}
