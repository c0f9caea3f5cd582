layout(location = 0) in vec2 position;  // pixels from the upper left corner
layout(location = 1) in vec2 uv;        // glyph: in the font atlas; box: pixels from its centre
layout(location = 2) in vec4 colour;
layout(location = 3) in vec3 box;       // half width, half height, corner radius; radius < 0 marks a glyph
uniform vec2 viewport;
out vec2 f_uv;
out vec4 f_colour;
flat out vec3 f_box;
void main() {
    f_uv = uv;
    f_colour = colour;
    f_box = box;
    gl_Position = vec4(position.x / viewport.x * 2.0 - 1.0, 1.0 - position.y / viewport.y * 2.0, 0.0, 1.0);
}
