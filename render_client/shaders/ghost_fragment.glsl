in vec3 p_C;
in vec3 n_C;
uniform float strength;
out vec4 colour;
void main() {
    float edge = pow(1.0 - abs(dot(normalize(n_C), normalize(-p_C))), 1.5);
    colour = vec4(0.35, 0.80, 1.0, strength * (0.03 + 0.60 * edge * edge));
}
