// A ray against a relief, in the terms of polygon.glsl. The layer of heights 0..1 is all that it can meet, so a ray
// is where it enters that layer from above and how far it goes across until it leaves it below.
#include "polygon.glsl"

// At t in 0..1 the ray is at texture coordinates top + t across, and at height 1 - t.
struct HeightRay {
    vec2 top, across;
};

// The ray from the eye through uv of the polygon, where its height is base. view is the unit vector toward the eye in
// the polygon's frame; one in the polygon's plane or behind it has no tangents, and looks straight down.
HeightRay height_ray(vec2 uv, vec3 view, float scale, float base, float aspect) {
    vec2 tangents = view_tangents(view);
    vec2 across = -scale * vec2(tangents.x, tangents.y / aspect);
    return HeightRay(uv - (1.0 - base) * across, across);
}

vec2 ray_uv(HeightRay ray, float t) { return ray.top + t * ray.across; }
