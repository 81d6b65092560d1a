// The lumigraph's correction with a coarse depth: one for each cell of 4 x 4 texels of s and t.
#include "depth.inc"

uniform sampler2D depths;

// What the texel nearest to the spot knows of the depth in the direction d, whatever the length of that.
float known_depth(Spot spot, vec3 d, float lifted) {
    Around near = nearest(spot, d, count, steps.zw, -window.z);
    Angles angles = linear_angles(near.x, near.y, near.z + lifted);
    ivec2 cells = (ivec2(count.zw) + 3) / 4;
    ivec2 cell = ivec2(among(vec2(angles.s.x, angles.t.x), count.zw) + 0.5) / 4;
    return texelFetch(depths, ivec2(near.column.x, near.row.x) * cells + cell, 0).x;
}

void main() {
    Seen seen = see_model();
    float depth = known_depth(seen.spot, -seen.way, 0.0);
    depth = known_depth(seen.spot, -(seen.at + depth * seen.way), window.x);
    show(corrected_taps(seen, depth), seen);
}
