// Cone stepping (Dummer 2006), with cones that hold for the interpolated surface (after Bán, Valasek, Bálint and Vad
// 2024).
#include "cells.glsl"

// cone_map: for each cell the slope m, height a texel, of a cone that the surface nowhere rises above, wherever in the
// cell's patch it stands. corner_map: the four heights of each cell.
//
// The ray leaves the cone that stands below it where 1 - t sinks to surface + m |way| dt. Each step gets
// nearer to the surface and none goes through, so what is left after the last is to look in the cell that it ended in.
float cone(sampler2D cone_map, sampler2D corner_map, HeightRay line, int steps) {
    CellRay ray = cell_ray(corner_map, line);
    float t = 0.0, speed = length(ray.way);
    vec2 cell;
    vec4 corners;
    for (int i = 0; i <= steps; i++) {
        cell = cell_at(ray, t);
        ivec2 texel = ivec2(cell - cell_turns(ray, cell));
        corners = texelFetch(corner_map, texel, 0);
        if (i == steps) break;
        vec2 at = ray.start + t * ray.way - cell;
        float surface = mix(mix(corners.x, corners.y, at.x), mix(corners.z, corners.w, at.x), at.y);
        t += max(0.0, 1.0 - t - surface) / (1.0 + texelFetch(cone_map, texel, 0).x * speed);
    }
    float hit = patch_hit(ray, cell, corners, t, leaving_time(ray, cell, vec2(1.0)));
    return hit >= 0.0 ? hit : t;
}
