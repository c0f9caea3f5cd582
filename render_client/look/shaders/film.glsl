uniform sampler3D film;            // blood, water, burns, bruises; repeats
uniform float film_period;         // m, V
uniform vec3 film_low, film_high;  // V, of what the texture holds now
uniform vec4 film_strength;

vec4 filmAt(vec3 p) {
    if (any(lessThan(p, film_low)) || any(greaterThan(p, film_high))) return vec4(0.0);
    return texture(film, p / film_period) * film_strength;
}

// Red as far as it was pressed, dark where it was cut open.
vec3 bruised(vec3 albedo, float bruise) {
    vec3 red = mix(vec3(0.52, 0.06, 0.07), vec3(0.16, 0.008, 0.012), smoothstep(0.6, 0.95, bruise));
    return mix(albedo, red, 0.9 * smoothstep(0.04, 0.6, bruise));
}
