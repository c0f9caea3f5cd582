layout(location = 0) in vec3 position;  // C, m
layout(location = 1) in vec3 normal;    // C; 0: it glows by itself
layout(location = 2) in vec4 colour;
uniform mat4 clip_from_camera;
out vec3 f_normal;
out vec4 f_colour;
void main() {
    f_normal = normal;
    f_colour = colour;
    gl_Position = clip_from_camera * vec4(position, 1.0);
}
