// Section 3.3: the whole shift (u' - u, v' - v) was built in C for this view; it is only read and added.
#include "polygon.inc"

uniform sampler2D distortion_map;

void main() { show(uv + vec2(textureLod(distortion_map, uv, 0.0).xy)); }
