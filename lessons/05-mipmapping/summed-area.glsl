// Lesson 05: the mean over a box of any size, from a summed-area table (Crow 1984).
//
// The table holds, at the corner (x, y), the sum of all texels left of x and below y; the sum over any box is
// then a difference of four corners. The difference is small and the corners are large, so floats lose it.
// Our table is split in two textures (chain.c): `high` holds multiples of a power of two so coarse that
// floats subtract them without rounding; `low` holds the rest, which is small. The code below therefore
// subtracts first, exactly, and only then multiplies by the shares of texels that are covered in part.
#include "mipmap.glsl"

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
