// Lesson 05: what one pixel sees of a texture, and ways to read it; summed-area.glsl is one more.
//
// A pixel's footprint is where its square lands on the texture: near enough the parallelogram around uv whose
// sides are dx and dy, the change of (u, v) from one pixel to the next. A texture repeats in u and v; uv, dx
// and dy are in repeats, and texels are counted only inside the functions.

// ---- The footprint ----

struct Footprint {
    bool hit; // does the pixel's centre see the plane? If not, the rest is zero
    vec2 uv, dx, dy;
};

// The footprint of the pixel (its centre, in pixels). homography takes (x, y, 1) to (u w, v w, w), with w > 0
// where the plane is in front of the eye; then u = (u w) / w, and du/dx follows from the quotient rule
// (Heckbert 1989). Exact, unlike dFdx, which is the difference to a neighbouring pixel. Where w = 0 is the
// horizon; a centre less than a thousandth of a pixel below it counts as sky, so that nothing overflows.
Footprint footprint(mat3 homography, vec2 pixel) {
    vec3 p = homography * vec3(pixel, 1.0);
    vec3 p_x = homography[0], p_y = homography[1]; // its derivatives
    float pixel_w = length(vec2(p_x.z, p_y.z));    // how fast w grows away from the horizon
    if (p.z <= 0.001 * pixel_w) return Footprint(false, vec2(0.0), vec2(0.0), vec2(0.0));
    vec2 uv = vec2(p.xy) / p.z;
    return Footprint(true, uv, (vec2(p_x.xy) - uv * p_x.z) / p.z, (vec2(p_y.xy) - uv * p_y.z) / p.z);
}

// ---- Reading one texel, or four ----

vec4 nearest(sampler2D image, vec2 uv) {
    ivec2 size = textureSize(image, 0);
    ivec2 texel = ivec2(fract(uv) * vec2(size));
    return texelFetch(image, min(texel, size - 1), 0); // fract(-1e-9) is 1.0 in floats
}

vec4 bilinear(sampler2D image, vec2 uv) { return textureLod(image, uv, 0.0); }

// ---- Mipmaps (Williams 1983) ----

// The number of the chain's last level, of 1x1: floor(log2(larger side)). The half keeps a power of two, whose
// logarithm may be rounded down, away from the edge.
float last_level(sampler2D image) {
    ivec2 size = textureSize(image, 0);
    return floor(log2(float(max(size.x, size.y)) + 0.5));
}

// log2 of the longer side of the footprint, which is given in texels: 0 where the texture is magnified, at most
// last. Near the horizon the square overflows to infinity, which asks for the last level and for no logarithm.
float level_of_detail(vec2 dx, vec2 dy, float last) {
    float square = max(dot(dx, dx), dot(dy, dy));
    return square < exp2(2.0 * last) ? 0.5 * log2(max(square, 1.0)) : last;
}

vec4 mip_nearest(sampler2D image, vec2 uv, float level) {
    return textureLod(image, uv, ceil(level - 0.5)); // OpenGL's rounding: a half goes to the finer level
}

vec4 trilinear(sampler2D image, vec2 uv, float level) { return textureLod(image, uv, level); }

// ---- Many taps ----

const float LONGEST = 65536.0; // repeats: no footprint that matters is longer, and nothing overflows

// n x n bilinear taps, each in the middle of its share of the footprint.
vec4 area(sampler2D image, vec2 uv, vec2 dx, vec2 dy, int n) {
    vec2 right = clamp(dx, -LONGEST, LONGEST), up = clamp(dy, -LONGEST, LONGEST);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            vec2 at = (vec2(float(i), float(j)) + 0.5) / float(n) - 0.5;
            sum += textureLod(image, uv + right * at.x + up * at.y, 0.0);
        }
    return sum / float(n * n);
}
