// The four frames and no texel: where the time goes. Shown are the angles of the first.
#include "field.inc"

void main() {
    PixelRay ray = pixel_ray();
    vec4 at = meet_model(ray);
    if (at.w < 0.0) discard;
    Spot spot = model_spot(at.xyz);
    Around near = around_spot(spot, -ray.way);
    Angles angles = linear_angles(near.x, near.y, near.z);
    show(vec3(dot(angles.s, vec4(0.25)), dot(angles.t, vec4(0.25)), float(near.column.x+near.column.w+near.row.x+near.row.w) * 1e-9), spot, at.w);
}
