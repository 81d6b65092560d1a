#include "march.inc"

float search(HeightRay ray) { return relief(height_map, ray, int(knob), 6); }
