// One pixel's depth in 24 bits, which a browser can read.
uniform sampler2D depth_map;
uniform vec2 at;  // texel
out vec4 colour;

void main() {
    float depth = texelFetch(depth_map, ivec2(at), 0).r * 255.0;
    float second = fract(depth) * 255.0;
    colour = vec4(floor(depth) / 255.0, floor(second) / 255.0, fract(second), 1.0);
}
