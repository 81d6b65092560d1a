// Parallax mapping (Kaneko et al. 2001) and what came of it. In the polygon's own frame x = +u, y = +v, z = the
// normal, `view` points from the polygon toward the eye, d is the displacement along the normal and aspect is the
// texture's height over its width. Displacements are in texture widths, results in texture coordinates.

// The displacement of a stored height 0..1: base is the height at which the polygon lies.
float displacement(float height, float scale, float base) { return scale * (height - base); }

// The world's vector in the polygon's frame; handedness is the tangent's w, +1 or -1.
vec3 to_polygon(vec3 v, vec3 normal, vec3 tangent, float handedness) {
    vec3 bitangent = handedness * cross(normal, tangent);
    return vec3(dot(v, tangent), dot(v, bitangent), dot(v, normal));
}

// The tangents of the angles from the normal to the unit view, along u and along v: M00 and M11 of the paper's
// matrix M. A view in the polygon's plane or behind it has no such angle and shifts nothing. Below 1e-6 no bit of
// view.z is left but its rounding, so that is the plane too; hence no tangent is larger than 1e6.
vec2 view_tangents(vec3 view) {
    if (!(view.z > 1e-6)) return vec2(0.0);
    return vec2(view.xy) / view.z;
}

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
