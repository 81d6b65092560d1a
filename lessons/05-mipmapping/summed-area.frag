// The mean over the footprint's bounding box.
#include "floor.inc"
#include "summed-area.glsl"

uniform sampler2D high, low; // the summed-area table; low is black where it is the naive one

void main() {
    Footprint f = floor_footprint();
    floor_write(f, summed_area(high, low, f.uv, f.dx, f.dy));
}
