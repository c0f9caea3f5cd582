// A direction as a place in a square of -1 to 1, and back.
vec3 unitVector(vec2 uv) {
    vec3 v = vec3(uv, 1.0 - abs(uv.x) - abs(uv.y));
    if (v.z < 0.0) v.xy = (1.0 - abs(v.yx)) * vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0);
    return normalize(v);
}

vec2 octahedralOf(vec3 v) {
    vec2 uv = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    if (v.z >= 0.0) return uv;
    return (1.0 - abs(uv.yx)) * vec2(uv.x < 0.0 ? -1.0 : 1.0, uv.y < 0.0 ? -1.0 : 1.0);
}
