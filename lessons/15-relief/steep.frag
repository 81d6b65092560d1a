#include "march.inc"

float search(HeightRay ray) { return steep(height_map, ray, steps()); }
