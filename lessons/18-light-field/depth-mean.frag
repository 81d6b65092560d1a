// The lumigraph's correction with one depth for all.
#include "depth.inc"

uniform float mean_depth;

void main() {
    Seen seen = see_model();
    show(corrected_taps(seen, mean_depth), seen);
}
