// Reads the height and then the colour, unshifted: `nothing` is 0, which the compiler cannot know.
#include "polygon.inc"

uniform float nothing;

void main() { show(uv + nothing * depth_at(uv)); }
