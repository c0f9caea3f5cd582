// What the bone's surface has in a pixel ; bone_shade_fragment.glsl shades it afterwards. Small triangles are many, and a
// processor that draws shades a block of pixels for each.
#include "octahedral.glsl"
in vec3 p_C;
in vec3 n_C;
in vec4 material_colour;
in float milled;
in vec2 scanned;
layout(location = 0) out vec4 normal_and_scan;
layout(location = 1) out vec4 material;
layout(location = 2) out vec2 depth_and_milled;

void main() {
    normal_and_scan = vec4(octahedralOf(normalize(n_C)) * 0.5 + 0.5, scanned);
    material = material_colour;
    depth_and_milled = vec2(gl_FrontFacing ? -p_C.z : p_C.z, milled);
}
