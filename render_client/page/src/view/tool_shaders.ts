// Tool, ghost and signs of the native viewer (render_client/paint/tool_shaders.cpp, marker_shaders.cpp).

export const kToolVertex = `
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
`;

export const kToolFragment = `
in vec3 p_C;
in vec3 n_C;
in vec3 p_M;
uniform float burr_radius;  // m
uniform vec3 milling_glow;  // linear colour, 0 when idle
out vec4 colour;

float grooveAt(float phase) { return 1.0 - smoothstep(-0.9, -0.2, sin(phase)); }

// The metal mirrors a photographer's tent: bright panels over a dark studio.
vec3 studio(vec3 direction) {
  if (light_reach > 0.0)  // within a body there is an endoscope's own light, and what the bone throws back
    return vec3(0.16, 0.13, 0.11) + smoothstep(0.55, 0.95, dot(direction, key_direction)) * kKeyColour * 0.5;
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
  // A round burr has spiral flutes: ridges over the angle about the shaft (+y of T), twisted along it.
  float angle = atan(p_M.z, p_M.x);
  float around = length(p_M.xz) / max(burr_radius, 1e-6);
  float twist = 2.2 * p_M.y / max(burr_radius, 1e-6);
  float groove = burr * smoothstep(0.15, 0.55, around) * grooveAt(10.0 * angle + twist);
  vec3 metal = mix(vec3(0.72, 0.74, 0.77), vec3(0.90, 0.78, 0.52), burr);
  vec3 mirror = studio(reflect(-to_eye, normal));
  float visible = keyVisibility(p_C, normal);
  vec3 diffuse = kKeyColour * max(dot(normal, key_direction), 0.0) * visible + hemisphere(normal);
  float fresnel = pow(1.0 - max(dot(normal, to_eye), 0.0), 5.0);
  vec3 shaded = metal * (mirror * mix(0.45, 0.75, visible) + diffuse * 0.16) + fresnel * (light_reach > 0.0 ? 0.05 : 0.5);
  shaded *= 1.0 - 0.65 * groove - 0.25 * shaft_cut * (1.0 - burr);
  shaded *= 1.0 - 0.55 * burr * min(dot(milling_glow, vec3(1.0)), 1.0);  // leave room for the glow
  shaded += milling_glow * burr * (0.40 + 0.9 * pow(1.0 - max(dot(normal, to_eye), 0.0), 1.5)) * (1.0 - 0.6 * groove);
  colour = vec4(toneMap(shaded * min(falloff(p_C), 1.0)), 1.0);
}
`;

export const kGhostFragment = `
in vec3 p_C;
in vec3 n_C;
uniform float strength;
out vec4 colour;
void main() {
  float edge = pow(1.0 - abs(dot(normalize(n_C), normalize(-p_C))), 1.5);
  colour = vec4(0.35, 0.80, 1.0, strength * (0.03 + 0.60 * edge * edge));
}
`;

export const kMarkerVertex = `
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
`;

export const kMarkerFragment = `
in vec3 f_normal;
in vec4 f_colour;
uniform float strength;
out vec4 colour;
void main() {
  float shade = 1.0;
  if (dot(f_normal, f_normal) > 0.25) shade = 0.62 + 0.38 * max(dot(normalize(f_normal), normalize(vec3(-0.4, 0.6, 0.7))), 0.0);
  colour = vec4(f_colour.rgb * shade, f_colour.a * strength);
}
`;
