in vec3 f_normal;
in vec4 f_colour;
uniform float strength;
out vec4 colour;
void main() {
    float shade = 1.0;
    if (dot(f_normal, f_normal) > 0.25) shade = 0.62 + 0.38 * max(dot(normalize(f_normal), normalize(vec3(-0.4, 0.6, 0.7))), 0.0);
    colour = vec4(f_colour.rgb * shade, f_colour.a * strength);
}
