#include "lighting.glsl"
in vec3 p_C;
in vec3 n_C;
in vec3 p_M;
uniform float burr_radius;  // m
uniform vec3 milling_glow;  // linear colour, 0 when idle
out vec4 colour;

float grooveAt(float phase) { return 1.0 - smoothstep(-0.9, -0.2, sin(phase)); }

#ifdef SPIN
uniform float spin_angle;  // rad about +y of T
uniform float spin_sweep;  // rad while the picture is shown
uniform float flutes;
uniform mat4 camera_from_model;

const float kMeanGroove = 0.285;

// A shutter that is open between two pictures sees the flutes so: as groove, and its slope over the phase.
// From half a period per picture on they could seem to turn backwards, so nothing of them is left there.
vec2 sweptGroove(float phase) {
    float sweep = flutes * spin_sweep;
    float blur = smoothstep(0.5, 1.0, abs(sweep) / 3.14159265);
    vec2 sum = vec2(0.0);
    for (int i = 0, count = blur < 1.0 ? 8 : 0; i < count; ++i) {
        float at = phase - sweep * (float(i) + 0.5) / 8.0;
        sum += vec2(grooveAt(at), grooveAt(at + 0.25) - grooveAt(at - 0.25));
    }
    return mix(sum / 8.0, vec2(kMeanGroove, 0.0), blur);
}
#endif

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
    vec3 shaded = metal * (mirror * mix(0.45, 0.75, visible) + diffuse * 0.16) + fresnel * (light_reach > 0.0 ? 0.05 : 0.5);
    shaded *= 1.0 - 0.65 * groove - 0.25 * shaft_cut * (1.0 - burr);
#ifdef SPIN
    // What turns too fast shows rings about the axis.
    float ring = 0.5 + 0.5 * sin(40.0 * p_M.y / max(burr_radius, 1e-6) + 6.0 * sin(17.0 * p_M.y / max(burr_radius, 1e-6)));
    shaded *= 1.0 - 0.22 * fluted * ring * smoothstep(0.5, 1.0, abs(flutes * spin_sweep) / 3.14159265);
#endif
    shaded *= 1.0 - 0.30 * burr * min(dot(milling_glow, vec3(1.0)), 1.0);  // leave room for the glow
    shaded += milling_glow * burr * (0.14 + 0.9 * pow(1.0 - max(dot(normal, to_eye), 0.0), 1.5)) * (1.0 - 0.6 * groove);
    colour = vec4(toneMap(shaded * min(falloff(p_C), 1.0)), 1.0);
}
