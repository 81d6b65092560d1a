// The naive way: the eye's angles in the frame of the point itself, for all four texels around it.
#include "field.inc"
#include "pages.inc"
#include "taps.inc"

void main() {
    Seen seen = see_model();
    vec3 d = own_frame(seen.spot, -seen.way, -window.z);
    Angles own = linear_angles(vec4(d.x), vec4(d.y), vec4(d.z));
    show(sixteen_taps(around_spot(seen.spot, -seen.way), own), seen);
}
