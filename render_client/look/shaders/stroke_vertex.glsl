layout(location = 0) in vec3 from_W;  // m
layout(location = 1) in vec3 to_W;
layout(location = 2) in vec3 line_colour;
layout(location = 3) in float half_width;  // picture heights; 0: no line
uniform mat4 camera_from_world;
uniform mat4 clip_from_camera;
uniform float height_per_depth;
uniform float nearest;  // m before the eye
uniform vec4 cut_planes[3];  // C: shown where dot(plane, (p, 1)) >= 0
out float gl_ClipDistance[3];
out vec3 f_at;  // along the line from its beginning, across it, its half width there; m
flat out float f_length;
flat out vec3 f_colour;
void main() {
    vec3 a = (camera_from_world * vec4(from_W, 1.0)).xyz, b = (camera_from_world * vec4(to_W, 1.0)).xyz;
    bool is_end = gl_VertexID >= 2;
    float side = gl_VertexID % 2 == 0 ? -1.0 : 1.0;
    vec3 p = is_end ? b : a;
    for (int i = 0; i < 3; ++i) gl_ClipDistance[i] = dot(cut_planes[i], vec4(p, 1.0));
    f_colour = line_colour;
    f_at = vec3(0.0);
    f_length = 0.0;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // not in the picture
    if (half_width == 0.0 || -a.z <= nearest || -b.z <= nearest) return;
    float radius = half_width * height_per_depth * -p.z;
    vec3 sight = normalize(p), way = b - a;
    vec3 seen = way - sight * dot(way, sight);
    f_length = length(seen);
    vec3 along = length(seen) > 1e-7 ? normalize(seen) : normalize(cross(sight, vec3(0.0, 1.0, 0.0)));
    vec3 corner = p + side * radius * cross(sight, along) + (is_end ? radius : -radius) * along;
    f_at = vec3(is_end ? f_length + radius : -radius, side * radius, radius);
    corner *= 1.0 - min(0.5, (2.0 * radius + 1e-4) / length(p));
    gl_Position = clip_from_camera * vec4(corner, 1.0);
}
