// The naive way: the angles in the frame of the point itself, for all four of its neighbours.
#include "field.inc"
#include "pages.inc"
#include "taps.inc"

void main() {
    PixelRay ray = pixel_ray();
    vec4 at = meet_model(ray);
    if (at.w < 0.0) discard;
    Spot spot = model_spot(at.xyz);
    Around near = around_spot(spot, -ray.way);
    float a = dot(-ray.way, vec3(spot.theta.y, 0.0, -spot.theta.x)), b = dot(-ray.way, vec3(spot.theta.x, 0.0, spot.theta.y));
    Angles own = linear_angles(vec4(a * -window.z), vec4(-ray.way.y * spot.phi.y - b * spot.phi.x), vec4(b * spot.phi.y - ray.way.y * spot.phi.x) * -window.z);
    show(sixteen_taps(near, own), spot, at.w);
}
