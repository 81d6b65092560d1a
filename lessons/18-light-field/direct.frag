// The scene itself, by rays: no light field at all.
#include "field.inc"
#include "solids.glsl"

uniform sampler2D solids;
uniform vec4 kinds, light;

void main() {
    Seen seen = see_model();
    vec3 eye = pixel_ray().origin;
    Struck first = strike(solids, ivec3(kinds.xyz), eye, seen.way);
    show(first.depth < 0.0 ? vec3(0.0) : phong(first.colour, first.normal, light.xyz, seen.way), seen);
}
