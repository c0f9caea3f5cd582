#include "render_client/paint/shaders.h"

namespace bonemill::shaders {

const char kMarkerVertex[] = R"(
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
)";

const char kMarkerFragment[] = R"(
in vec3 f_normal;
in vec4 f_colour;
uniform float strength;
out vec4 colour;
void main() {
    float shade = 1.0;
    if (dot(f_normal, f_normal) > 0.25) shade = 0.62 + 0.38 * max(dot(normalize(f_normal), normalize(vec3(-0.4, 0.6, 0.7))), 0.0);
    colour = vec4(f_colour.rgb * shade, f_colour.a * strength);
}
)";

}  // namespace bonemill::shaders
