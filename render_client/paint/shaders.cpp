#include "render_client/paint/shaders.h"

namespace bonemill::shaders {

// The light rig is fixed to the camera, so that what one looks at is always lit: a warm key from the upper
// left with a shadow, a cool fill from the right, a rim from behind, and a hemisphere.
const char kLighting[] = R"(
uniform sampler2DShadow shadow_map;
uniform vec3 key_direction;   // C, towards the light
uniform bool has_shadow;
uniform float shadow_texel;   // m in the world per texel of the shadow map
uniform mat4 shadow_from_camera;
uniform float light_reach;    // m from the eye to where its own light is as bright as the room's; 0: the room's

const vec3 kKeyColour = vec3(1.00, 0.94, 0.85) * 2.35;
const vec3 kFillColour = vec3(0.60, 0.70, 0.92) * 0.30;
const vec3 kRimColour = vec3(0.75, 0.86, 1.00);
const vec3 kSky = vec3(0.27, 0.29, 0.33);
const vec3 kGround = vec3(0.17, 0.12, 0.09);
const vec3 kFillDirection = normalize(vec3(0.85, -0.15, 0.45));

vec3 toneMap(vec3 linear) {
    // Narkowicz' fit of the ACES film curve, then the display's gamma.
    vec3 film = (linear * (2.51 * linear + 0.03)) / (linear * (2.43 * linear + 0.59) + 0.14);
    return pow(clamp(film, 0.0, 1.0), vec3(1.0 / 2.2));
}

float keyVisibility(vec3 p_C, vec3 normal) {
    if (!has_shadow) return 1.0;
    vec3 offset = normal * shadow_texel * (1.5 + 2.5 * (1.0 - max(dot(normal, key_direction), 0.0)));
    vec4 clip = shadow_from_camera * vec4(p_C + offset, 1.0);
    vec3 uvw = clip.xyz * 0.5 + 0.5;
    if (any(lessThan(uvw.xy, vec2(0.0))) || any(greaterThan(uvw.xy, vec2(1.0)))) return 1.0;
    uvw.z = clamp(uvw.z, 0.0, 1.0);
    vec2 texel = 1.3 / vec2(textureSize(shadow_map, 0));
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) sum += texture(shadow_map, vec3(uvw.xy + vec2(x, y) * texel, uvw.z));
    return sum / 9.0;
}

float falloff(vec3 p_C) {
    if (light_reach <= 0.0) return 1.0;
    float spot = mix(0.5, 1.0, smoothstep(0.60, 0.97, -normalize(p_C).z));
    return spot * 1.5 / (0.85 + dot(p_C, p_C) / (light_reach * light_reach));
}

vec3 hemisphere(vec3 normal) { return mix(kGround, kSky, 0.5 + 0.5 * normal.y); }
)";

const char kNoise[] = R"(
float hash(vec3 cell) { return fract(sin(dot(cell, vec3(127.1, 311.7, 74.7))) * 43758.5453); }

float valueNoise(vec3 p) {
    vec3 cell = floor(p), f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    vec4 low = vec4(hash(cell), hash(cell + vec3(1, 0, 0)), hash(cell + vec3(0, 1, 0)), hash(cell + vec3(1, 1, 0)));
    cell.z += 1.0;
    vec4 high = vec4(hash(cell), hash(cell + vec3(1, 0, 0)), hash(cell + vec3(0, 1, 0)), hash(cell + vec3(1, 1, 0)));
    vec4 z = mix(low, high, f.z);
    return mix(mix(z.x, z.y, f.x), mix(z.z, z.w, f.x), f.y);
}
)";

const char kMeshVertex[] = R"(
layout(location = 0) in vec3 steps;
layout(location = 1) in vec2 octahedral;
#ifdef MATERIALS
layout(location = 2) in float material;  // 1 + index in the scene's list, 0: none
uniform sampler2D palette;               // per material: linear colour; alpha 0: it has none
out vec4 material_colour;
#endif
uniform vec3 origin;
uniform vec3 step;
uniform mat4 camera_from_model;
uniform mat4 clip_from_camera;
uniform vec4 cut_planes[3];  // model frame: shown where dot(plane, (p, 1)) >= 0
out vec3 p_C;
out vec3 n_C;
out vec3 p_M;
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
#ifdef MATERIALS
    material_colour = texelFetch(palette, ivec2(int(material), 0), 0);
