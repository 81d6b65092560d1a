#include "hits.h"

#include "fail.h"

#include <stdlib.h>

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

HitErrors hit_errors(const Image *lookup, const Sample *exact, Vec2 texels) {
    size_t count = (size_t)lookup->width * lookup->height, either = 0, both = 0, wrong = 0;
    double *errors = allocate(count, sizeof *errors);
    for (size_t i = 0; i < count; i++) {
        const float *found = lookup->pixels + 4 * i;
        bool hit = found[3] > 0.5f;
        if (exact[i].unknown || !(hit || exact[i].hit)) continue;
        either++;
        double error = hypot((found[0] - exact[i].u) * texels.x, (found[1] - exact[i].v) * texels.y);
        wrong += hit != exact[i].hit || !(error <= 1.0);
        if (hit && exact[i].hit) errors[both++] = error;
    }
    qsort(errors, both, sizeof *errors, by_size);
    HitErrors result = {either ? 100.0 * (double)wrong / (double)either : 0.0,
                        both ? errors[(size_t)ceil(0.99 * (double)both) - 1] : 0.0};
    free(errors);
    return result;
}
