// Background, ambient occlusion, composite and the copy of a finished layer; after render_client/paint/frame_shaders.cpp.

export const kFullScreenVertex = `
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(uv * 2.0 - 1.0, 1.0, 1.0);
}
`;

export const kBackgroundFragment = `
in vec2 uv;
out vec4 colour;
void main() {
  vec3 base = mix(vec3(0.055, 0.066, 0.082), vec3(0.165, 0.200, 0.240), smoothstep(0.0, 1.0, uv.y));
  float vignette = 1.0 - 0.45 * dot(uv - 0.5, uv - 0.5);
  // One grey level of ordered noise hides the steps of an 8-bit gradient.
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
  colour = vec4(base * vignette + noise / 255.0, 1.0);
}
`;

// Scalable ambient obscurance from the depth at half resolution. Beside the occlusion stands the depth, in 16 bits of
// the way from near to far.
export const kOcclusionFragment = `
in vec2 uv;
uniform sampler2D depth_map;
uniform vec2 near_far;
uniform vec2 tangents;      // of the half field of view, x and y
uniform float radius;       // m
uniform float max_radius;   // in picture heights
out vec4 occlusion_depth;

const int kSamples = 14;

float eyeDepth(ivec2 texel) {
  float z = texelFetch(depth_map, clamp(texel, ivec2(0), textureSize(depth_map, 0) - 1), 0).r * 2.0 - 1.0;
  return 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x));
}
vec3 position(ivec2 texel, vec2 size) {
  vec2 ndc = (vec2(texel) + 0.5) / size * 2.0 - 1.0;
  float depth = eyeDepth(texel);
  return vec3(ndc * tangents * depth, -depth);
}
vec3 nearest(vec3 center, vec3 a, vec3 b) {
  return abs(a.z - center.z) < abs(b.z - center.z) ? a - center : center - b;
}
vec4 packed(float occlusion, float depth) {
  float share = clamp((depth - near_far.x) / (near_far.y - near_far.x), 0.0, 1.0) * 255.0;
  return vec4(occlusion, floor(share) / 255.0, fract(share), 1.0);
}

void main() {
  vec2 size = vec2(textureSize(depth_map, 0));
  ivec2 texel = ivec2(uv * size);
  if (texelFetch(depth_map, texel, 0).r >= 1.0) { occlusion_depth = packed(1.0, near_far.y); return; }
  vec3 p = position(texel, size);
  vec3 dx = nearest(p, position(texel + ivec2(1, 0), size), position(texel - ivec2(1, 0), size));
  vec3 dy = nearest(p, position(texel + ivec2(0, 1), size), position(texel - ivec2(0, 1), size));
  vec3 normal = normalize(cross(dx, dy));
  float picture_radius = min(radius / (2.0 * tangents.y * -p.z), max_radius);
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
  occlusion_depth = packed(clamp(1.0 - 2.9 * sum / float(kSamples), 0.0, 1.0), -p.z);
}
`;

export const kCompositeFragment = `
in vec2 uv;
uniform sampler2D colour_map;
uniform sampler2D depth_map;
uniform sampler2D occlusion_map;
uniform vec2 near_far;
uniform float depth_tolerance;  // m
out vec4 colour;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec3 shaded = texelFetch(colour_map, texel, 0).rgb;
  float stored = texelFetch(depth_map, texel, 0).r;
  if (stored < 1.0) {
    float z = stored * 2.0 - 1.0;
    float depth = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x));
    ivec2 limit = textureSize(occlusion_map, 0) - 1;
    ivec2 base = ivec2(floor(gl_FragCoord.xy * 0.5 - 0.5)) - 1;
    float sum = 0.0, weights = 1e-4;
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        vec3 other = texelFetch(occlusion_map, clamp(base + ivec2(x, y), ivec2(0), limit), 0).rgb;
        float other_depth = near_far.x + (other.g + other.b / 255.0) * (near_far.y - near_far.x);
        float weight = max(1.0 - abs(other_depth - depth) / depth_tolerance, 0.0) + 1e-4;
        sum += other.r * weight;
        weights += weight;
      }
    // Crevices of bone keep a warm tint instead of turning grey.
    shaded *= mix(vec3(0.24, 0.15, 0.11), vec3(1.0), sum / weights);
  }
  colour = vec4(shaded, 1.0);
}
`;

// A finished layer comes onto the canvas, with its depth; it may have fewer pixels.
export const kCopyFragment = `
in vec2 uv;
uniform sampler2D colour_map;
uniform sampler2D depth_map;
uniform float field_radius;     // of the round field, in picture heights; 0: all of the picture is seen
uniform float aspect;
out vec4 colour;
void main() {
  vec3 shaded = texture(colour_map, uv).rgb;
  if (field_radius > 0.0) {
    // What an instrument shows is a disc that darkens towards its rim.
    float away = length((uv - 0.5) * vec2(aspect, 1.0));
    float rim = 1.0 - 0.45 * smoothstep(0.55, 1.0, away / field_radius);
    shaded = mix(shaded * rim, vec3(0.012), smoothstep(field_radius - 0.002, field_radius + 0.002, away));
  }
  colour = vec4(shaded, 1.0);
  gl_FragDepth = texture(depth_map, uv).r;
}
`;

// One pixel's depth, in 24 bits.
export const kPickFragment = `
uniform sampler2D depth_map;
uniform vec2 at;  // texel
out vec4 colour;
void main() {
  float depth = texelFetch(depth_map, ivec2(at), 0).r * 255.0;
  float second = fract(depth) * 255.0;
  colour = vec4(floor(depth) / 255.0, floor(second) / 255.0, fract(second), 1.0);
}
`;

// What the tool keeps from the light is multiplied into the finished layer.
export const kToolShadowFragment = `
in vec2 uv;
uniform sampler2D depth_map;
uniform vec2 near_far;
uniform vec2 tangents;       // of the half field of view, x and y
uniform vec3 key_direction;  // C, towards the light
uniform vec3 burr, shaft;    // C: the burr's centre and the end of a piece of the shaft
uniform vec2 radii;          // m, of burr and shaft
uniform float reach;         // m
out vec4 colour;

vec3 positionOf(ivec2 texel, vec2 size) {
  float z = texelFetch(depth_map, clamp(texel, ivec2(0), ivec2(size) - 1), 0).r * 2.0 - 1.0;
  float depth = 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - z * (near_far.y - near_far.x));
  return vec3(((vec2(texel) + 0.5) / size * 2.0 - 1.0) * tangents * depth, -depth);
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
  ivec2 texel = ivec2(uv * size);
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
`;
