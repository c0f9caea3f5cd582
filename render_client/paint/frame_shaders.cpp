#include "render_client/paint/shaders.h"

namespace bonemill::shaders {

const char kShadowVertex[] = R"(
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
)";

const char kDepthFragment[] = "void main() {}\n";

const char kFullScreenVertex[] = R"(
out vec2 uv;
void main() {
    uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
    gl_Position = vec4(uv * 2.0 - 1.0, 1.0, 1.0);
}
)";

const char kBackgroundFragment[] = R"(
in vec2 uv;
out vec4 colour;
void main() {
    vec3 base = mix(vec3(0.055, 0.066, 0.082), vec3(0.165, 0.200, 0.240), smoothstep(0.0, 1.0, uv.y));
    float vignette = 1.0 - 0.45 * dot(uv - 0.5, uv - 0.5);
    // One grey level of ordered noise hides the steps of an 8-bit gradient.
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    colour = vec4(base * vignette + noise / 255.0, 1.0);
}
)";

// This is scalable ambient obscurance (McGuire, Mara, Luebke: High Performance Graphics 2012), from the
// depth buffer alone, at half resolution. The 4 x 4 rotation pattern is averaged out exactly by the 4 x 4
// gather of the composite.
const char kOcclusionFragment[] = R"(
in vec2 uv;
uniform sampler2D depth_map;
uniform vec2 near_far;
uniform vec2 tangents;      // of the half field of view, x and y
uniform float shift;        // x / depth of the picture's middle
uniform float radius;       // m
uniform float max_radius;   // in picture heights
out vec2 occlusion_depth;

const int kSamples = 14;

float eyeDepth(ivec2 texel) {
    float z = texelFetch(depth_map, clamp(texel, ivec2(0), textureSize(depth_map, 0) - 1), 0).r * 2.0 - 1.0;
    return 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x));
}
vec3 position(ivec2 texel, vec2 size) {
    vec2 ndc = (vec2(texel) + 0.5) / size * 2.0 - 1.0;
    float depth = eyeDepth(texel);
    return vec3((ndc * tangents + vec2(shift, 0.0)) * depth, -depth);
}
vec3 nearest(vec3 center, vec3 a, vec3 b) {
    return abs(a.z - center.z) < abs(b.z - center.z) ? a - center : center - b;
}

void main() {
    vec2 size = vec2(textureSize(depth_map, 0));
    ivec2 texel = ivec2(uv * size);
    if (texelFetch(depth_map, texel, 0).r >= 1.0) { occlusion_depth = vec2(1.0, near_far.y); return; }
    vec3 p = position(texel, size);
    vec3 dx = nearest(p, position(texel + ivec2(1, 0), size), position(texel - ivec2(1, 0), size));
    vec3 dy = nearest(p, position(texel + ivec2(0, 1), size), position(texel - ivec2(0, 1), size));
    vec3 normal = normalize(cross(dx, dy));

    float picture_radius = min(radius / (2.0 * tangents.y * -p.z), max_radius);  // in picture heights
    float world_radius = picture_radius * 2.0 * tangents.y * -p.z;
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float turn = float((cell.x * 4 + cell.y * 5 + (cell.x & cell.y)) % 16) / 16.0 * 6.2831853;
    float sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        float along = (float(i) + 0.5) / float(kSamples);
        float angle = along * 6.2831853 * 5.0 + turn;
        vec2 offset = vec2(cos(angle), sin(angle)) * along * picture_radius * size.y;
        vec3 v = position(texel + ivec2(offset), size) - p;
        float squared = dot(v, v);
        float falloff = max(1.0 - squared / (world_radius * world_radius), 0.0);
        float above = dot(v, normal) / (sqrt(squared) + 1e-9) - 0.08;
        sum += falloff * falloff * max(above, 0.0);
    }
    float occlusion = clamp(1.0 - 2.9 * sum / float(kSamples), 0.0, 1.0);
    occlusion_depth = vec2(occlusion, -p.z);
}
)";

const char kCompositeFragment[] = R"(
in vec2 uv;
uniform sampler2D colour_map;
uniform sampler2D depth_map;
uniform sampler2D occlusion_map;
uniform vec2 near_far;
uniform float depth_tolerance;  // m
#ifdef INSTRUMENT
uniform float field_radius;     // of the round field, in picture heights; 0: all of the picture is seen
uniform float focus;            // m
uniform float blur_per_m;       // in picture heights; 0: all is sharp
uniform float most_blur;        // in picture heights
#endif
out vec4 colour;

float depthOf(float stored) {
    float z = stored * 2.0 - 1.0;
    return 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x));
}

#ifdef INSTRUMENT
// The radius of the disc that a point becomes, in pixels.
float blurAt(ivec2 texel, ivec2 size) {
    float stored = texelFetch(depth_map, clamp(texel, ivec2(0), size - 1), 0).r;
    if (stored >= 1.0) return 0.0;  // the background has nothing to blur
    float depth = depthOf(stored);
    return min(abs(depth - focus) * blur_per_m, most_blur) * float(size.y);
}

// Takes from the disc around a pixel what is blurred that far itself, so that nothing sharp bleeds out.
vec3 blurred(vec3 sharp, ivec2 texel) {
    ivec2 size = textureSize(depth_map, 0);
    float radius = blurAt(texel, size);
    if (radius < 0.7) return sharp;
    vec3 sum = sharp;
    float weights = 1.0;
    for (int i = 0; i < 24; ++i) {
        float along = sqrt((float(i) + 0.5) / 24.0) * radius, angle = float(i) * 2.3999632;
        ivec2 other = clamp(texel + ivec2(round(along * vec2(cos(angle), sin(angle)))), ivec2(0), size - 1);
        float weight = smoothstep(along - 1.0, along + 1.0, blurAt(other, size));
        sum += weight * texelFetch(colour_map, other, 0).rgb;
        weights += weight;
    }
    return sum / weights;
}

