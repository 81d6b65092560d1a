// The texture as it lies on the polygon.
#include "polygon.inc"

void main() { show(uv); }
