layout(location = 0) in vec3 position;  // C, m
layout(location = 1) in vec2 place;     // along and across the streak, in radii
layout(location = 2) in vec3 streak;    // direction in the picture, half length in radii
layout(location = 3) in vec4 particle_colour;
layout(location = 4) in float particle_gloss;
uniform mat4 clip_from_camera;
out vec3 p_C;
out vec2 f_place;
flat out vec3 f_streak;
flat out vec4 f_colour;
flat out float f_gloss;
void main() {
    p_C = position;
    f_place = place;
    f_streak = streak;
    f_colour = particle_colour;
    f_gloss = particle_gloss;
    gl_Position = clip_from_camera * vec4(position, 1.0);
}
