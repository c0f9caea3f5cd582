// The cut face of a structure.
#include "lighting.glsl"
#include "cut_entry.glsl"
uniform vec3 structure_colour;  // linear
uniform float glow;             // 0 to 1: the burr is near
out vec4 colour;

void main() {
    CutEntry entry = cutEntry();
    vec3 p_C = entry.depth * entry.ray;
    colour = vec4(toneMap(mix(structure_colour, vec3(1.0), 0.30 * glow) * 0.8 * falloff(p_C)), 1.0);
    gl_FragDepth = storedDepth(p_C);
}
