// A plain picture on the model, through a mipmap: what costs are held against.
#include "field.inc"

uniform sampler2D plain;
uniform vec4 pixel; // the angle of a pixel

void main() {
    PixelRay ray = pixel_ray();
    vec4 at = meet_model(ray);
    if (at.w < 0.0) discard;
    Spot spot = model_spot(at.xyz);
    vec3 n = vec3(spot.theta.x * spot.phi.y, spot.phi.x, spot.theta.y * spot.phi.y);
    float across = at.w * 0.002 / max(-dot(n, ray.way), 0.05), texels = across / (window.x * PI) * count.y;
    show(textureLod(plain, spot.uv, log2(max(texels, 1.0))).rgb, spot, at.w);
}
