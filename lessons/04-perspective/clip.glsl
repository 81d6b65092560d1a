// The arithmetic of cutting an edge, as plain functions of numbers. clip.c compiles this file as C in doubles.

// Where an edge crosses a plane, 0 at its inner end and 1 at its outer: the distances of its ends from the
// plane are inside >= 0 and outside < 0, in any unit.
float clip_parameter(float inside, float outside) { return inside / (inside - outside); }

// This form, unlike a + t (b - a), returns a for t = 0 and b for t = 1, exactly.
float clip_mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }
