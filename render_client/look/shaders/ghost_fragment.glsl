in vec3 p_C;
in vec3 n_C;
uniform float strength;
uniform vec3 tint;
out vec4 colour;
void main() {
    float edge = pow(1.0 - abs(dot(normalize(n_C), normalize(-p_C))), 1.5);
    colour = vec4(tint, strength * (0.03 + 0.60 * edge * edge));
}
