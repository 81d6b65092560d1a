// Lesson 05: what one pixel sees of a texture, and seven ways to read it.
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

// ---- Summed-area tables (Crow 1984) ----
//
// The table holds, at the corner (x, y), the sum of all texels left of x and below y; the sum over any box is
// then a difference of four corners. The difference is small and the corners are large, so floats lose it.
// Our table is split in two textures (chain.c): `high` holds multiples of a power of two so coarse that
// floats subtract them without rounding; `low` holds the rest, which is small. The code below therefore
// subtracts first, exactly, and only then multiplies by the shares of texels that are covered in part.

// What a box covers of one axis. The axis is cut at edges.x, .y = .x + 1, .z, .w = .z + 1 (texel borders
// within the texture), and the pieces are covered with these weights: the texel x..y in part, y..z wholly
// (it runs backwards where the box crosses the texture's end), the texel z..w in part, and then whole repeats.
struct Cover {
    ivec4 edges;
    vec4 weights;
};

// A box of `width` texels, at least one, around `centre` on an axis of `size` texels that repeats.
Cover cover(float centre, float width, int size) {
    float n = float(size);
    float start = centre - 0.5 * width;
    start = clamp(start - n * floor(start / n), 0.0, n);
    int first = min(int(start), size - 1);
    float end = start + width;
    float repeats = floor(end / n);
    end = clamp(end - n * repeats, 0.0, n); // rounding may have put it just outside
    int last = min(int(end), size - 1);
    return Cover(ivec4(first, first + 1, last, last + 1),
                 vec4(1.0 - (start - float(first)), 1.0, end - float(last), repeats));
}

vec4 corner(sampler2D sums, int x, int y) { // texel (x - 1, y - 1) holds it; no texels, no sum
    return x == 0 || y == 0 ? vec4(0.0) : texelFetch(sums, ivec2(x - 1, y - 1), 0);
}

// The sums of the texels left of x in each piece of a Cover of the rows.
struct Pieces {
    vec4 first, middle, last, whole;
};

Pieces pieces(sampler2D sums, int x, ivec4 rows) {
    vec4 a = corner(sums, x, rows.x), b = corner(sums, x, rows.y);
    vec4 c = corner(sums, x, rows.z), d = corner(sums, x, rows.w);
    return Pieces(b - a, c - b, d - c, corner(sums, x, textureSize(sums, 0).y));
}

// The weighted sum over the columns between a and b.
vec4 between(Pieces a, Pieces b, vec4 rows) {
    return (b.first - a.first) * rows.x + (b.middle - a.middle) * rows.y + (b.last - a.last) * rows.z +
           (b.whole - a.whole) * rows.w;
}

vec4 box_sum(sampler2D sums, Cover columns, Cover rows) {
    Pieces a = pieces(sums, columns.edges.x, rows.edges), b = pieces(sums, columns.edges.y, rows.edges);
    Pieces c = pieces(sums, columns.edges.z, rows.edges), d = pieces(sums, columns.edges.w, rows.edges);
    Pieces none = pieces(sums, 0, rows.edges), all = pieces(sums, textureSize(sums, 0).x, rows.edges);
    return between(a, b, rows.weights) * columns.weights.x + between(b, c, rows.weights) * columns.weights.y +
           between(c, d, rows.weights) * columns.weights.z +
           between(none, all, rows.weights) * columns.weights.w;
}

// The mean over the footprint's bounding box, at least a texel wide and high. Texels count by the area that
// the box covers of them; a box of one texel is bilinear interpolation, exactly.
vec4 summed_area(sampler2D high, sampler2D low, vec2 uv, vec2 dx, vec2 dy) {
    vec2 size = vec2(textureSize(high, 0));
    vec2 box = clamp((abs(dx) + abs(dy)) * size, vec2(1.0), LONGEST * size);
    vec2 centre = uv * size;
    Cover columns = cover(centre.x, box.x, textureSize(high, 0).x);
    Cover rows = cover(centre.y, box.y, textureSize(high, 0).y);
    return (box_sum(high, columns, rows) + box_sum(low, columns, rows)) / (box.x * box.y);
}
