uniform sampler3D near_structures;  // linear colour of the nearest, its distance as a share of the reach
uniform vec3 near_first;            // V, m: of the texture's first corner
uniform vec3 near_extent;           // m: of the texture

vec4 nearStructureAt(vec3 p_M) {
    vec3 at = (p_M - near_first) / near_extent;
    bool is_near = all(greaterThan(at, vec3(0.0))) && all(lessThan(at, vec3(1.0)));
    return is_near ? textureLod(near_structures, at, 0.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
