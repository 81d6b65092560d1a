// A fetch of a table for each of the four places, and a leaf for each of the sixteen texels.
#include "field.inc"
#include "ramp.glsl"

uniform usampler2D table, leaves;
uniform vec4 across; // blocks along u, v, s, t

#define OWN_ANGULAR
vec3 angular(int column, int row, vec2 angles) {
    vec2 at = among(angles, count.zw), first = min(floor(at), count.zw - 2.0);
    return ramp_four(table, leaves, ivec4(column, row, ivec2(first)), at - first, ivec2(across.zw));
}

#include "taps.inc"
#include "shown.inc"
