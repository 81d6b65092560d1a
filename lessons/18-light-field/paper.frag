// The paper's.
#include "field.inc"
#include "pages.inc"
#include "taps.inc"

void main() {
    PixelRay ray = pixel_ray();
    vec4 at = meet_model(ray);
    if (at.w < 0.0) discard;
    Spot spot = model_spot(at.xyz);
    Around near = around_spot(spot, -ray.way);
    show(sixteen_taps(near, linear_angles(near.x, near.y, near.z)), spot, at.w);
}
