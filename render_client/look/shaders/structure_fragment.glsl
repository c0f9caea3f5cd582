#include "lighting.glsl"
#include "cut_away.glsl"
in vec3 p_C;
in vec3 n_C;
uniform vec3 structure_colour;  // linear
uniform float glow;             // 0 to 1: the burr is near
uniform bool is_behind;         // bone lies before it
out vec4 colour;
#ifdef FILM
in vec3 p_M;
#include "film.glsl"
#endif

void main() {
    cutAway();
    vec3 to_eye = normalize(-p_C);
    vec3 normal = normalize(n_C);
    float facing_eye = abs(dot(normal, to_eye));
    vec3 albedo = mix(structure_colour, vec3(1.0), 0.30 * glow);
#ifdef FILM
    albedo = bruised(albedo, filmAt(p_M).w);
#endif
    float outline = pow(1.0 - facing_eye, 2.0);
    if (is_behind) {
        // Like glass: the outline tells the shape, and bone keeps its own in the middle.
        colour = vec4(toneMap(albedo * (0.75 + 0.35 * facing_eye)), 0.20 + 0.12 * glow + 0.55 * outline);
        return;
    }
    if (!gl_FrontFacing) {  // a cut has opened it
        colour = vec4(toneMap(albedo * 0.55), 1.0);
        return;
    }
    float facing = dot(normal, key_direction);
    float visible = keyVisibility(p_C, normal);
    vec3 light = kKeyColour * max(facing, 0.0) * mix(0.10, 1.0, visible)
               + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    vec3 half_way = normalize(key_direction + to_eye);
    float gloss = pow(max(dot(normal, half_way), 0.0), 30.0) * 0.5 * visible * step(0.0, facing);
    vec3 shaded = albedo * (light * 0.56 + 0.25 * glow) + kKeyColour * gloss * 0.25 + kRimColour * outline * 0.10;
    colour = vec4(toneMap(shaded * falloff(p_C)), 1.0);
}
