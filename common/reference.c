#include "reference.h"

#include "fail.h"

#include <stdlib.h>

Reference reference_create(const Truth *truth, const View *view, int width, int height, int samples) {
    return (Reference){.view = view, .truth = truth, .width = width, .height = height, .samples = samples};
}

void reference_destroy(Reference *reference) {
    for (int filter = 0; filter < 2; filter++) {
        image_destroy(&reference->exact[filter].image);
        seen_destroy(&reference->seen[filter]);
    }
    free(reference->centres);
}

void reference_look(Reference *reference) {
    if (reference->centres) return;
    const View *view = reference->view;
    reference->centres = truth_centres(reference->truth, &view->camera, reference->width, reference->height);
    size_t count = (size_t)reference->width * reference->height, unknown = 0;
    for (size_t i = 0; i < count; i++) unknown += reference->centres[i].unknown;
    reference->known_share = 1.0 - (double)unknown / (double)count;
    if (reference->known_share == 0.0) fail("%s: the truth knows no pixel of this view", view->name);
}

const Exact *reference_exact(Reference *reference, PixelFilter filter) {
    Exact *exact = &reference->exact[filter];
    if (!exact->image.pixels)
        *exact = truth_render(reference->truth, &reference->view->camera, reference->width, reference->height,
                              reference->samples, filter);
    return exact;
}

const Seen *reference_seen(Reference *reference, PixelFilter filter) {
    Seen *seen = &reference->seen[filter];
    if (!seen->pixels) *seen = seen_create(&reference_exact(reference, filter)->image);
    return seen;
}

const Image *shot_exact(const Shot *shot) { return &reference_exact(shot->reference, FILTER_BOX)->image; }
