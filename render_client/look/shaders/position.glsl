#include "depth.glsl"
#include "sight.glsl"

// What is seen in a texel of the depth map, C.
vec3 positionOf(ivec2 texel, vec2 size) { return sightThrough((vec2(texel) + 0.5) / size) * depthOf(storedAt(texel)); }

// Of the surface in p, over the neighbours that are as deep.
vec3 nearest(vec3 p, vec3 a, vec3 b) { return abs(a.z - p.z) < abs(b.z - p.z) ? a - p : p - b; }
vec3 normalOf(vec3 p, ivec2 texel, vec2 size) {
    vec3 dx = nearest(p, positionOf(texel + ivec2(1, 0), size), positionOf(texel - ivec2(1, 0), size));
    vec3 dy = nearest(p, positionOf(texel + ivec2(0, 1), size), positionOf(texel - ivec2(0, 1), size));
    return normalize(cross(dx, dy));
}
