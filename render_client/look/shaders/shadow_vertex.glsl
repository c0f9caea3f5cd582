layout(location = 0) in vec3 steps;
uniform vec3 origin;
uniform vec3 step;
uniform mat4 clip_from_model;
uniform vec4 cut_planes[3];  // model frame
uniform vec4 eye_plane;      // model frame: what lies behind the eye casts no shadow
out float gl_ClipDistance[4];
void main() {
    vec4 p_M = vec4(origin + step * steps, 1.0);
    gl_Position = clip_from_model * p_M;
    for (int i = 0; i < 3; ++i) gl_ClipDistance[i] = dot(cut_planes[i], p_M);
    gl_ClipDistance[3] = dot(eye_plane, p_M);
}
