#include "march.inc"

float search(HeightRay ray) { return occlusion(height_map, ray, steps()); }
