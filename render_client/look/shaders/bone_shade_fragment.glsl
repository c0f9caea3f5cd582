// Shades what bone_surface_fragment.glsl left, once per pixel; where the samples of a pixel differ, each of them, and what
// no bone covers stays as it is. With `#define SAMPLES` there are so many.
uniform mat4 model_from_camera;
#include "bone_look.glsl"
#include "octahedral.glsl"
#include "sight.glsl"
#ifdef NEAR_STRUCTURES
#include "near_structure.glsl"
#endif
#ifdef SAMPLES
#define Map sampler2DMS
#else
#define SAMPLES 1
#define Map sampler2D
#endif
uniform Map normal_and_scan;   // octahedral normal (0 to 1), what the scan measured
uniform Map material;
uniform Map depth_and_milled;  // m before the eye, negative: seen from within, 0: no bone; whether it was milled
uniform vec2 picture;          // pixels
uniform float grain_size;      // m
out vec4 colour;

ivec2 texel() { return ivec2(gl_FragCoord.xy); }

BonePoint pointAt(int at_sample) {
    vec4 shown = texelFetch(normal_and_scan, texel(), at_sample);
    vec2 depth = texelFetch(depth_and_milled, texel(), at_sample).xy;
    BonePoint point;
    point.inside = depth.x < 0.0;
    point.p_C = sightThrough(gl_FragCoord.xy / picture) * abs(depth.x);
    point.n_C = unitVector(shown.xy * 2.0 - 1.0);
    if (point.inside) point.n_C = -point.n_C;
    point.p_M = (model_from_camera * vec4(point.p_C, 1.0)).xyz;
    vec3 grain = point.p_M / grain_size;
    point.mottling = valueNoise(grain) * 0.65 + valueNoise(grain * 2.7 + 11.0) * 0.35;
    point.material = texelFetch(material, texel(), at_sample);
    point.milled = depth.y;
    point.scanned = shown.zw;
    point.pixel = 3.0 * tangents.y * abs(depth.x) / picture.y;
#ifdef NEAR_STRUCTURES
    point.near = nearStructureAt(point.p_M);
#else
    point.near = vec4(0.0);
#endif
    return point;
}

bool hasBone() {
    for (int i = 0; i < SAMPLES; ++i)
        if (texelFetch(depth_and_milled, texel(), i).x != 0.0) return true;
    return false;
}

// Whether the samples show different surfaces.
bool isEdge(float depth) {
    vec2 normal = texelFetch(normal_and_scan, texel(), 0).xy;
    for (int i = 1; i < SAMPLES; ++i) {
        float other = texelFetch(depth_and_milled, texel(), i).x;
        if (other == 0.0 || other * depth <= 0.0 || abs(other - depth) > 0.01 * abs(depth)) return true;
        vec2 turn = abs(texelFetch(normal_and_scan, texel(), i).xy - normal);
        if (max(turn.x, turn.y) > 0.15) return true;
    }
    return false;
}

void main() {
    float depth = texelFetch(depth_and_milled, texel(), 0).x;
    int count = !hasBone() ? 0 : isEdge(depth) ? SAMPLES : 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < count; ++i) {
        if (texelFetch(depth_and_milled, texel(), i).x == 0.0) continue;
        vec4 look = lookOf(pointAt(i));
        sum += vec4(look.rgb * look.a, look.a);
    }
    if (sum.a == 0.0) discard;
    colour = vec4(sum.rgb / sum.a, sum.a / float(count));
}
