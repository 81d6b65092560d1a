// The same as paper.frag, with the sines of the angles instead of the angles.
#include "field.inc"
#include "pages.inc"
#include "taps.inc"

void main() {
    Seen seen = see_model();
    Around near = around_spot(seen.spot, -seen.way);
    show(sixteen_taps(near, sine_angles(near.x, near.y, near.z)), seen);
}
