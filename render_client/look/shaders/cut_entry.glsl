// The face of a cut lies where the line of sight enters what the cut-planes leave.
#include "sight.glsl"
in vec2 uv;
uniform vec4 cut_planes[3];  // C: shown where dot(plane, (p, 1)) >= 0
uniform vec2 near_far;       // m
uniform mat4 clip_from_camera;

struct CutEntry {
    vec3 ray;     // C, at a depth of 1
    float depth;  // m
    int cut;      // the plane
    vec3 normal;  // C, of the face; 0: the eye is behind all planes already
};

CutEntry cutEntry() {
    CutEntry entry = CutEntry(sightThrough(uv), near_far.x, 0, vec3(0.0));
    for (int i = 0; i < 3; ++i) {
        float closing = dot(cut_planes[i].xyz, entry.ray);
        float crossing = -cut_planes[i].w / closing;
        if (closing > 0.0 && crossing > entry.depth) {
            entry.depth = crossing;
            entry.cut = i;
            entry.normal = -cut_planes[i].xyz;
        }
    }
    return entry;
}

// What the depth buffer holds of it.
float storedDepth(vec3 p_C) {
    vec4 clip = clip_from_camera * vec4(p_C, 1.0);
    return clip.z / clip.w * 0.5 + 0.5;
}
