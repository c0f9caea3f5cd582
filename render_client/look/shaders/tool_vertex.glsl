layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 camera_from_model;
uniform mat4 clip_from_camera;
out vec3 p_C;
out vec3 n_C;
out vec3 p_M;

void main() {
    p_M = position;
    p_C = (camera_from_model * vec4(p_M, 1.0)).xyz;
    n_C = mat3(camera_from_model) * normal;
    gl_Position = clip_from_camera * vec4(p_C, 1.0);
}
