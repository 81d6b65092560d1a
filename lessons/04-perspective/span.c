/* The fillings: where along a span the texture is read. */
#include "span.h"

#include <math.h>

#pragma GCC visibility push(hidden) /* nobody else's functions: so they may be inlined */
#include "perspective.glsl"
#pragma GCC visibility pop

/* A ramp as the pixels see it. */
typedef struct {
    float start, step, low, high;
} FloatRamp;

static FloatRamp in_float(Ramp ramp) {
    return (FloatRamp){(float)ramp.start, (float)ramp.step, (float)ramp.low, (float)ramp.high};
}

static float perspective(FloatRamp s, FloatRamp w, int k) {
    return between(perspective_at(s.start, s.step, w.start, w.step, w.low, (float)k), s.low, s.high);
}

/* The place, in a row from left to right, of the pixel at the far end, and the way on from there. */
static int far_end(const Span *span) { return span->from_right ? span->count - 1 : 0; }
static int towards_near(const Span *span) { return span->from_right ? -1 : 1; }

void span_affine(const Span *span, int value, float *out) {
    FloatRamp ramp = in_float(span->values[value]);
    int next = towards_near(span);
    for (int k = 0, i = far_end(span); k < span->count; k++, i += next)
        out[i] = between(linear_at(ramp.start, ramp.step, (float)k), ramp.low, ramp.high);
}

void span_perspective(const Span *span, float *s, float *t) {
    FloatRamp one_over_w = in_float(span->one_over_w);
    FloatRamp s_over_w = in_float(span->values[VALUE_S]), t_over_w = in_float(span->values[VALUE_T]);
    int next = towards_near(span);
    for (int k = 0, i = far_end(span); k < span->count; k++, i += next) {
        s[i] = perspective(s_over_w, one_over_w, k);
        t[i] = perspective(t_over_w, one_over_w, k);
    }
}

void span_perspective_every(const Span *span, int every, float *s, float *t) {
    if (every < 1) every = 1;
    FloatRamp one_over_w = in_float(span->one_over_w);
    FloatRamp s_over_w = in_float(span->values[VALUE_S]), t_over_w = in_float(span->values[VALUE_T]);
    int next = towards_near(span), i = far_end(span), last = span->count - 1;
    float s_here = perspective(s_over_w, one_over_w, 0), t_here = perspective(t_over_w, one_over_w, 0);
    for (int k = 0; k < last;) {
        int length = last - k < every ? last - k : every; /* the last piece ends at the last pixel */
        float s_end = perspective(s_over_w, one_over_w, k + length);
        float t_end = perspective(t_over_w, one_over_w, k + length);
        float s_step = span_step(s_here, s_end, (float)length);
        float t_step = span_step(t_here, t_end, (float)length);
        for (int j = 0; j < length; j++, i += next) {
            s[i] = linear_at(s_here, s_step, (float)j);
            t[i] = linear_at(t_here, t_step, (float)j);
        }
        s_here = s_end;
        t_here = t_end;
        k += length;
    }
    s[i] = s_here;
    t[i] = t_here;
}

void span_depth(const Span *span, float *w) {
    FloatRamp one_over_w = in_float(span->one_over_w);
    int next = towards_near(span);
    for (int k = 0, i = far_end(span); k < span->count; k++, i += next)
        w[i] = perspective_at(1.0f, 0.0f, one_over_w.start, one_over_w.step, one_over_w.low, (float)k);
}

static double one_over_w_at(const Span *span, int k) {
    return fmax(span->one_over_w.start + k * span->one_over_w.step, span->one_over_w.low);
}

/* The largest |s| in the span: s is monotonic along it, so at one of its ends. */
static double largest(const Span *span, Ramp s) {
    int last = span->count - 1;
    return fmax(fabs(s.start / one_over_w_at(span, 0)),
                fabs((s.start + last * s.step) / one_over_w_at(span, last)));
}

/* |s''| at the k-th pixel. */
static double curvature(const Span *span, Ramp s, int k) {
    Ramp d = span->one_over_w;
    double at_k = one_over_w_at(span, k);
    return fabs(2 * d.step * (s.step * d.start - s.start * d.step) / (at_k * at_k * at_k));
}

void span_bound(const Span *span, int every, int width, int height, float *bound) {
    double u = ldexp(every > 0 ? FLOAT_TERM_SPANS : FLOAT_TERM, -24);
    Ramp s = span->values[VALUE_S], t = span->values[VALUE_T];
    double s_float = u * largest(span, s), t_float = u * largest(span, t);
    int next = towards_near(span), last = span->count - 1;
    double s_bound = s_float, t_bound = t_float;
    for (int k = 0, i = far_end(span); k < span->count; k++, i += next) {
        if (every > 0 && k % every == 0) {
            int length = last - k < every ? last - k : every;
            s_bound = s_float + curvature(span, s, k) * length * length / 8;
            t_bound = t_float + curvature(span, t, k) * length * length / 8;
        }
        bound[i] = (float)hypot(s_bound * width, t_bound * height);
    }
}
