// One texel: the nearest along all four axes.
#include "field.inc"
#include "pages.inc"

void main() {
    Seen seen = see_model();
    Around near = nearest(seen.spot, -seen.way, count, steps.zw, -window.z);
    Angles angles = linear_angles(near.x, near.y, near.z);
    vec2 place = floor(among(vec2(angles.s.x, angles.t.x), count.zw) + 0.5);
    show(texel(ivec4(near.column.x, near.row.x, ivec2(place))), seen);
}
