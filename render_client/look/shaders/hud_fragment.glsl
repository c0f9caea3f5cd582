in vec2 f_uv;
in vec4 f_colour;
flat in vec3 f_box;
uniform sampler2D font;
out vec4 colour;
void main() {
    float cover;
    if (f_box.z < 0.0) {
        cover = texture(font, f_uv).r;
    } else {
        vec2 outside = abs(f_uv) - f_box.xy + f_box.z;
        float distance = length(max(outside, 0.0)) + min(max(outside.x, outside.y), 0.0) - f_box.z;
        cover = clamp(0.5 - distance, 0.0, 1.0);
    }
    colour = vec4(f_colour.rgb, f_colour.a * cover);
}
