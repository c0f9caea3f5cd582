#include "octahedral.glsl"
layout(location = 0) in vec3 steps;
layout(location = 1) in vec2 octahedral;
#ifdef MATERIALS
layout(location = 2) in float material;  // 1 + index in the scene's list, 0: none; 128 more where it was milled
uniform sampler2D palette;               // per material: linear colour times alpha; alpha 0: it has none
out vec4 material_colour;
#endif
#ifdef MILLED
out float milled;
#endif
#ifdef GL_ES
layout(location = 3) in float mottling;  // 0 to 255
out float grain;
#else
layout(location = 3) in vec2 scan;       // its density (0 to 1) where milling opened the bone; whether it did
out vec2 scanned;
out vec3 p_M;
#endif
#ifdef NEAR_STRUCTURES
#include "near_structure.glsl"
out vec4 near_structure;
#endif
uniform vec3 origin;
uniform vec3 step;
uniform mat4 camera_from_model;
uniform mat4 clip_from_camera;
uniform vec4 cut_planes[3];  // model frame: shown where dot(plane, (p, 1)) >= 0
#ifdef PULSE
// It rises in patches, as what is held at places does: the surface tilts, and its glints move.
const float kPatch = 2.0 * 3.14159265 / 9e-3;  // rad/m
uniform float rise;                            // m
void riseAt(inout vec3 p, inout vec3 n) {
    vec3 at = kPatch * p;
    float share = 0.5 + dot(sin(at), vec3(1.0 / 6.0));
    vec3 slope = kPatch / 6.0 * cos(at);
    p += rise * share * n;
    n = normalize(n - rise * (slope - dot(slope, n) * n));
}
#endif
out vec3 p_C;
out vec3 n_C;
#ifndef GL_ES
out float gl_ClipDistance[3];
#elif defined(CUT)
out vec3 kept;
#endif
invariant gl_Position;  // a layer is found by its depth first and then drawn where the depth is equal

void main() {
    vec4 p = vec4(origin + step * steps, 1.0);
    vec3 n = unitVector(octahedral / 127.0);
#ifdef PULSE
    riseAt(p.xyz, n);
#endif
    p_C = (camera_from_model * p).xyz;
    n_C = mat3(camera_from_model) * n;
    gl_Position = clip_from_camera * vec4(p_C, 1.0);
#ifdef MATERIALS
    material_colour = texelFetch(palette, ivec2(int(material), 0), 0);
#endif
#ifdef MILLED
    milled = material > 127.5 ? 1.0 : 0.0;
#endif
#ifdef GL_ES
    grain = mottling / 255.0;
#else
    p_M = p.xyz;
    scanned = vec2(scan.x * scan.y, scan.y);
    for (int i = 0; i < 3; ++i) gl_ClipDistance[i] = dot(cut_planes[i], p);
#endif
#if defined(GL_ES) && defined(CUT)
    kept = vec3(dot(cut_planes[0], p), dot(cut_planes[1], p), dot(cut_planes[2], p));
#endif
#ifdef NEAR_STRUCTURES
    near_structure = nearStructureAt(p.xyz);
#endif
}
