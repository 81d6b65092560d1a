// Four texels around the pixel's centre, however many the pixel covers.
#include "floor.inc"

uniform sampler2D image;

void main() {
    Footprint f = floor_footprint();
    floor_write(f, bilinear(image, f.uv));
}
