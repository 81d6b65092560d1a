#include "parallax.glsl"
#include "polygon.inc"

void main() { show(offset_limit(uv, depth_at(uv), pixel_view(), aspect)); }
