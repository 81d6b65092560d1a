// Two levels of the chain, mixed. Which filter built the chain is the texture's own business.
#include "floor.inc"

uniform sampler2D image; // with its chain

void main() {
    Footprint f = floor_footprint();
    vec2 size = vec2(textureSize(image, 0));
    float level = level_of_detail(f.dx * size, f.dy * size, last_level(image));
    floor_write(f, trilinear(image, f.uv, level));
}
