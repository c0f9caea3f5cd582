// The cut face of bone. Hatch and mottling are fixed to the bone.
#include "lighting.glsl"
#include "noise.glsl"
#include "cut_entry.glsl"
uniform mat4 model_from_camera;
uniform vec3 bone_low, bone_high;  // V
uniform float grain_size;          // m
uniform float opacity;
out vec4 colour;

#ifdef CT
uniform bool shows_materials;
// Of the cut across W's x, y, z, as far as it is known: density and whether it is, or linear colour and whether it is.
uniform sampler2D ct_x, ct_y, ct_z;
uniform mat4 ct_from_model[3];       // to the textures' (u, v)
uniform vec2 grey_of_density;        // factor, and what is added

vec4 ctAt(int cut, vec3 p_M) {
    vec2 at = (ct_from_model[cut] * vec4(p_M, 1.0)).xy;
    if (cut == 0) return textureLod(ct_x, at, 0.0);
    if (cut == 1) return textureLod(ct_y, at, 0.0);
    return textureLod(ct_z, at, 0.0);
}
#endif

void main() {
    CutEntry entry = cutEntry();
    vec3 normal = entry.normal;
    if (normal == vec3(0.0)) discard;  // the eye is inside the bone

    vec3 eye_M = model_from_camera[3].xyz, ray_M = mat3(model_from_camera) * entry.ray;
    vec3 first = min((bone_low - eye_M) / ray_M, (bone_high - eye_M) / ray_M);
    if (max(max(first.x, first.y), first.z) > entry.depth) discard;  // through the scan's open border

    vec3 p_C = entry.depth * entry.ray;
    vec3 p_M = eye_M + entry.depth * ray_M;
    float mottling = valueNoise(p_M / grain_size * 1.6) * 0.6 + valueNoise(p_M / grain_size * 5.0) * 0.4;
    vec3 albedo = mix(vec3(0.52, 0.20, 0.15), vec3(0.78, 0.44, 0.34), mottling);
    float across = (p_M.x + p_M.y + p_M.z) / grain_size * 2.2;
    float soft = fwidth(across);
    float line = smoothstep(0.5 - soft, 0.5, abs(fract(across) - 0.5) + 0.10);
    albedo *= 1.0 - 0.16 * line * (1.0 - smoothstep(0.25, 0.6, soft));

#ifdef CT
    vec4 ct = ctAt(entry.cut, p_M);
    if (shows_materials)
        albedo = mix(albedo, ct.rgb / max(ct.a, 1e-3) * mix(0.88, 1.12, mottling), smoothstep(0.0, 0.5, ct.a));
#endif

    float facing = max(dot(normal, key_direction), 0.0);
    float visible = keyVisibility(p_C, normal);
    vec3 light = kKeyColour * facing * mix(0.06, 1.0, visible)
               + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    // A section is read by its outline, not by its tilt towards the light.
    light = mix(light, vec3(1.25), 0.35);
    colour = vec4(toneMap(albedo * light * falloff(p_C) * 0.56), opacity);
#ifdef CT
    // Grey is as the window says, whatever the light; a shadow is hinted at.
    float grey = clamp(ct.r / max(ct.g, 1e-3) * grey_of_density.x + grey_of_density.y, 0.0, 1.0);
    if (!shows_materials)
        colour.rgb = mix(colour.rgb, vec3(grey * mix(0.72, 1.0, visible)), smoothstep(0.0, 0.5, ct.g));
#endif
    gl_FragDepth = storedDepth(p_C);
}