#endif
}
)";

const char kToolVertex[] = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 camera_from_model;
uniform mat4 clip_from_camera;
out vec3 p_C;
out vec3 n_C;
out vec3 p_M;

void main() {
    p_M = position;
    p_C = (camera_from_model * vec4(p_M, 1.0)).xyz;
    n_C = mat3(camera_from_model) * normal;
    gl_Position = clip_from_camera * vec4(p_C, 1.0);
}
)";

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

const char kBoneFragment[] = R"(
in vec3 p_C;
in vec3 n_C;
in vec3 p_M;
uniform float grain_size;    // m, of the faint mottling
uniform vec2 opacity;        // facing the eye, and the part of the rest that the outline adds
uniform vec3 inside_colour;  // linear
#ifdef MATERIALS
in vec4 material_colour;  // colour times alpha, alpha
#endif
out vec4 colour;

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
    if (inside) albedo = inside_colour;
    vec3 sheen = vec3(0.0);
#ifdef FILM
    vec2 lying = inside ? vec2(0.0) : filmAt(p_M);
    if (lying.x + lying.y > 0.0) {  // noise is dear
        float fine = valueNoise(p_M / film_period * 150.0), coarse = valueNoise(p_M / film_period * 48.0 + 5.0);
        float blood = smoothstep(0.10, 0.46, lying.x * (0.55 + 0.55 * fine + 0.45 * coarse));
        float wet = max(smoothstep(0.05, 0.7, lying.y * (0.7 + 0.6 * coarse)), 0.75 * blood);
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
    float gloss = pow(max(dot(normal, half_way), 0.0), 42.0) * 0.34 * visible * step(0.0, facing);
    float rim = pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0) * (0.35 + 0.65 * max(normal.y, 0.0));
    float outline = pow(1.0 - max(dot(normal, to_eye), 0.0), 2.0);
    vec3 shaded = albedo * light * 0.56 + kKeyColour * gloss * 0.4 + kRimColour * rim * 0.16;
    shaded += sheen;
    colour = vec4(toneMap(shaded * falloff(p_C)),
                  opacity.x + (1.0 - opacity.x) * opacity.y * outline);
}
)";

// The cut face of bone, where the line of sight enters what the cut-planes leave. Hatch and mottling are
// fixed to the bone.
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

void main() {
    vec3 ray = vec3((uv * 2.0 - 1.0) * tangents + vec2(shift, 0.0), -1.0);
    float entry = near_far.x;
    vec3 normal = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        float closing = dot(cut_planes[i].xyz, ray);
        float crossing = -cut_planes[i].w / closing;
        if (closing > 0.0 && crossing > entry) {
            entry = crossing;
            normal = -cut_planes[i].xyz;
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
    vec4 clip = clip_from_camera * vec4(p_C, 1.0);
    gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
}
)";

const char kToolFragment[] = R"(
in vec3 p_C;
in vec3 n_C;
in vec3 p_M;
uniform float burr_radius;  // m
uniform vec3 milling_glow;  // linear colour, 0 when idle
out vec4 colour;

float grooveAt(float phase) { return smoothstep(-0.2, -0.9, sin(phase)); }

#ifdef SPIN
uniform float spin_angle;  // rad about +y of T
uniform float spin_sweep;  // rad while the picture is shown
uniform float flutes;
uniform mat4 camera_from_model;

const float kMeanGroove = 0.285;

// The flutes as a shutter that is open between two pictures sees them: groove, and its slope over the phase. From
// half a period per picture on they could seem to turn backwards: nothing of them is left there.
vec2 sweptGroove(float phase) {
    float sweep = flutes * spin_sweep;
    float blur = smoothstep(0.5, 1.0, abs(sweep) / 3.14159265);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 8; ++i) {
        float at = phase - sweep * (float(i) + 0.5) / 8.0;
        sum += vec2(grooveAt(at), grooveAt(at + 0.25) - grooveAt(at - 0.25));
    }
    return mix(sum / 8.0, vec2(kMeanGroove, 0.0), blur);
}
#endif

