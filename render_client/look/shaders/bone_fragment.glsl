// The bone of a browser, shaded as its triangles come. The mottling is made per vertex, so that a browser's processor has
// nothing to do for it.
#include "bone_look.glsl"
#include "cut_away.glsl"
in vec3 p_C;
in vec3 n_C;
in float grain;
#ifdef MATERIALS
in vec4 material_colour;
#endif
#ifdef MILLED
in float milled;
#endif
#ifdef NEAR_STRUCTURES
in vec4 near_structure;
#endif
out vec4 colour;

void main() {
    cutAway();
    BonePoint point = BonePoint(p_C, normalize(n_C), !gl_FrontFacing, grain, vec4(0.0), 0.0, vec4(0.0));
    if (point.inside) point.n_C = -point.n_C;
#ifdef MATERIALS
    point.material = material_colour;
#endif
#ifdef MILLED
    point.milled = milled;
#endif
#ifdef NEAR_STRUCTURES
    point.near = near_structure;
#endif
    colour = lookOf(point);
}
