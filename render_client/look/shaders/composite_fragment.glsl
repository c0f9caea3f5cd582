#include "depth.glsl"
#include "occlusion_texel.glsl"
in vec2 uv;
uniform sampler2D colour_map;
uniform sampler2D occlusion_map;
uniform float depth_tolerance;  // m
out vec4 colour;

#ifdef INSTRUMENT
#include "round_field.glsl"
uniform float focus;       // m
uniform float blur_per_m;  // in picture heights; 0: all is sharp
uniform float most_blur;   // in picture heights

// The radius of the disc that a point becomes, in pixels.
float blurAt(ivec2 texel, ivec2 size) {
    float stored = storedAt(texel);
    if (stored >= 1.0) return 0.0;  // the background has nothing to blur
    return min(abs(depthOf(stored) - focus) * blur_per_m, most_blur) * float(size.y);
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
#endif

void main() {
    vec2 size = vec2(textureSize(depth_map, 0));
    vec2 pixel = uv * size;
    ivec2 texel = ivec2(pixel);
    vec3 shaded = texelFetch(colour_map, texel, 0).rgb;
    float stored = storedAt(texel);
#ifdef INSTRUMENT
    if (blur_per_m > 0.0) shaded = blurred(shaded, texel);
#endif
    if (stored < 1.0) {
        float depth = depthOf(stored);
        ivec2 limit = textureSize(occlusion_map, 0) - 1;
        ivec2 base = ivec2(floor(pixel * 0.5 - 0.5)) - 1;
        // What has no neighbour of its depth is open.
        float sum = 1e-4, weights = 1e-4, per_metre = 1.0 / depth_tolerance;
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                vec2 other = openAndDepth(texelFetch(occlusion_map, clamp(base + ivec2(x, y), ivec2(0), limit), 0));
                float weight = max(1.0 - abs(other.y - depth) * per_metre, 0.0);
                sum += other.x * weight;
                weights += weight;
            }
        float occlusion = sum / weights;
        // Crevices of bone keep a warm tint instead of turning grey.
        shaded *= mix(vec3(0.24, 0.15, 0.11), vec3(1.0), occlusion);
    }
#ifdef INSTRUMENT
    if (field_radius > 0.0) shaded = inRoundField(shaded, uv, size);
#endif
    colour = vec4(shaded, 1.0);
}
