// A polygon with a height for each texel. In its own frame x = +u, y = +v, z = the normal, `view` points from the
// polygon toward the eye, and aspect is the texture's height over its width. Displacements are in texture widths.

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
