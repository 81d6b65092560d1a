// A face of the box, with what was warped onto it, lit pixel by pixel.
#include "light.glsl"

in vec3 position;
in vec2 uv;

uniform vec4 eye, light, background;
uniform sampler2D colour_map, normal_map;

layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 lookup;

void main() {
    vec4 texel = textureLod(colour_map, uv, 0.0);
    float covered = coverage(texel.a, 0.5);
    if (covered == 0.0) discard;
    vec3 toward = eye.xyz - eye.w * position;
    vec3 seen = lit(stored_colour(texel), stored_normal(textureLod(normal_map, uv, 0.0)), light.xyz,
                    normalize(toward));
    colour = vec4(mix(background.rgb, seen, covered), 1.0);
    lookup = vec4(uv, 0.0, covered >= 0.5 ? 1.0 : 0.0); // for the silhouette: the surface's depth is not known
}
