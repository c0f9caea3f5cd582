#include "render_client/paint/shaders.h"

namespace bonemill::shaders {

const char kMeshVertex[] = R"(
layout(location = 0) in vec3 steps;
layout(location = 1) in vec2 octahedral;
#ifdef MATERIALS
layout(location = 2) in float material;  // 1 + index in the scene's list, 0: none
uniform sampler2D palette;               // per material: linear colour; alpha 0: it has none
out vec4 material_colour;
#endif
#ifdef THICKNESS
uniform sampler3D thickness;     // share of the reach
uniform vec3 thickness_first;    // V, m: of the texture's first corner
uniform vec3 thickness_extent;   // m: of the texture
out float share_to_structure;
#endif
uniform vec3 origin;
uniform vec3 step;
uniform mat4 camera_from_model;
uniform mat4 clip_from_camera;
uniform vec4 cut_planes[3];  // model frame: shown where dot(plane, (p, 1)) >= 0
layout(location = 3) in vec2 scan;  // its density (0 to 1) where milling opened the bone; whether it did
out vec3 p_C;
out vec3 n_C;
out vec3 p_M;
out vec2 scanned;
out float gl_ClipDistance[3];
invariant gl_Position;  // a layer is found by its depth first and then drawn where the depth is equal

vec3 unitVector(vec2 uv) {
    vec3 v = vec3(uv, 1.0 - abs(uv.x) - abs(uv.y));
    if (v.z < 0.0) v.xy = (1.0 - abs(v.yx)) * vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0);
    return normalize(v);
}

void main() {
    p_M = origin + step * steps;
    p_C = (camera_from_model * vec4(p_M, 1.0)).xyz;
    n_C = mat3(camera_from_model) * unitVector(octahedral / 127.0);
    gl_Position = clip_from_camera * vec4(p_C, 1.0);
    for (int i = 0; i < 3; ++i) gl_ClipDistance[i] = dot(cut_planes[i], vec4(p_M, 1.0));
    scanned = vec2(scan.x * scan.y, scan.y);
#ifdef MATERIALS
    material_colour = texelFetch(palette, ivec2(int(material), 0), 0);
#endif
#ifdef THICKNESS
    vec3 at = (p_M - thickness_first) / thickness_extent;
    bool is_near = all(greaterThan(at, vec3(0.0))) && all(lessThan(at, vec3(1.0)));
    share_to_structure = is_near ? textureLod(thickness, at, 0.0).r : 1.0;
#endif
}
)";

const char kBoneFragment[] = R"(
in vec3 p_C;
in vec3 n_C;
in vec3 p_M;
in vec2 scanned;
uniform vec2 grey_of_density;  // of the scan: factor, and what is added
uniform bool shows_scan;
uniform float grain_size;    // m, of the faint mottling
uniform vec2 opacity;        // facing the eye, and the part of the rest that the outline adds
uniform vec3 inside_colour;  // linear
#ifdef MATERIALS
in vec4 material_colour;  // colour times alpha, alpha
#endif
out vec4 colour;

#ifdef THICKNESS
in float share_to_structure;
uniform vec3 thickness_colours[5];  // linear, from 0 to the reach

vec3 thicknessColour(float share) {
    float at = clamp(share, 0.0, 1.0) * 4.0;
    int low = min(int(at), 3);
    return mix(thickness_colours[low], thickness_colours[low + 1], at - float(low));
}
#endif

#ifdef FILM
uniform sampler3D film;            // blood, water; repeats
uniform float film_period;         // m, V
uniform vec3 film_low, film_high;  // V, of what the texture holds now
uniform vec2 film_strength;
uniform vec3 blood_colour;         // linear

vec2 filmAt(vec3 p) {
    if (any(lessThan(p, film_low)) || any(greaterThan(p, film_high))) return vec2(0.0);
    return texture(film, p / film_period).rg * film_strength;
}
#endif