// A photographer's tent: bright panels over a dark studio, seen in the mirror of the metal.
vec3 studio(vec3 direction) {
    float panel = smoothstep(0.35, 0.75, dot(direction, key_direction));
    float strip = smoothstep(0.80, 0.93, dot(direction, kFillDirection));
    float horizon = smoothstep(-0.25, 0.35, direction.y);
    return mix(vec3(0.05, 0.05, 0.06), vec3(0.50, 0.55, 0.62), horizon) + panel * vec3(1.5, 1.42, 1.3)
         + strip * vec3(0.45, 0.6, 0.9);
}

void main() {
    vec3 to_eye = normalize(-p_C);
    vec3 normal = normalize(n_C);
    if (dot(normal, to_eye) < 0.0) normal = -normal;  // a tool file may have its triangles turned inside out

    float radial = length(p_M) / max(burr_radius, 1e-6);
    float burr = 1.0 - smoothstep(1.03, 1.08, radial);
    float shaft_cut = 1.0 - smoothstep(0.0, 0.25, radial - 1.02);
    // Spiral flutes of a round burr: ridges over the angle about the shaft (+y of T), twisted along it.
    float angle = atan(p_M.z, p_M.x);
    float around = length(p_M.xz) / max(burr_radius, 1e-6);
    float twist = 2.2 * p_M.y / max(burr_radius, 1e-6);
    float fluted = burr * smoothstep(0.15, 0.55, around);
#ifdef SPIN
    vec2 swept = sweptGroove(flutes * (angle + spin_angle) + twist);
    float groove = fluted * swept.x;
    vec3 tangent = mat3(camera_from_model) * (vec3(-p_M.z, 0.0, p_M.x) / max(length(p_M.xz), 1e-6));
    normal = normalize(normal + 0.55 * fluted * swept.y * tangent);
#else
    float groove = fluted * grooveAt(10.0 * angle + twist);
#endif

    vec3 metal = mix(vec3(0.72, 0.74, 0.77), vec3(0.90, 0.78, 0.52), burr);
    vec3 mirror = studio(reflect(-to_eye, normal));
    float visible = keyVisibility(p_C, normal);
    vec3 diffuse = kKeyColour * max(dot(normal, key_direction), 0.0) * visible + hemisphere(normal);
    float fresnel = pow(1.0 - max(dot(normal, to_eye), 0.0), 5.0);
    vec3 shaded = metal * (mirror * mix(0.45, 0.75, visible) + diffuse * 0.16) + fresnel * 0.5;
    shaded *= 1.0 - 0.65 * groove - 0.25 * shaft_cut * (1.0 - burr);
#ifdef SPIN
    // What turns too fast shows rings about the axis.
    float ring = 0.5 + 0.5 * sin(40.0 * p_M.y / max(burr_radius, 1e-6) + 6.0 * sin(17.0 * p_M.y / max(burr_radius, 1e-6)));
    shaded *= 1.0 - 0.22 * fluted * ring * smoothstep(0.5, 1.0, abs(flutes * spin_sweep) / 3.14159265);
#endif
    shaded *= 1.0 - 0.55 * burr * min(dot(milling_glow, vec3(1.0)), 1.0);  // leave room for the glow
    shaded += milling_glow * burr * (0.40 + 0.9 * pow(1.0 - max(dot(normal, to_eye), 0.0), 1.5)) * (1.0 - 0.6 * groove);
    colour = vec4(toneMap(shaded), 1.0);
}
)";

const char kGhostFragment[] = R"(
in vec3 p_C;
in vec3 n_C;
uniform float strength;
out vec4 colour;
void main() {
    float edge = pow(1.0 - abs(dot(normalize(n_C), normalize(-p_C))), 1.5);
    colour = vec4(0.35, 0.80, 1.0, strength * (0.03 + 0.60 * edge * edge));
}
)";

// Scalable ambient obscurance (McGuire, Mara, Luebke: High Performance Graphics 2012), from the depth buffer
// alone, at half resolution. The 4 x 4 rotation pattern is averaged out exactly by the 4 x 4 gather of the
// composite.
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
out vec4 colour;

void main() {
    vec3 shaded = texture(colour_map, uv).rgb;
    vec2 pixel = uv * vec2(textureSize(depth_map, 0));
    float stored = texelFetch(depth_map, ivec2(pixel), 0).r;
    if (stored < 1.0) {
        float z = stored * 2.0 - 1.0;
        float depth = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x));
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
    colour = vec4(shaded, 1.0);
}
)";

