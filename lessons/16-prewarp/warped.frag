// A warped texture on its polygon, lit. Less than half a texel of it is nothing: a hole, or beyond an edge.
#include "warped.glsl"

in vec2 uv;

uniform sampler2D colour_map, normal_map, lookup_map;
uniform vec4 light; // the direction toward it; w: what comes from everywhere
uniform int looking;
uniform vec4 eye;
uniform float eye_plane, scale, base, aspect;
uniform vec4 near;

layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 lookup;

// u, v, and how far the eye is from that point of the relief.
vec4 looked_up() {
    vec4 from = landed_lookup(colour_map, lookup_map, uv, near.xy);
    vec3 point = landed_point(vec3(from.xyz), scale, base, aspect);
    float depth = eye.w > 0.0 ? length(eye.xyz - point) : eye_plane - dot(point, eye.xyz);
    return vec4(from.xy, depth, 1.0);
}

void main() {
    vec4 texel = textureLod(colour_map, uv, 0.0);
    if (texel.a < 0.5) discard;
    vec3 normal = landed_normal(textureLod(normal_map, uv, 0.0));
    colour = vec4(lit(landed_colour(texel), normal, light.xyz, light.w), 1.0);
    lookup = looking == 1 ? looked_up() : vec4(0.0);
}
