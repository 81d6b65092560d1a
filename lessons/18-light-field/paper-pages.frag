// The same as paper.frag, for a light field that needs more than one texture.
#include "field.inc"
#include "pages-4.inc"
#include "taps.inc"

void main() {
    Seen seen = see_model();
    Around near = around_spot(seen.spot, -seen.way);
    show(sixteen_taps(near, linear_angles(near.x, near.y, near.z)), seen);
}
