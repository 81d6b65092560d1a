// White letters on a box that darkens what is behind it.
uniform sampler2D ink;
uniform vec4 corner; // the box's lower left, in pixels of the window
uniform vec4 box;    // its colour, and how much it hides

layout(location = 0) out vec4 colour;

void main() {
    float here = texelFetch(ink, ivec2(gl_FragCoord.xy - corner.xy), 0).r;
    colour = vec4(mix(box.rgb, vec3(1.0), here), mix(box.a, 1.0, here));
}
