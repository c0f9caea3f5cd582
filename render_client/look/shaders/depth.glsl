uniform sampler2D depth_map;
uniform vec2 near_far;  // m

// What the depth map holds, in m before the eye.
float depthOf(float stored) {
    return near_far.x * near_far.y / (near_far.y - stored * (near_far.y - near_far.x));
}

// 1 where nothing was drawn, and beside the picture what lies at its edge.
float storedAt(ivec2 texel) {
    return texelFetch(depth_map, clamp(texel, ivec2(0), textureSize(depth_map, 0) - 1), 0).r;
}
