// What the tool keeps from the light is multiplied into the finished picture.
#include "position.glsl"
in vec2 uv;
uniform vec3 key_direction;  // C, towards the light
uniform vec3 burr, shaft;    // C: the burr's centre and the end of a piece of the shaft
uniform vec2 radii;          // m, of burr and shaft
uniform float reach;         // m
out vec4 colour;

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
    ivec2 texel = ivec2(uv * size);
    if (storedAt(texel) >= 1.0) discard;
    vec3 p = positionOf(texel, size);
    float shadow = max(shadowOfRod(p, burr, mix(burr, shaft, 1e-3), radii.x), shadowOfRod(p, burr, shaft, radii.y));
    if (shadow <= 0.0) discard;
    shadow *= smoothstep(0.0, 0.25, dot(normalOf(p, texel, size), key_direction));
    colour = vec4(mix(vec3(1.0), vec3(0.55, 0.50, 0.46), shadow), 1.0);
}
