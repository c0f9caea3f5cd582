uniform float field_radius;  // of the round field, in picture heights; 0: all of the picture is seen

// What an instrument shows is a disc that darkens towards its rim.
vec3 inRoundField(vec3 shaded, vec2 place, vec2 size) {
    float away = length((place - 0.5) * size) / size.y;
    float rim = 1.0 - 0.45 * smoothstep(0.55, 1.0, away / field_radius);
    return mix(shaded * rim, vec3(0.012), smoothstep(field_radius - 1.0 / size.y, field_radius + 1.0 / size.y, away));
}
