// A finished layer comes onto a browser's canvas, with its depth; it may have fewer pixels.
#include "round_field.glsl"
in vec2 uv;
uniform sampler2D colour_map;
uniform sampler2D depth_map;
out vec4 colour;

void main() {
    vec3 shaded = texture(colour_map, uv).rgb;
    if (field_radius > 0.0) shaded = inRoundField(shaded, uv, vec2(textureSize(colour_map, 0)));
    colour = vec4(shaded, 1.0);
    gl_FragDepth = texture(depth_map, uv).r;
}
