// The light, bone, cut face and structures of the native viewer (render_client/paint/*_shaders.cpp), for WebGL 2: cuts
// throw pixels away instead of clipping triangles, and the mottling of bone comes with its vertices.

export const kLighting = `
uniform vec3 key_direction;   // C, towards the light
uniform float light_reach;    // m from the eye to where its own light is as bright as the room's; 0: the room's
#ifdef SHADOW
uniform sampler2DShadow shadow_map;
uniform float shadow_texel;   // m in the world per texel of the shadow map
uniform mat4 shadow_from_camera;
#endif

const vec3 kKeyColour = vec3(1.00, 0.94, 0.85) * 2.35;
const vec3 kFillColour = vec3(0.60, 0.70, 0.92) * 0.30;
const vec3 kRimColour = vec3(0.75, 0.86, 1.00);
const vec3 kSky = vec3(0.27, 0.29, 0.33);
const vec3 kGround = vec3(0.17, 0.12, 0.09);
const vec3 kFillDirection = vec3(0.873231, -0.154100, 0.462299);

vec3 toneMap(vec3 linear) {
  // The tone curve is Narkowicz' fit of the ACES film curve; then comes the display's gamma.
  vec3 film = (linear * (2.51 * linear + 0.03)) / (linear * (2.43 * linear + 0.59) + 0.14);
  return pow(clamp(film, 0.0, 1.0), vec3(1.0 / 2.2));
}

float keyVisibility(vec3 p_C, vec3 normal) {
#ifdef SHADOW
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
#else
  return 1.0;
#endif
}

float falloff(vec3 p_C) {
  if (light_reach <= 0.0) return 1.0;
  float spot = mix(0.5, 1.0, smoothstep(0.60, 0.97, -normalize(p_C).z));
  return spot * 1.5 / (0.85 + dot(p_C, p_C) / (light_reach * light_reach));
}

vec3 hemisphere(vec3 normal) { return mix(kGround, kSky, 0.5 + 0.5 * normal.y); }
`;

export const kMeshVertex = `
layout(location = 0) in vec3 steps;
layout(location = 1) in vec2 octahedral;
layout(location = 2) in float material;  // 1 + index in the scene's list, 0: none
layout(location = 3) in float mottling;
uniform sampler2D palette;               // per material: linear colour times alpha; alpha 0: it has none
uniform vec3 origin;
uniform float step;
uniform mat4 camera_from_model;
uniform mat4 clip_from_camera;
uniform vec4 cut_planes[3];              // model frame: shown where dot(plane, (p, 1)) >= 0
out vec3 p_C;
out vec3 n_C;
#ifdef MATERIALS
out vec4 surface;                        // linear colour of its own, and how much of it there is
#endif
out float grain;
#ifdef CUT
out vec3 kept;
#endif
invariant gl_Position;

vec3 direction(vec2 uv) {
  vec3 v = vec3(uv, 1.0 - abs(uv.x) - abs(uv.y));
  if (v.z < 0.0) v.xy = (1.0 - abs(v.yx)) * vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0);
  return v;
}

void main() {
  vec4 p_M = vec4(origin + step * steps, 1.0);
  p_C = (camera_from_model * p_M).xyz;
  n_C = mat3(camera_from_model) * direction(octahedral / 127.0);
  gl_Position = clip_from_camera * vec4(p_C, 1.0);
#ifdef MATERIALS
  surface = texelFetch(palette, ivec2(int(material), 0), 0);
#endif
  grain = mottling / 255.0;
#ifdef CUT
  kept = vec3(dot(cut_planes[0], p_M), dot(cut_planes[1], p_M), dot(cut_planes[2], p_M));
#endif
}
`;

const kKept = `
#ifdef CUT
in vec3 kept;
#endif
`;

const kCutAway = `
#ifdef CUT
  if (min(min(kept.x, kept.y), kept.z) < 0.0) discard;
#endif
`;

export const kDepthFragment = `
${kKept}
void main() {
${kCutAway}
}
`;

export const kBoneFragment = `
in vec3 p_C;
in vec3 n_C;
#ifdef MATERIALS
in vec4 surface;
#endif
in float grain;
${kKept}
uniform vec2 opacity;        // facing the eye, and the part of the rest that the outline adds
uniform vec3 inside_colour;  // linear
out vec4 colour;

void main() {
${kCutAway}
  vec3 to_eye = normalize(-p_C);
  vec3 normal = normalize(n_C);
  bool inside = !gl_FrontFacing;  // an open border, or the eye inside the bone
  if (inside) normal = -normal;
  vec3 albedo = mix(vec3(0.69, 0.55, 0.38), vec3(0.82, 0.71, 0.54), grain);
#ifdef MATERIALS
  albedo = albedo * (1.0 - surface.a) + surface.rgb * mix(0.88, 1.12, grain);
#endif
  if (inside) albedo = inside_colour;

  float facing = dot(normal, key_direction);
  float visible = keyVisibility(p_C, normal);
  const float kWrap = 0.12;  // light that bone lets through
  float key = max((facing + kWrap) / (1.0 + kWrap), 0.0) * mix(0.06, 1.0, visible);
  vec3 light = kKeyColour * key + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
  // Light inside the bone gives the edge of the shadow a warm tint.
  light += vec3(0.34, 0.13, 0.05) * key * (1.0 - visible);
  vec3 half_way = normalize(key_direction + to_eye);
  float mirrored = max(dot(normal, half_way), 0.0);
  float gloss = pow(mirrored, 14.0) * 0.11 * visible * step(0.0, facing);
  float grazing = 1.0 - max(dot(normal, to_eye), 0.0);
  float outline = grazing * grazing;
  float rim = outline * outline * (0.35 + 0.65 * max(normal.y, 0.0));
  vec3 shaded = albedo * light * 0.56 + kKeyColour * gloss * 0.4 + kRimColour * rim * 0.16;
  colour = vec4(toneMap(shaded * falloff(p_C)), opacity.x + (1.0 - opacity.x) * opacity.y * outline);
}
`;

// The cut face of bone lies where the line of sight enters what the cut-planes leave. Hatch and mottling are fixed to
// the bone.
export const kCapFragment = `
in vec2 uv;
uniform vec4 cut_planes[3];  // C: shown where dot(plane, (p, 1)) >= 0
uniform vec2 near_far;
uniform vec2 tangents;       // of the half field of view, x and y
uniform mat4 clip_from_camera;
uniform mat4 model_from_camera;
uniform vec3 bone_low, bone_high;  // V
uniform float grain_size;          // m
uniform float opacity;
out vec4 colour;

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

void main() {
  vec3 ray = vec3((uv * 2.0 - 1.0) * tangents, -1.0);
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
  vec3 first = min((bone_low - eye_M) / ray_M, (bone_high - eye_M) / ray_M);
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
`;

export const kStructureFragment = `
in vec3 p_C;
in vec3 n_C;
${kKept}
uniform vec3 structure_colour;  // linear
uniform float glow;             // 0 to 1: the burr is near
uniform bool is_behind;         // bone lies before it
out vec4 colour;

void main() {
${kCutAway}
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
`;
