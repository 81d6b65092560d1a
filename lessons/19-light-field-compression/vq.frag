// Two fetches a texel: the number of a code, and the texel in it.
#include "field.inc"
#include "vq.glsl"

uniform usampler2D codes;
uniform sampler2D book;
uniform vec4 across; // blocks along u, v, s, t

vec3 texel(ivec4 at) { return vq_light(codes, book, at, ivec2(across.zw)); }

#include "taps.inc"
#include "shown.inc"
