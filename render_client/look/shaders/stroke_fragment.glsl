in vec3 f_at;
flat in float f_length;
flat in vec3 f_colour;
out vec4 colour;
void main() {
    vec2 beyond = vec2(max(0.0, max(-f_at.x, f_at.x - f_length)), f_at.y);
    if (dot(beyond, beyond) > f_at.z * f_at.z) discard;
    colour = vec4(f_colour, 1.0);
}
