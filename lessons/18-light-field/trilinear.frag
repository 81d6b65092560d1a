// One picture of the model, whatever it is seen from, through a mipmap: what costs are held against.
#include "field.inc"

uniform sampler2D plain;
uniform float pixel; // what a pixel covers at unit distance

void main() {
    Seen seen = see_model();
    vec3 normal = -window.z * normalize(seen.at);
    float covered = seen.depth * pixel / max(abs(dot(normal, seen.way)), 0.05); // along its longer side
    float texels = covered * count.y / (PI * window.x);
    show(textureLod(plain, seen.spot.uv, log2(max(texels, 1.0))).rgb, seen);
}
