#include "march.inc"

float search(HeightRay ray) { return relief(height_map, ray, steps(), 6); }
