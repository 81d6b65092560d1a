/* Bytes of sRGB to linear light and back, by tables: the ways to warp that mix colours mix light. */
#ifndef LESSON_LIGHT_H
#define LESSON_LIGHT_H

#include <stdint.h>

enum { LIGHT_STEPS = 4096 };

typedef struct {
    float decoded[256];
    uint8_t encoded[LIGHT_STEPS]; /* of i / (LIGHT_STEPS - 1); at most one byte off for what lies between */
} Light;

/* The tables, made when first asked for. */
const Light *light_tables(void);

/* The byte of a linear value in 0..1. */
static inline uint8_t light_encode(const Light *light, float linear) {
    return light->encoded[(int)(linear * (LIGHT_STEPS - 1) + 0.5f)];
}

#endif
