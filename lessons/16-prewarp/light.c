#include "light.h"

#include "image.h"

#include <threads.h>

static Light light;
static once_flag made = ONCE_FLAG_INIT;

static void make(void) {
    for (int i = 0; i < 256; i++) light.decoded[i] = (float)srgb_decode(i / 255.0);
    for (int i = 0; i < LIGHT_STEPS; i++) light.encoded[i] = srgb_byte((float)i / (LIGHT_STEPS - 1));
}

const Light *light_tables(void) {
    call_once(&made, make);
    return &light;
}
