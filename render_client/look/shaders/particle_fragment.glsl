// A particle looks like a ball, or like a capsule along its streak, seen from the front.
#include "lighting.glsl"
in vec3 p_C;
in vec2 f_place;
flat in vec3 f_streak;
flat in vec4 f_colour;
flat in float f_gloss;
out vec4 colour;

void main() {
    vec2 off = vec2(sign(f_place.x) * max(abs(f_place.x) - f_streak.z, 0.0), f_place.y);
    float squared = dot(off, off);
    if (squared > 1.0) discard;
    // A long streak has no ends to be seen.
    float is_long = smoothstep(0.5, 2.0, f_streak.z);
    float round_x = off.x * (1.0 - is_long);
    vec2 turned = f_streak.xy * round_x + vec2(-f_streak.y, f_streak.x) * off.y;
    vec3 normal = vec3(turned, sqrt(max(1.0 - dot(turned, turned), 0.0)));
    vec3 to_eye = normalize(-p_C);
    float visible = keyVisibility(p_C, normal);
    vec3 light = kKeyColour * max(dot(normal, key_direction), 0.0) * mix(0.1, 1.0, visible)
               + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    vec3 matt = f_colour.rgb * light * 0.56;
    float grazing = pow(1.0 - max(dot(normal, to_eye), 0.0), 3.0);
    float spot = pow(max(dot(normal, normalize(key_direction + to_eye)), 0.0), 60.0);
    vec3 water = f_colour.rgb * (0.18 + 0.7 * grazing) + kKeyColour * spot * 0.8 * visible;
    float cover = mix(1.0, clamp(0.30 + 0.7 * grazing + spot, 0.0, 1.0) / 0.6, f_gloss);
    float edge = 1.0 - smoothstep(0.75, 1.0, squared);
    float ends = 1.0 - abs(f_place.x) / (f_streak.z + 1.0);
    edge *= mix(1.0, smoothstep(0.0, 0.7, ends), is_long);
    colour = vec4(toneMap(mix(matt, water, f_gloss) * falloff(p_C)), clamp(f_colour.a * cover * edge, 0.0, 1.0));
}
