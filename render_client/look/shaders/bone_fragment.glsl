#include "lighting.glsl"
#include "cut_away.glsl"
in vec3 p_C;
in vec3 n_C;
uniform vec2 opacity;        // facing the eye, and the part of the rest that the outline adds
uniform vec3 inside_colour;  // linear
#ifdef MATERIALS
in vec4 material_colour;  // colour times alpha, alpha
#endif
out vec4 colour;

// The faint mottling: a browser makes it per vertex, so that its processor has nothing to do for it.
#ifdef GL_ES
in float grain;
#else
#include "noise.glsl"
in vec3 p_M;
in vec2 scanned;
uniform vec2 grey_of_density;  // of the scan: factor, and what is added
uniform bool shows_scan;
uniform float grain_size;      // m
#endif

#ifdef MILLED
in float milled;  // 0 to 1: milling opened the bone here
#ifndef GL_ES
uniform mat4 camera_from_model;

// What flutes leave: scratches of half a millimetre, grain within them. Light from the side brings them out. A
// picture whose pixels are not fine enough shows none.
float millingMarks(vec3 p, float pixel) {
    const float kScratch = 4.5e-4, kGrain = 1.7e-4;
    const vec3 kAlong = vec3(0.62, 0.48, 0.62);
    float scratched = 1.0 - smoothstep(0.25, 0.7, pixel / kScratch), grained = 1.0 - smoothstep(0.25, 0.7, pixel / kGrain);
    if (scratched <= 0.0) return 0.0;
    vec3 at = (p - 0.75 * dot(p, kAlong) * kAlong) / kScratch;
    vec3 to_light = transpose(mat3(camera_from_model)) * key_direction;
    float relief = valueNoise(at) - valueNoise(at + 0.5 * to_light);
    if (grained > 0.0) relief += grained * 0.5 * (valueNoise(p / kGrain) - 0.5);
    return scratched * relief;
}
#endif
#endif

#ifdef NEAR_STRUCTURES
in vec4 near_structure;              // linear colour, distance as a share of the reach
uniform bool shows_thickness;        // or what shines through
uniform vec3 thickness_colours[5];   // linear, from 0 to the reach
uniform vec4 shine;                  // the most, its length, where it ends, the reach (m)

vec3 thicknessColour(float share) {
    float at = clamp(share, 0.0, 1.0) * 4.0;
    int low = min(int(at), 3);
    return mix(thickness_colours[low], thickness_colours[low + 1], at - float(low));
}

// As shineThrough() of near_structures.h.
float shineThrough(float thickness) {
    float least = exp(-shine.z / shine.y);
    return shine.x * max(exp(-thickness / shine.y) - least, 0.0) / (1.0 - least);
}
#endif

#ifdef FILM
#include "film.glsl"
uniform vec3 blood_colour;  // linear

// Brown first, then black, in spots.
vec3 burnt(vec3 albedo, float burn, float spots) {
    vec3 brown = albedo * mix(vec3(1.0), vec3(0.26, 0.135, 0.065), smoothstep(0.02, 0.35, burn * (0.8 + 0.4 * spots)));
    return mix(brown, vec3(0.020, 0.015, 0.012), 0.95 * smoothstep(0.72, 1.0, burn * (0.85 + 0.3 * spots)));
}
#endif

