// One texel.
#include "field.inc"
#include "pages.inc"

void main() {
    PixelRay ray = pixel_ray();
    vec4 at = meet_model(ray);
    if (at.w < 0.0) discard;
    Spot spot = model_spot(at.xyz);
    Around near = nearest(spot, -ray.way, count, steps.xy, steps.zw, -window.z);
    Angles angles = linear_angles(near.x, near.y, near.z);
    vec2 place = min(floor(clamp(vec2(angles.s.x, angles.t.x), 0.0, 1.0) * count.zw), count.zw - 1.0);
    show(texel(ivec4(near.column.x, near.row.x, ivec2(place))), spot, at.w);
}
