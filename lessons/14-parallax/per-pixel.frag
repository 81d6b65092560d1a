// Each pixel's own view vector.
#include "parallax.glsl"
#include "polygon.inc"

void main() { show(parallax(uv, depth_at(uv), view_tangents(pixel_view()), aspect)); }
