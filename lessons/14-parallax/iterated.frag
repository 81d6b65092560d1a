#include "parallax.glsl"
#include "polygon.inc"

uniform float knob;

void main() {
    show(iterated(uv, height_map, scale, base, view_tangents(pixel_view()), aspect, int(knob)));
}
