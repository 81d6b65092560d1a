// An object's colour in the light of one lamp, infinitely far away. All vectors are units; to_light points to the
// lamp and to_eye to the eye.

// Phong's model with Blinn's half vector: what comes from everywhere, what the lamp spreads, and its highlight.
// Where the surface faces away from the lamp, or has no normal, only the first is left.
vec3 lit(vec3 colour, vec3 normal, vec3 to_light, vec3 to_eye) {
    float facing = dot(normal, to_light);
    if (!(facing > 0.0)) return 0.25 * colour;
    vec3 middle = to_light + to_eye;
    float length_squared = dot(middle, middle);
    float along = length_squared > 0.0 ? max(dot(normal, middle), 0.0) * inversesqrt(length_squared) : 0.0;
    return colour * (0.25 + 0.6 * facing) + vec3(0.25 * facing * pow(along, 40.0));
}

// The normal in a texel that was filtered: 65535 alpha (n + 1) / 2 was stored, and alpha.
vec3 stored_normal(vec4 texel) {
    vec3 direction = vec3(texel.xyz) - 0.5 * texel.w;
    float length_squared = dot(direction, direction);
    return length_squared > 0.0 ? direction * inversesqrt(length_squared) : vec3(0.0);
}

// The colour in a texel that was filtered: the colour times alpha was stored, and alpha, which must not be 0.
vec3 stored_colour(vec4 texel) { return vec3(texel.rgb) / texel.a; }

// How much of a pixel an edge covers whose texel is covered so far: the ramp from 0 to 1, `width` wide around 1/2.
float coverage(float alpha, float width) { return clamp((alpha - 0.5) / width + 0.5, 0.0, 1.0); }
