// The sixteen taps of the texels as they are.
#include "field.inc"
#include "pages.inc"
#include "taps.inc"
#include "shown.inc"
