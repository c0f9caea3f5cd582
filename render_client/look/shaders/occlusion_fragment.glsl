// This is scalable ambient obscurance (McGuire, Mara, Luebke: High Performance Graphics 2012), from the depth buffer
// alone, at half resolution. The 4 x 4 rotation pattern is averaged out exactly by the 4 x 4 gather of the composite.
#include "position.glsl"
#include "occlusion_texel.glsl"
in vec2 uv;
uniform float radius;      // m
uniform float max_radius;  // in picture heights
out vec4 occlusion_depth;

const int kSamples = 14;

void main() {
    vec2 size = vec2(textureSize(depth_map, 0));
    ivec2 texel = ivec2(uv * size);
    if (storedAt(texel) >= 1.0) { occlusion_depth = occlusionTexel(1.0, near_far.y); return; }
    vec3 p = positionOf(texel, size);
    vec3 normal = normalOf(p, texel, size);

    float picture_radius = min(radius / (2.0 * tangents.y * -p.z), max_radius);  // in picture heights
    float world_radius = picture_radius * 2.0 * tangents.y * -p.z;
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float turn = float((cell.x * 4 + cell.y * 5 + (cell.x & cell.y)) % 16) / 16.0 * 6.2831853;
    // The samples lie on a spiral; each direction is the one before, turned: sines of each would be dear.
    const float kStep = 6.2831853 * 5.0 / float(kSamples);
    mat2 turning = mat2(cos(kStep), sin(kStep), -sin(kStep), cos(kStep));
    vec2 direction = vec2(cos(turn + 0.5 * kStep), sin(turn + 0.5 * kStep));
    float sum = 0.0, per_squared = 1.0 / (world_radius * world_radius);
    for (int i = 0; i < kSamples; ++i, direction = turning * direction) {
        float along = (float(i) + 0.5) / float(kSamples);
        vec2 offset = direction * (along * picture_radius * size.y);
        vec3 v = positionOf(texel + ivec2(offset), size) - p;
        float squared = dot(v, v);
        float falloff = max(1.0 - squared * per_squared, 0.0);
        float above = dot(v, normal) / (sqrt(squared) + 1e-9) - 0.08;
        sum += falloff * falloff * max(above, 0.0);
    }
    occlusion_depth = occlusionTexel(clamp(1.0 - 2.9 * sum / float(kSamples), 0.0, 1.0), -p.z);
}
