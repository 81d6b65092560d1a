// The maximum mip pyramid (Tevs, Ihrke, Seidel 2008): whole blocks of cells that the ray passes above are left behind
// in one step.
#include "bilinear.glsl"

// pyramid_map: in level k, texel (i, j), the largest height in the block of 2^k x 2^k cells from (2^k i, 2^k j) on, as
// far as the map goes. corner_map: the four heights of each cell.
//
// The inner loop leaves a block, and tries one twice as large, or looks closer; it ends at a cell whose highest corner
// the ray falls below. There the patch decides. (One loop for both would do the patch's arithmetic at each step: a GPU
// runs pixels in groups, through all that any of them needs.)
float maximum(sampler2D pyramid_map, sampler2D corner_map, HeightRay line) {
    const int most = 16384; // steps: a ray all but in the plane crosses more cells than floats can count
    CellRay ray = cell_ray(corner_map, line);
    int coarsest = int(log2(max(ray.size.x, ray.size.y))), level = min(3, coarsest);
    float t = 0.0, side = exp2(float(level)), top, leave;
    vec2 cell, texel;
    for (int steps = 0; steps < most; steps++) {
        for (; steps < most; steps++) {
            cell = cell_at(ray, t);
            vec2 turns = cell_turns(ray, cell);
            texel = cell - turns;
            vec2 block = side * floor(texel / side);
            top = 1.0 - texelFetch(pyramid_map, ivec2(block / side), level).x;
            leave = leaving_time(ray, turns + block, min(vec2(side), ray.size - block));
            if (top < leave && level == 0) break;
            bool over = top >= leave;
            t = over ? leave : max(t, top);
            level = over ? min(level + 1, coarsest) : level - 1;
            side = exp2(float(level));
        }
        vec4 terms = patch_terms(texelFetch(corner_map, ivec2(texel), 0));
        float hit = patch_hit(ray, cell, terms, max(t, top), leave);
        if (hit >= 0.0) return hit;
        t = leave;
    }
    return t;
}
