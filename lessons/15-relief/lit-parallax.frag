#include "lit.inc"

float search(HeightRay ray) { return parallax(height_map, ray, base); }
