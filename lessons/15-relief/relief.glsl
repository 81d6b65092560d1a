// Where a ray first meets a height field, searched for in steps. Each search returns t, in 0..1, of a HeightRay.
#include "ray.glsl"

// How far the ray at t is above the surface; below it, negative. It is never negative at the top of the layer, nor
// positive at its bottom: in between the ray must meet the surface.
float clearance(sampler2D height_map, HeightRay ray, float t) {
    return (1.0 - t) - textureLod(height_map, ray_uv(ray, t), 0.0).x;
}

// Kaneko et al. 2001, lesson 14's: one height, read where the ray crosses the polygon, is taken for the height of
// the whole relief.
float parallax(sampler2D height_map, HeightRay ray, float base) {
    return 1.0 - textureLod(height_map, ray_uv(ray, 1.0 - base), 0.0).x;
}

// The last place that a search found above the surface, and the first below it; clearances over >= 0 >= under.
struct Bracket {
    float above, below, over, under;
};

// Steps of equal length, down to the first that ends below the surface. What is thinner than a step may lie between
// two of them unseen.
Bracket linear_search(sampler2D height_map, HeightRay ray, int steps) {
    float start = clearance(height_map, ray, 0.0);
    Bracket found = Bracket(0.0, 0.0, start, start);
    for (int i = 1; i <= steps && found.under > 0.0; i++) {
        float t = float(i) / float(steps);
        found = Bracket(found.below, t, found.under, clearance(height_map, ray, t));
    }
    return found;
}

// McGuire and McGuire 2005, Steep Parallax Mapping: linear steps, and the first place below the surface is taken.
float steep(sampler2D height_map, HeightRay ray, int steps) {
    return linear_search(height_map, ray, steps).below;
}

// Tatarchuk 2006, Parallax Occlusion Mapping: then one secant. Between the bracket's ends the surface is taken for
// straight.
float occlusion(sampler2D height_map, HeightRay ray, int steps) {
    Bracket found = linear_search(height_map, ray, steps);
    float drop = found.over - found.under;
    return drop > 0.0 ? mix(found.above, found.below, found.over / drop) : found.below;
}

// Policarpo, Oliveira and Comba 2005, Relief Mapping: then the bracket is halved so many times.
float relief(sampler2D height_map, HeightRay ray, int steps, int binary_steps) {
    Bracket found = linear_search(height_map, ray, steps);
    float above = found.above, below = found.below;
    for (int i = 0; i < binary_steps; i++) {
        float middle = 0.5 * (above + below);
        bool outside = clearance(height_map, ray, middle) > 0.0;
        above = outside ? middle : above;
        below = outside ? below : middle;
    }
    return below;
}
