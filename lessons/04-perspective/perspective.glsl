// The arithmetic of one pixel in a span, as plain functions of numbers: span.c compiles this file as C, the
// tests compile it as C++ (in float and in double) and as a shader. k counts pixels from the span's far end.

// What is linear on the screen.
float linear_at(float start, float step, float k) { return start + step * k; }

// Both give low for what is not a number.
float at_least(float value, float low) { return value >= low ? value : low; }
float between(float value, float low, float high) {
    return value >= low ? (value <= high ? value : high) : low;
}

// s from s/w and 1/w (Heckbert and Moreton 1991). 1/w falls to 0 at the horizon; just outside of a polygon it
// may even be negative, so it is never taken to be less than `least`.
float perspective_at(float s_over_w, float s_over_w_step, float one_over_w, float one_over_w_step,
                     float least, float k) {
    return linear_at(s_over_w, s_over_w_step, k) / at_least(linear_at(one_over_w, one_over_w_step, k), least);
}

// How much s changes from pixel to pixel where it goes from start to end in `count` pixels as if linear.
float span_step(float start, float end, float count) { return (end - start) / count; }
