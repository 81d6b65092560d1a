// The texel under the pixel's centre.
#include "floor.inc"

uniform sampler2D image;

void main() {
    Footprint f = floor_footprint();
    floor_write(f, nearest(image, f.uv));
}
