in vec2 uv;
uniform sampler2D slice;
uniform vec2 size;     // of the pane, pixels
uniform vec2 burr;     // pixels from the pane's upper left corner
uniform float circle;  // radius of the burr in the slice, pixels; 0: it is not in it
out vec4 colour;

float stroke(float off, float half_width) { return 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, off); }

void main() {
    vec2 at = vec2(uv.x, 1.0 - uv.y) * size;
    vec3 shown = texelFetch(slice, ivec2(at), 0).rgb;
    vec2 off = abs(at - burr);
    // The lines end before the burr: what it is about to meet is to be seen.
    float beyond = step(max(circle, 2.0) + 5.0, max(off.x, off.y));
    float cross = max(stroke(off.x, 0.5), stroke(off.y, 0.5)) * beyond;
    shown = mix(shown, vec3(0.25, 0.85, 0.95), 0.55 * cross);
    float ring = circle > 0.0 ? stroke(abs(length(off) - circle), 0.8) : 0.0;
    shown = mix(shown, vec3(1.0, 0.83, 0.25), ring);
    colour = vec4(shown, 1.0);
}
