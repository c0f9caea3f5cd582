in vec2 uv;
out vec4 colour;
void main() {
    vec3 base = mix(vec3(0.055, 0.066, 0.082), vec3(0.165, 0.200, 0.240), smoothstep(0.0, 1.0, uv.y));
    float vignette = 1.0 - 0.45 * dot(uv - 0.5, uv - 0.5);
    // One grey level of ordered noise hides the steps of an 8-bit gradient.
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    colour = vec4(base * vignette + noise / 255.0, 1.0);
}
