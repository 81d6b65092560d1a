#include "cut.inc"
#include "maximum.glsl"

uniform sampler2D pyramid_map, corner_map;

float search(HeightRay ray) { return maximum(pyramid_map, corner_map, ray); }