// Half-colour: red from the left eye's brightness, green and blue from the right eye. Ivory keeps a hue.
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

const char kParticleVertex[] = R"(
layout(location = 0) in vec3 position;  // C, m
layout(location = 1) in vec2 place;     // along and across the streak, in radii
layout(location = 2) in vec3 streak;    // direction in the picture, half length in radii
layout(location = 3) in vec4 particle_colour;
layout(location = 4) in float particle_gloss;
uniform mat4 clip_from_camera;
out vec3 p_C;
out vec2 f_place;
flat out vec3 f_streak;
flat out vec4 f_colour;
flat out float f_gloss;
void main() {
    p_C = position;
    f_place = place;
    f_streak = streak;
    f_colour = particle_colour;
    f_gloss = particle_gloss;
    gl_Position = clip_from_camera * vec4(position, 1.0);
}
)";

// A ball, or a capsule along the streak, as it would be seen from the front.
const char kParticleFragment[] = R"(
in vec3 p_C;
in vec2 f_place;
flat in vec3 f_streak;
flat in vec4 f_colour;
flat in float f_gloss;
out vec4 colour;

void main() {
    vec2 off = vec2(sign(f_place.x) * max(abs(f_place.x) - f_streak.z, 0.0), f_place.y);
    float squared = dot(off, off);
    if (squared > 1.0) discard;
    // A long streak has no ends to be seen.
    float is_long = smoothstep(0.5, 2.0, f_streak.z);
    float round_x = off.x * (1.0 - is_long);
    vec2 turned = f_streak.xy * round_x + vec2(-f_streak.y, f_streak.x) * off.y;
    vec3 normal = vec3(turned, sqrt(max(1.0 - dot(turned, turned), 0.0)));
    vec3 to_eye = normalize(-p_C);
    float visible = keyVisibility(p_C, normal);
    vec3 light = kKeyColour * max(dot(normal, key_direction), 0.0) * mix(0.1, 1.0, visible)
               + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    vec3 matt = f_colour.rgb * light * 0.56;
    float grazing = pow(1.0 - max(dot(normal, to_eye), 0.0), 3.0);
    float spot = pow(max(dot(normal, normalize(key_direction + to_eye)), 0.0), 60.0);
    vec3 water = f_colour.rgb * (0.18 + 0.7 * grazing) + kKeyColour * spot * 0.8 * visible;
    float cover = mix(1.0, clamp(0.30 + 0.7 * grazing + spot, 0.0, 1.0) / 0.6, f_gloss);
    float edge = 1.0 - smoothstep(0.75, 1.0, squared);
    float ends = 1.0 - abs(f_place.x) / (f_streak.z + 1.0);
    edge *= mix(1.0, smoothstep(0.0, 0.7, ends), is_long);
    colour = vec4(toneMap(mix(matt, water, f_gloss) * falloff(p_C)), clamp(f_colour.a * cover * edge, 0.0, 1.0));
}
)";

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

const char kHudVertex[] = R"(
layout(location = 0) in vec2 position;  // pixels from the upper left corner
layout(location = 1) in vec2 uv;        // glyph: in the font atlas; box: pixels from its centre
layout(location = 2) in vec4 colour;
layout(location = 3) in vec3 box;       // half width, half height, corner radius; radius < 0 marks a glyph
uniform vec2 viewport;
out vec2 f_uv;
out vec4 f_colour;
flat out vec3 f_box;
void main() {
    f_uv = uv;
    f_colour = colour;
    f_box = box;
    gl_Position = vec4(position.x / viewport.x * 2.0 - 1.0, 1.0 - position.y / viewport.y * 2.0, 0.0, 1.0);
}
)";

const char kHudFragment[] = R"(
in vec2 f_uv;
in vec4 f_colour;
flat in vec3 f_box;
uniform sampler2D font;
out vec4 colour;
void main() {
    float cover;
    if (f_box.z < 0.0) {
        cover = texture(font, f_uv).r;
    } else {
        vec2 outside = abs(f_uv) - f_box.xy + f_box.z;
        float distance = length(max(outside, 0.0)) + min(max(outside.x, outside.y), 0.0) - f_box.z;
        cover = clamp(0.5 - distance, 0.0, 1.0);
    }
    colour = vec4(f_colour.rgb, f_colour.a * cover);
}
)";

}  // namespace bonemill::shaders
