// The window: one picture left of the divider and another right of it, linear light as bytes of sRGB.
uniform sampler2D left, right;
uniform vec4 size;     // the window's, in pixels
uniform float divider; // pixels from the left; the line there is two pixels wide

layout(location = 0) out vec4 colour;

float encode(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }

void main() {
    vec2 at = gl_FragCoord.xy / size.xy;
    vec3 light = (gl_FragCoord.x < divider ? textureLod(left, at, 0.0) : textureLod(right, at, 0.0)).rgb;
    light = clamp(light, 0.0, 1.0);
    colour = vec4(encode(light.r), encode(light.g), encode(light.b), 1.0);
    float aside = abs(gl_FragCoord.x - divider);
    if (aside < 3.0) colour.rgb = vec3(aside < 1.0 ? 1.0 : 0.0); // white between black: seen on any picture
}
