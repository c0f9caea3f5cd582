// A half-colour anaglyph takes red from the left eye's brightness, green and blue from the right eye. Ivory keeps a
// hue.
in vec2 uv;
uniform sampler2D left_eye;
uniform sampler2D right_eye;
out vec4 colour;
void main() {
    float red = dot(texture(left_eye, uv).rgb, vec3(0.299, 0.587, 0.114));
    colour = vec4(red, texture(right_eye, uv).gb, 1.0);
}
