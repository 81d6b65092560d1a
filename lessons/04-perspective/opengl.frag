// OpenGL interpolates s and t with perspective by itself.
in vec3 position;
in vec2 uv; // s, t

uniform vec4 eye; // w = 1: the eye; w = 0: the direction toward it
uniform sampler2D image;

layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 lookup;

void main() {
    colour = vec4(textureLod(image, uv, 0.0).rgb, 1.0);
    lookup = vec4(uv, length(eye.xyz - eye.w * position), 1.0);
}
