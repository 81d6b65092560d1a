// As paper.frag; and in magenta what is wrong in principle: where the light of a texel comes from behind the eye. A light
// field says what leaves the model in a direction; what lies in front of the model is on it too, as an eye beyond sees it.
#include "field.inc"
#include "pages.inc"
#include "taps.inc"
#include "solids.glsl"

uniform sampler2D solids;
uniform vec4 kinds;

void main() {
    Seen seen = see_model();
    Around near = around_spot(seen.spot, -seen.way);
    vec3 light = sixteen_taps(near, linear_angles(near.x, near.y, near.z));
    const float beyond = 20.0; // farther than anything is
    Struck recorded = strike(solids, ivec3(kinds.xyz), pixel_ray().origin - beyond * seen.way, seen.way);
    bool behind = recorded.depth >= 0.0 && recorded.depth < beyond;
    show(behind ? mix(light, vec3(1.0, 0.0, 1.0), 0.7) : light, seen);
}
