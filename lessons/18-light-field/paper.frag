// The paper's way: four texels around the point, the eye's angles in the frame of each, four taps between those.
#include "field.inc"
#include "pages.inc"
#include "taps.inc"

void main() {
    Seen seen = see_model();
    Around near = around_spot(seen.spot, -seen.way);
    show(sixteen_taps(near, linear_angles(near.x, near.y, near.z)), seen);
}