void main() {
    vec3 to_eye = normalize(-p_C);
    vec3 normal = normalize(n_C);
    bool inside = !gl_FrontFacing;  // an open border, or the eye inside the bone
    if (inside) normal = -normal;

    float mottling = valueNoise(p_M / grain_size) * 0.65 + valueNoise(p_M / grain_size * 2.7 + 11.0) * 0.35;
    vec3 albedo = mix(vec3(0.69, 0.55, 0.38), vec3(0.82, 0.71, 0.54), mottling);
#ifdef MATERIALS
    albedo = albedo * (1.0 - material_colour.a) + material_colour.rgb * mix(0.88, 1.12, mottling);
#endif
    if (shows_scan && scanned.y > 0.0) {
        float grey = clamp(scanned.x / scanned.y * grey_of_density.x + grey_of_density.y, 0.0, 1.0);
        albedo = mix(albedo, vec3(pow(grey, 2.2)), scanned.y);
    }
#ifdef THICKNESS
    albedo = mix(thicknessColour(share_to_structure), albedo, smoothstep(0.85, 1.0, share_to_structure));
#endif
    if (inside) albedo = inside_colour;
    vec3 sheen = vec3(0.0);
    float wetness = 0.0;
#ifdef FILM
    vec2 lying = inside ? vec2(0.0) : filmAt(p_M);
    if (lying.x + lying.y > 0.0) {  // noise is dear
        float fine = valueNoise(p_M / film_period * 150.0), coarse = valueNoise(p_M / film_period * 48.0 + 5.0);
        float blood = smoothstep(0.10, 0.46, lying.x * (0.55 + 0.55 * fine + 0.45 * coarse));
        float wet = max(smoothstep(0.05, 0.7, lying.y * (0.7 + 0.6 * coarse)), 0.75 * blood);
        wetness = wet;
        albedo = mix(albedo * (1.0 - 0.34 * wet), blood_colour * (0.75 + 0.45 * coarse), 0.95 * blood);
        // The film's own surface is smoother than bone, but ripples.
        vec3 ripple = vec3(fine, coarse, valueNoise(p_M / film_period * 90.0 + 9.0)) - 0.5;
        vec3 film_normal = normalize(normal + 0.16 * ripple);
        float grazing = pow(1.0 - max(dot(film_normal, to_eye), 0.0), 4.0);
        vec3 film_mirror = reflect(-to_eye, film_normal);
        float panel = smoothstep(0.88, 0.99, dot(film_mirror, key_direction));
        float strip = smoothstep(0.86, 0.96, dot(film_mirror, kFillDirection));
        sheen = wet * (0.04 + 0.80 * grazing) * kSky + wet * 0.16 * panel * kKeyColour * keyVisibility(p_C, normal)
              + wet * 0.05 * strip * vec3(0.6, 0.8, 1.0);
    }
#endif

    float facing = dot(normal, key_direction);
    float visible = keyVisibility(p_C, normal);
    const float kWrap = 0.12;  // light that bone lets through
    float key = max((facing + kWrap) / (1.0 + kWrap), 0.0) * mix(0.06, 1.0, visible);
    vec3 light = kKeyColour * key + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    // Light inside the bone gives the edge of the shadow a warm tint.
    light += vec3(0.34, 0.13, 0.05) * key * (1.0 - visible);

    vec3 half_way = normalize(key_direction + to_eye);
    // Dry bone is matt: a broad, faint shine. A wet one has the film's narrow highlight.
    float mirrored = max(dot(normal, half_way), 0.0);
    float gloss = mix(pow(mirrored, 14.0) * 0.11, pow(mirrored, 90.0) * 1.1, wetness) * visible * step(0.0, facing);
    float rim = pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0) * (0.35 + 0.65 * max(normal.y, 0.0));
    float outline = pow(1.0 - max(dot(normal, to_eye), 0.0), 2.0);
    vec3 shaded = albedo * light * 0.56 + kKeyColour * gloss * 0.4 + kRimColour * rim * 0.16;
    shaded += sheen;
    colour = vec4(toneMap(shaded * falloff(p_C)),
                  opacity.x + (1.0 - opacity.x) * opacity.y * outline);
}
)";

