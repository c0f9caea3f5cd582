#include "render_client/paint/shaders.h"

namespace bonemill::shaders {

const char kStructureFragment[] = R"(
in vec3 p_C;
in vec3 n_C;
in vec3 p_M;
uniform vec3 structure_colour;  // linear
uniform float glow;             // 0 to 1: the burr is near
uniform bool is_behind;         // bone lies before it
out vec4 colour;

void main() {
    vec3 to_eye = normalize(-p_C);
    vec3 normal = normalize(n_C);
    float facing_eye = abs(dot(normal, to_eye));
    vec3 albedo = mix(structure_colour, vec3(1.0), 0.30 * glow);
    float outline = pow(1.0 - facing_eye, 2.0);
    if (is_behind) {
        // Like glass: the outline tells the shape, and bone keeps its own in the middle.
        colour = vec4(toneMap(albedo * (0.75 + 0.35 * facing_eye)), 0.20 + 0.12 * glow + 0.55 * outline);
        return;
    }
    if (!gl_FrontFacing) {  // a cut has opened it
        colour = vec4(toneMap(albedo * 0.55), 1.0);
        return;
    }
    float facing = dot(normal, key_direction);
    float visible = keyVisibility(p_C, normal);
    vec3 light = kKeyColour * max(facing, 0.0) * mix(0.10, 1.0, visible)
               + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    vec3 half_way = normalize(key_direction + to_eye);
    float gloss = pow(max(dot(normal, half_way), 0.0), 30.0) * 0.5 * visible * step(0.0, facing);
    vec3 shaded = albedo * (light * 0.56 + 0.25 * glow) + kKeyColour * gloss * 0.25 + kRimColour * outline * 0.10;
    colour = vec4(toneMap(shaded * falloff(p_C)), 1.0);
}
)";

// The cut face lies where the line of sight enters what the cut-planes leave, as that of bone.
const char kSectionFragment[] = R"(
in vec2 uv;
uniform vec4 cut_planes[3];  // C: shown where dot(plane, (p, 1)) >= 0
uniform vec2 near_far;
uniform vec2 tangents;       // of the half field of view, x and y
uniform float shift;         // x / depth of the picture's middle
uniform mat4 clip_from_camera;
uniform vec3 structure_colour;
uniform float glow;
out vec4 colour;

void main() {
    vec3 ray = vec3((uv * 2.0 - 1.0) * tangents + vec2(shift, 0.0), -1.0);
    float entry = near_far.x;
    for (int i = 0; i < 3; ++i) {
        float closing = dot(cut_planes[i].xyz, ray);
        if (closing > 0.0) entry = max(entry, -cut_planes[i].w / closing);
    }
    vec3 p_C = entry * ray;
    colour = vec4(toneMap(mix(structure_colour, vec3(1.0), 0.30 * glow) * 0.8 * falloff(p_C)), 1.0);
    vec4 clip = clip_from_camera * vec4(p_C, 1.0);
    gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
}
)";

}  // namespace bonemill::shaders
