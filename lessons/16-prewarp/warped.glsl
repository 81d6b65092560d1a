// What is done with a warped texture: its texels weighed by how much of them landed, and lit. A hole is 0 in all
// channels, its alpha too, so what the linear filter mixes of holes weighs nothing.

// The colour of what landed, from a filtered texel of which the share texel.a did (not 0).
vec3 landed_colour(vec4 texel) { return vec3(texel.rgb) / texel.a; }

// The same for a normal, whose components are stored as (1 + n) / 2.
vec3 landed_normal(vec4 texel) { return normalize(2.0 * vec3(texel.rgb) - texel.a); }

// Where that lay before it was moved: u, v and h of the source as a point of the polygon's frame.
vec3 landed_point(vec3 from, float scale, float base, float aspect) {
    return vec3(from.x - 0.5, (from.y - 0.5) * aspect, scale * (from.z - base));
}

// Diffuse light from far away, where the unit vector light points, and the share of it that comes from everywhere.
vec3 lit(vec3 colour, vec3 normal, vec3 light, float ambient) {
    return colour * mix(max(dot(normal, light), 0.0), 1.0, ambient);
}

// One of the four texels that a linear filter mixes at uv, kept within the texture.
ivec2 mixed_texel(vec2 corner, int i, ivec2 size) {
    return clamp(ivec2(corner) + ivec2(i & 1, i >> 1), ivec2(0), size - 1);
}

// And its weight, where part is how far uv lies from the first of them toward the last.
float mixed_weight(vec2 part, int i) {
    return ((i & 1) == 1 ? part.x : 1.0 - part.x) * ((i >> 1) == 1 ? part.y : 1.0 - part.y);
}

// Where what is seen at uv came from: u, v and h of the source, and in w how much of the four texels tells.
// Across an edge of the relief a mix of two places would be a third. So the texel of most weight is asked, and
// mixed in with it are those whose u and v are within `near` of its own.
vec4 landed_lookup(sampler2D colour_map, sampler2D lookup_map, vec2 uv, vec2 near) {
    ivec2 size = textureSize(lookup_map, 0);
    vec2 at = uv * vec2(size) - 0.5;
    vec2 corner = floor(at), part = at - corner;
    vec3 most = vec3(0.0);
    float most_weight = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 texel = mixed_texel(corner, i, size);
        float weight = mixed_weight(part, i) * texelFetch(colour_map, texel, 0).a;
        if (weight > most_weight) {
            most_weight = weight;
            most = vec3(texelFetch(lookup_map, texel, 0).rgb);
        }
    }
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 texel = mixed_texel(corner, i, size);
        float weight = mixed_weight(part, i) * texelFetch(colour_map, texel, 0).a;
        vec3 here = vec3(texelFetch(lookup_map, texel, 0).rgb);
        vec2 apart = abs(vec2(here.xy) - vec2(most.xy));
        if (weight > 0.0 && apart.x <= near.x && apart.y <= near.y) sum += weight * vec4(here, 1.0);
    }
    return sum.w > 0.0 ? vec4(vec3(sum.xyz) / sum.w, sum.w) : vec4(0.0);
}