// What an instrument shows is a disc that darkens towards its rim.
vec3 inRoundField(vec3 shaded, vec2 size) {
    float away = length((uv - 0.5) * size) / size.y;
    float rim = 1.0 - 0.45 * smoothstep(0.55, 1.0, away / field_radius);
    return mix(shaded * rim, vec3(0.012), smoothstep(field_radius - 1.0 / size.y, field_radius + 1.0 / size.y, away));
}
#endif

void main() {
    vec3 shaded = texture(colour_map, uv).rgb;
    vec2 size = vec2(textureSize(depth_map, 0));
    vec2 pixel = uv * size;
    float stored = texelFetch(depth_map, ivec2(pixel), 0).r;
#ifdef INSTRUMENT
    if (blur_per_m > 0.0) shaded = blurred(shaded, ivec2(pixel));
#endif
    if (stored < 1.0) {
        float depth = depthOf(stored);
        ivec2 limit = textureSize(occlusion_map, 0) - 1;
        ivec2 base = ivec2(floor(pixel * 0.5 - 0.5)) - 1;
        float sum = 0.0, weights = 1e-4;
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                vec2 sample_ = texelFetch(occlusion_map, clamp(base + ivec2(x, y), ivec2(0), limit), 0).rg;
                float weight = max(1.0 - abs(sample_.g - depth) / depth_tolerance, 0.0) + 1e-4;
                sum += sample_.r * weight;
                weights += weight;
            }
        float occlusion = sum / weights;
        // Crevices of bone keep a warm tint instead of turning grey.
        shaded *= mix(vec3(0.24, 0.15, 0.11), vec3(1.0), occlusion);
    }
#ifdef INSTRUMENT
    if (field_radius > 0.0) shaded = inRoundField(shaded, size);
#endif
    colour = vec4(shaded, 1.0);
}
)";

// What the tool keeps from the light is multiplied into the finished picture.
const char kToolShadowFragment[] = R"(
in vec2 uv;
uniform sampler2D depth_map;
uniform vec2 near_far;
uniform vec2 tangents;       // of the half field of view, x and y
uniform float shift;         // x / depth of the picture's middle
uniform vec3 key_direction;  // C, towards the light
uniform vec3 burr, shaft;    // C: the burr's centre and the end of a piece of the shaft
uniform vec2 radii;          // m, of burr and shaft
uniform float reach;         // m
out vec4 colour;

vec3 positionOf(ivec2 texel, vec2 size) {
    float z = texelFetch(depth_map, clamp(texel, ivec2(0), ivec2(size) - 1), 0).r * 2.0 - 1.0;
    float depth = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x));
    vec2 ndc = (vec2(texel) + 0.5) / size * 2.0 - 1.0;
    return vec3((ndc * tangents + vec2(shift, 0.0)) * depth, -depth);
}

// How much of the light a rod from a to b keeps away from p: all where the ray to the light meets it near p, less
// farther away. The rod itself has none of its own.
float shadowOfRod(vec3 p, vec3 a, vec3 b, float radius) {
    vec3 along = b - a, to_p = p - a;
    float squared = dot(along, along), slope = dot(along, key_direction), forward = dot(key_direction, to_p);
    float on_rod = clamp(dot(along, to_p) / squared, 0.0, 1.0);
    if (length(to_p - on_rod * along) < 1.04 * radius) return 0.0;
    float at = clamp((dot(along, to_p) - forward * slope) / max(squared - slope * slope, 1e-4 * squared), 0.0, 1.0);
    float ray = max(at * slope - forward, 0.0);
    at = clamp((dot(along, to_p) + ray * slope) / squared, 0.0, 1.0);
    float gap = length(to_p + ray * key_direction - at * along) - radius;
    float soft = 0.10 * radius + 0.10 * ray;
    return (1.0 - smoothstep(-soft, soft, gap)) * (1.0 - smoothstep(0.4, 1.0, ray / reach));
}

void main() {
    vec2 size = vec2(textureSize(depth_map, 0));
    ivec2 texel = ivec2(gl_FragCoord.xy);
    if (texelFetch(depth_map, texel, 0).r >= 1.0) discard;
    vec3 p = positionOf(texel, size);
    float shadow = max(shadowOfRod(p, burr, mix(burr, shaft, 1e-3), radii.x), shadowOfRod(p, burr, shaft, radii.y));
    if (shadow <= 0.0) discard;
    vec3 right = positionOf(texel + ivec2(1, 0), size) - p, left = p - positionOf(texel - ivec2(1, 0), size);
    vec3 up = positionOf(texel + ivec2(0, 1), size) - p, down = p - positionOf(texel - ivec2(0, 1), size);
    vec3 normal = normalize(cross(abs(right.z) < abs(left.z) ? right : left, abs(up.z) < abs(down.z) ? up : down));
    shadow *= smoothstep(0.0, 0.25, dot(normal, key_direction));
    colour = vec4(mix(vec3(1.0), vec3(0.55, 0.50, 0.46), shadow), 1.0);
}
)";

// A half-colour anaglyph takes red from the left eye's brightness, green and blue from the right
// eye. Ivory keeps a hue.
const char kAnaglyphFragment[] = R"(
in vec2 uv;
uniform sampler2D left_eye;
uniform sampler2D right_eye;
out vec4 colour;
void main() {
    float red = dot(texture(left_eye, uv).rgb, vec3(0.299, 0.587, 0.114));
    colour = vec4(red, texture(right_eye, uv).gb, 1.0);
}
)";

}  // namespace bonemill::shaders
