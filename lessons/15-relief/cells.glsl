// A ray's way through cells, the squares between four texel centres: what the searches that find the exact hit walk
// through.
#include "ray.glsl"

// A ray in cells: at t it is at start + t way, where cell (i, j) is i..i+1 by j..j+1 and has the centres of the texels
// (i, j), (i+1, j), (i, j+1), (i+1, j+1) of the repeated map for its corners.
struct CellRay {
    vec2 size;        // of the map
    vec2 start, way;
    vec2 ahead;       // start, moved on by more than rounding errs
    vec2 far;         // the side at which it leaves a cell or a block: 1 or 0
    vec2 t_per_cell;  // along x alone and along y alone
};

CellRay cell_ray(sampler2D corner_map, HeightRay ray) {
    vec2 size = vec2(textureSize(corner_map, 0));
    vec2 start = size * ray.top - 0.5, way = size * ray.across;
    vec2 slack = 0.000004 * (size + abs(way));
    vec2 far = vec2(way.x < 0.0 ? 0.0 : 1.0, way.y < 0.0 ? 0.0 : 1.0);
    vec2 rate = vec2(abs(way.x) < 1e-20 ? 1e-20 : way.x, abs(way.y) < 1e-20 ? 1e-20 : way.y); // so it never leaves
    return CellRay(size, start, way, start + slack * sign(way), far, 1.0 / rate);
}

// The cell that the ray is in at t, and on a border the one that it comes to.
vec2 cell_at(CellRay ray, float t) { return floor(ray.ahead + t * ray.way); }

// How many whole maps, in cells, lie before a cell: the map repeats.
vec2 cell_turns(CellRay ray, vec2 cell) { return ray.size * floor((cell + 0.5) / ray.size); }

// When the ray leaves a block of that side whose near corner is at corner.
float leaving_time(CellRay ray, vec2 corner, vec2 side) {
    vec2 t = (corner + ray.far * side - ray.start) * ray.t_per_cell;
    return min(t.x, t.y);
}
