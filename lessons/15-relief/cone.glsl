// Cone stepping (Dummer 2006), with cones that hold for the interpolated surface (after Bán, Valasek, Bálint and Vad
// 2024).
#include "bilinear.glsl"

// cone_map: for each cell the slope m, height a texel, of a cone that the surface nowhere rises above, wherever in the
// cell's patch it stands. corner_map: the four heights of each cell.
//
// The cone that stands below the ray is left where the ray has sunk to it, 1 - t - dt = surface + m |way| dt. That
// alone comes ever nearer to the surface and never there; so the cell that the ray is in is searched too, exactly, and
// the step leads out of both. Each leaves a cell behind: with enough of them the hit is found, and what lies at t
// after the last is never below the surface.
float cone(sampler2D cone_map, sampler2D corner_map, HeightRay line, int steps) {
    CellRay ray = cell_ray(corner_map, line);
    float t = 0.0, speed = length(ray.way);
    for (int i = 0; i < steps; i++) {
        vec2 cell = cell_at(ray, t);
        ivec2 texel = ivec2(cell - cell_turns(ray, cell));
        vec4 terms = patch_terms(texelFetch(corner_map, texel, 0));
        float leave = leaving_time(ray, cell, vec2(1.0));
        float hit = patch_hit(ray, cell, terms, t, leave);
        if (hit >= 0.0) return hit;
        float above = patch_clearance(ray, cell, terms, t);
        t = max(leave, t + above / (1.0 + texelFetch(cone_map, texel, 0).x * speed));
    }
    return t;
}