void main() {
    cutAway();
    vec3 to_eye = normalize(-p_C);
    vec3 normal = normalize(n_C);
    bool inside = !gl_FrontFacing;  // an open border, or the eye inside the bone
    if (inside) normal = -normal;

#ifdef GL_ES
    float mottling = grain;
#else
    float mottling = valueNoise(p_M / grain_size) * 0.65 + valueNoise(p_M / grain_size * 2.7 + 11.0) * 0.35;
#endif
    vec3 albedo = mix(vec3(0.69, 0.55, 0.38), vec3(0.82, 0.71, 0.54), mottling);
#ifdef MATERIALS
    albedo = albedo * (1.0 - material_colour.a) + material_colour.rgb * mix(0.88, 1.12, mottling);
#endif
#if defined(MILLED) && !defined(GL_ES)
    float pixel = length(fwidth(p_M));
    if (milled > 0.0) albedo *= 1.0 + 0.55 * milled * millingMarks(p_M, pixel);
#endif
#ifndef GL_ES
    if (shows_scan && scanned.y > 0.0) {
        float grey = clamp(scanned.x / scanned.y * grey_of_density.x + grey_of_density.y, 0.0, 1.0);
        albedo = mix(albedo, vec3(pow(grey, 2.2)), scanned.y);
    }
#endif
#ifdef NEAR_STRUCTURES
    float near_share = near_structure.a;
    if (shows_thickness)
        albedo = mix(thicknessColour(near_share), albedo, smoothstep(0.85, 1.0, near_share));
    else
        albedo = mix(albedo, near_structure.rgb * mix(0.9, 1.1, mottling), shineThrough(near_share * shine.w));
#endif
    if (inside) albedo = inside_colour;
#ifdef FILM
    vec3 sheen = vec3(0.0);
    float wetness = 0.0;
    vec4 lying = inside ? vec4(0.0) : filmAt(p_M);
    if (lying.x + lying.y + lying.z + lying.w > 0.0) {  // noise is dear
        float fine = valueNoise(p_M / film_period * 150.0), coarse = valueNoise(p_M / film_period * 48.0 + 5.0);
        float blood = smoothstep(0.10, 0.46, lying.x * (0.55 + 0.55 * fine + 0.45 * coarse));
        float wet = max(smoothstep(0.05, 0.7, lying.y * (0.7 + 0.6 * coarse)), 0.75 * blood);
        wetness = wet;
        albedo = bruised(burnt(albedo, lying.z, fine), lying.w);
        albedo = mix(albedo * (1.0 - 0.34 * wet), blood_colour * (0.75 + 0.45 * coarse), 0.95 * blood);
        // The film's own surface is smoother than bone, but ripples.
        vec3 ripple = vec3(fine, coarse, valueNoise(p_M / film_period * 90.0 + 9.0)) - 0.5;
        vec3 film_normal = normalize(normal + 0.16 * ripple);
        float grazing = pow(1.0 - max(dot(film_normal, to_eye), 0.0), 4.0);
        vec3 film_mirror = reflect(-to_eye, film_normal);
        float panel = smoothstep(0.88, 0.99, dot(film_mirror, key_direction));
        float strip = smoothstep(0.86, 0.96, dot(film_mirror, kFillDirection));
        sheen = wet * (0.04 + 0.80 * grazing) * kSky + wet * 0.16 * panel * kKeyColour * keyVisibility(p_C, normal)
              + wet * 0.05 * strip * vec3(0.6, 0.8, 1.0);
    }
#endif

    float facing = dot(normal, key_direction);
    float visible = keyVisibility(p_C, normal);
    const float kWrap = 0.12;  // light that bone lets through
    float key = max((facing + kWrap) / (1.0 + kWrap), 0.0) * mix(0.06, 1.0, visible);
    vec3 light = kKeyColour * key + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    // Light inside the bone gives the edge of the shadow a warm tint.
    light += vec3(0.34, 0.13, 0.05) * key * (1.0 - visible);

    vec3 half_way = normalize(key_direction + to_eye);
    // Dry bone is matt: a broad, faint shine. A wet one has the film's narrow highlight.
    float mirrored = max(dot(normal, half_way), 0.0);
    float gloss = pow(mirrored, 14.0) * 0.11;
#ifdef MILLED
    gloss *= 1.0 - milled;
#endif
#ifdef FILM
    gloss = mix(gloss, pow(mirrored, 90.0) * 1.1, wetness);
#endif
    gloss *= visible * step(0.0, facing);
    float grazing_eye = 1.0 - max(dot(normal, to_eye), 0.0);
    float outline = grazing_eye * grazing_eye;
    float rim = outline * outline * (0.35 + 0.65 * max(normal.y, 0.0));
    vec3 shaded = albedo * light * 0.56 + kKeyColour * gloss * 0.4 + kRimColour * rim * 0.16;
#ifdef FILM
    shaded += sheen;
#endif
    colour = vec4(toneMap(shaded * falloff(p_C)), opacity.x + (1.0 - opacity.x) * opacity.y * outline);
}
