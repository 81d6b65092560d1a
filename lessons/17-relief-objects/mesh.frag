// The object as triangles. What is a tangent elsewhere holds the colour here; w: 1 for the bunny.
#include "light.glsl"
#include "pattern.glsl"

in vec3 position, normal;
in vec4 tangent;

uniform vec4 eye, light;

layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 lookup;

void main() {
    vec3 toward = eye.xyz - eye.w * position;
    vec3 own = tangent.w > 0.5 ? bunny_tone(position) : toy_tone(position) * tangent.xyz;
    colour = vec4(lit(own, normalize(normal), light.xyz, normalize(toward)), 1.0);
    lookup = vec4(0.0, 0.0, 0.0, 1.0); // for the silhouette
}
