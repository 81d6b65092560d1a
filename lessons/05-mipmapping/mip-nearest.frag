// One level of the chain: it changes at a visible line.
#include "floor.inc"

uniform sampler2D image; // with its chain

void main() {
    Footprint f = floor_footprint();
    vec2 size = vec2(textureSize(image, 0));
    float level = level_of_detail(f.dx * size, f.dy * size, last_level(image));
    floor_write(f, mip_nearest(image, f.uv, level));
}
