// The colours of the two objects by position, for their meshes, which have no texture: common/object.c says the same
// in doubles.

// From -1 to 1 and back, once in `length`.
float wave(float x, float length) { return sin(6.28318530717959 * x / length); }

// A checker in three dimensions, with soft edges: the tone of a solid at a point.
float toy_tone(vec3 at) {
    float sides = wave(at.x - 0.11, 0.44) * wave(at.y - 0.11, 0.44) * wave(at.z - 0.11, 0.44);
    return 0.75 + 0.25 * clamp(4.0 * sides, -1.0, 1.0);
}

vec3 bunny_tone(vec3 at) {
    float bent = at.y + 0.1 * wave(at.x, 1.0) + 0.1 * wave(at.z, 0.8);
    return mix(vec3(0.55, 0.38, 0.22), vec3(0.8, 0.74, 0.62), 0.5 + 0.5 * wave(bent, 0.25));
}
