// The four frames and their angles, but no texel: where the time goes. Shown are the means of s (red) and t (green).
#include "field.inc"

void main() {
    Seen seen = see_model();
    Around near = around_spot(seen.spot, -seen.way);
    Angles angles = linear_angles(near.x, near.y, near.z);
    float texels = dot(vec4(near.column + near.row), vec4(1e-9)); // so that none of it is left out as unused
    show(vec3(dot(angles.s, vec4(0.25)), dot(angles.t, vec4(0.25)), texels), seen);
}
