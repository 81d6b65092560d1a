// The same from four filtered fetches.
#include "field.inc"

uniform sampler2D page;

vec3 angular(int column, int row, vec2 angles) {
    vec2 at = clamp(angles * count.zw, vec2(0.5), count.zw - 0.5);
    return textureLod(page, (vec2(column, row) * count.zw + at) / (count.xy * count.zw), 0.0).rgb;
}

void main() {
    PixelRay ray = pixel_ray();
    vec4 at = meet_model(ray);
    if (at.w < 0.0) discard;
    Spot spot = model_spot(at.xyz);
    Around near = around_spot(spot, -ray.way);
    Angles angles = linear_angles(near.x, near.y, near.z);
    vec3 low = mix(angular(near.column.x, near.row.x, vec2(angles.s.x, angles.t.x)),
                   angular(near.column.y, near.row.y, vec2(angles.s.y, angles.t.y)), near.part.x);
    vec3 high = mix(angular(near.column.z, near.row.z, vec2(angles.s.z, angles.t.z)),
                    angular(near.column.w, near.row.w, vec2(angles.s.w, angles.t.w)), near.part.x);
    show(mix(low, high, near.part.y), spot, at.w);
}
