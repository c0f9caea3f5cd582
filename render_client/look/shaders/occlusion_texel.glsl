// A texel of the occlusion map: how much of the surroundings is open (0 to 1), and the depth (m). A browser draws into
// bytes: there the depth has 16 bits of the way from near to far.
#ifdef GL_ES
vec4 occlusionTexel(float open, float depth) {
    float share = clamp((depth - near_far.x) / (near_far.y - near_far.x), 0.0, 1.0) * 255.0;
    return vec4(open, floor(share) / 255.0, fract(share), 1.0);
}
vec2 openAndDepth(vec4 texel) {
    return vec2(texel.r, near_far.x + (texel.g + texel.b / 255.0) * (near_far.y - near_far.x));
}
#else
vec4 occlusionTexel(float open, float depth) { return vec4(open, depth, 0.0, 1.0); }
vec2 openAndDepth(vec4 texel) { return texel.rg; }
#endif
