#include "march.inc"
#include "cone.glsl"

uniform sampler2D cone_map, corner_map;

float search(HeightRay ray) { return cone(cone_map, corner_map, ray, steps()); }