// The cut face of bone lies where the line of sight enters what the cut-planes leave. Hatch and mottling
// are fixed to the bone.
const char kCapFragment[] = R"(
in vec2 uv;
uniform vec4 cut_planes[3];  // C: shown where dot(plane, (p, 1)) >= 0
uniform vec2 near_far;
uniform vec2 tangents;       // of the half field of view, x and y
uniform float shift;         // x / depth of the picture's middle
uniform mat4 clip_from_camera;
uniform mat4 model_from_camera;
uniform vec3 bone_low, bone_high;  // V
uniform float grain_size;          // m
uniform float opacity;
out vec4 colour;

#ifdef CT
uniform sampler2D ct_x, ct_y, ct_z;  // of the cut across W's x, y, z: density where it is known; whether it is
uniform mat4 ct_from_model[3];       // to the textures' (u, v)
uniform vec2 grey_of_density;        // factor, and what is added

vec2 ctAt(int cut, vec3 p_M) {
    vec2 at = (ct_from_model[cut] * vec4(p_M, 1.0)).xy;
    if (cut == 0) return textureLod(ct_x, at, 0.0).rg;
    if (cut == 1) return textureLod(ct_y, at, 0.0).rg;
    return textureLod(ct_z, at, 0.0).rg;
}
#endif

void main() {
    int cut = 0;
    vec3 ray = vec3((uv * 2.0 - 1.0) * tangents + vec2(shift, 0.0), -1.0);
    float entry = near_far.x;
    vec3 normal = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        float closing = dot(cut_planes[i].xyz, ray);
        float crossing = -cut_planes[i].w / closing;
        if (closing > 0.0 && crossing > entry) {
            entry = crossing;
            normal = -cut_planes[i].xyz;
            cut = i;
        }
    }
    if (normal == vec3(0.0)) discard;  // the eye is inside the bone

    vec3 eye_M = model_from_camera[3].xyz, ray_M = mat3(model_from_camera) * ray;
    vec3 low = (bone_low - eye_M) / ray_M, high = (bone_high - eye_M) / ray_M;
    vec3 first = min(low, high);
    if (max(max(first.x, first.y), first.z) > entry) discard;  // through the scan's open border

    vec3 p_C = entry * ray;
    vec3 p_M = eye_M + entry * ray_M;
    float mottling = valueNoise(p_M / grain_size * 1.6) * 0.6 + valueNoise(p_M / grain_size * 5.0) * 0.4;
    vec3 albedo = mix(vec3(0.52, 0.20, 0.15), vec3(0.78, 0.44, 0.34), mottling);
    float across = (p_M.x + p_M.y + p_M.z) / grain_size * 2.2;
    float soft = fwidth(across);
    float line = smoothstep(0.5 - soft, 0.5, abs(fract(across) - 0.5) + 0.10);
    albedo *= 1.0 - 0.16 * line * (1.0 - smoothstep(0.25, 0.6, soft));

    float facing = max(dot(normal, key_direction), 0.0);
    float visible = keyVisibility(p_C, normal);
    vec3 light = kKeyColour * facing * mix(0.06, 1.0, visible)
               + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    // A section is read by its outline, not by its tilt towards the light.
    light = mix(light, vec3(1.25), 0.35);
    colour = vec4(toneMap(albedo * light * falloff(p_C) * 0.56), opacity);
#ifdef CT
    // Grey is as the window says, whatever the light; a shadow is hinted at.
    vec2 ct = ctAt(cut, p_M);
    float grey = clamp(ct.r / max(ct.g, 1e-3) * grey_of_density.x + grey_of_density.y, 0.0, 1.0);
    colour.rgb = mix(colour.rgb, vec3(grey * mix(0.72, 1.0, visible)), smoothstep(0.0, 0.5, ct.g));
#endif
    vec4 clip = clip_from_camera * vec4(p_C, 1.0);
    gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
}
)";

}  // namespace bonemill::shaders
