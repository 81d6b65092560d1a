// knob x knob bilinear taps over the footprint.
#include "floor.inc"

uniform sampler2D image;
uniform float knob; // how many taps along each side

void main() {
    Footprint f = floor_footprint();
    floor_write(f, area(image, f.uv, f.dx, f.dy, int(knob)));
}
