// OpenGL interpolates s and t with perspective by itself.
in vec3 position;
in vec2 uv; // s, t

uniform vec4 eye;        // w = 1: the eye; w = 0: the direction toward it,
uniform float eye_plane; // and how far it is in that direction
uniform sampler2D image;

layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 lookup;

void main() {
    colour = vec4(textureLod(image, uv, 0.0).rgb, 1.0);
    float depth = eye.w > 0.0 ? length(eye.xyz - position) : eye_plane - dot(position, eye.xyz);
    lookup = vec4(uv, depth, 1.0);
}
