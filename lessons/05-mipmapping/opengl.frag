// The chain of glGenerateMipmap, and the driver's own choice of level.
#include "floor.inc"

uniform sampler2D image;

void main() {
    Footprint f = floor_footprint();
    floor_write(f, texture(image, f.uv)); // derivatives are differences inside a block of 2x2 pixels
}
