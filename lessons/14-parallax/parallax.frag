// The paper's form: M, the tangents of the view at the polygon's middle, serves all its pixels.
#include "parallax.glsl"
#include "polygon.inc"

uniform vec4 tangents;

void main() { show(parallax(uv, depth_at(uv), vec2(tangents.xy), aspect)); }
