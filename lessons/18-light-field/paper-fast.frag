// The same value as paper.frag from four fetches: OpenGL mixes the four taps of each neighbour. Places are clamped to the
// centres of a block's outermost texels, so that no block is read across its border.
#include "field.inc"

uniform sampler2D page;

vec3 filtered(int column, int row, vec2 angles) {
    vec2 block = vec2(column, row) * count.zw, at = clamp(angles * count.zw, vec2(0.5), count.zw - 0.5);
    return textureLod(page, (block + at) / (count.xy * count.zw), 0.0).rgb;
}

void main() {
    Seen seen = see_model();
    Around near = around_spot(seen.spot, -seen.way);
    Angles angles = linear_angles(near.x, near.y, near.z);
    vec3 low = mix(filtered(near.column.x, near.row.x, vec2(angles.s.x, angles.t.x)),
                   filtered(near.column.y, near.row.y, vec2(angles.s.y, angles.t.y)), near.part.x);
    vec3 high = mix(filtered(near.column.z, near.row.z, vec2(angles.s.z, angles.t.z)),
                    filtered(near.column.w, near.row.w, vec2(angles.s.w, angles.t.w)), near.part.x);
    show(mix(low, high, near.part.y), seen);
}
