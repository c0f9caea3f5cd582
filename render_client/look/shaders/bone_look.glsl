// How bone looks in a point of its surface. The page shades it in each pixel of each triangle (bone_fragment.glsl), the
// viewer once per pixel (bone_shade_fragment.glsl).
#include "lighting.glsl"
uniform vec2 opacity;        // facing the eye, and the part of the rest that the outline adds
uniform vec3 inside_colour;  // linear

struct BonePoint {
    vec3 p_C, n_C;    // the normal is on the eye's side
    bool inside;      // an open border, or the eye inside the bone
    float mottling;   // 0 to 1, faint
    vec4 material;    // linear colour times alpha, alpha
    float milled;     // 0 to 1: milling opened the bone here
    vec4 near;        // of the nearest structure: linear colour, distance as a share of the reach
#ifndef GL_ES
    vec3 p_M;
    vec2 scanned;     // what the scan measured, times whether it did; whether it did
    float pixel;      // m
#endif
};

#ifndef GL_ES
#include "noise.glsl"
uniform vec2 grey_of_density;  // of the scan: factor, and what is added
uniform bool shows_scan;

// What flutes leave: scratches of half a millimetre, grain within them. Light from the side brings them out. A
// picture whose pixels are not fine enough shows none.
float millingMarks(vec3 p, float pixel) {
    const float kScratch = 4.5e-4, kGrain = 1.7e-4;
    const vec3 kAlong = vec3(0.62, 0.48, 0.62);
    float scratched = 1.0 - smoothstep(0.25, 0.7, pixel / kScratch), grained = 1.0 - smoothstep(0.25, 0.7, pixel / kGrain);
    if (scratched <= 0.0) return 0.0;
    vec3 at = (p - 0.75 * dot(p, kAlong) * kAlong) / kScratch;
    vec3 to_light = mat3(model_from_camera) * key_direction;
    float relief = valueNoise(at) - valueNoise(at + 0.5 * to_light);
    if (grained > 0.0) relief += grained * 0.5 * (valueNoise(p / kGrain) - 0.5);
    return scratched * relief;
}
#endif

#ifdef NEAR_STRUCTURES
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

// Its own colour, linear.
vec3 albedoOf(BonePoint point) {
    vec3 albedo = mix(vec3(0.69, 0.55, 0.38), vec3(0.82, 0.71, 0.54), point.mottling);
    albedo = albedo * (1.0 - point.material.a) + point.material.rgb * mix(0.88, 1.12, point.mottling);
#ifndef GL_ES
    // A processor that draws goes round a loop, but through every branch.
    for (bool is_milled = point.milled > 0.0; is_milled; is_milled = false)
        albedo *= 1.0 + 0.55 * point.milled * millingMarks(point.p_M, point.pixel);
    if (shows_scan && point.scanned.y > 0.0) {
        float grey = clamp(point.scanned.x / point.scanned.y * grey_of_density.x + grey_of_density.y, 0.0, 1.0);
        albedo = mix(albedo, vec3(pow(grey, 2.2)), point.scanned.y);
    }
#endif
#ifdef NEAR_STRUCTURES
    if (shows_thickness)
        albedo = mix(thicknessColour(point.near.a), albedo, smoothstep(0.85, 1.0, point.near.a));
    else
        albedo = mix(albedo, point.near.rgb * mix(0.9, 1.1, point.mottling), shineThrough(point.near.a * shine.w));
#endif
    return point.inside ? inside_colour : albedo;
}

// With its opacity.
vec4 lookOf(BonePoint point) {
    vec3 p_C = point.p_C, normal = point.n_C, to_eye = normalize(-p_C);
    vec3 albedo = albedoOf(point);
    float visible = keyVisibility(p_C, normal);
#ifdef FILM
    vec3 sheen = vec3(0.0);
    float wetness = 0.0;
    vec4 lying = point.inside ? vec4(0.0) : filmAt(point.p_M);
    // Noise is dear.
    for (bool is_covered = lying.x + lying.y + lying.z + lying.w > 0.0; is_covered; is_covered = false) {
        float fine = valueNoise(point.p_M / film_period * 150.0), coarse = valueNoise(point.p_M / film_period * 48.0 + 5.0);
        float blood = smoothstep(0.10, 0.46, lying.x * (0.55 + 0.55 * fine + 0.45 * coarse));
        float wet = max(smoothstep(0.05, 0.7, lying.y * (0.7 + 0.6 * coarse)), 0.75 * blood);
        wetness = wet;
        albedo = bruised(burnt(albedo, lying.z, fine), lying.w);
        albedo = mix(albedo * (1.0 - 0.34 * wet), blood_colour * (0.75 + 0.45 * coarse), 0.95 * blood);
        // The film's own surface is smoother than bone, but ripples.
        vec3 ripple = vec3(fine, coarse, valueNoise(point.p_M / film_period * 90.0 + 9.0)) - 0.5;
        vec3 film_normal = normalize(normal + 0.16 * ripple);
        float grazing = pow(1.0 - max(dot(film_normal, to_eye), 0.0), 4.0);
        vec3 film_mirror = reflect(-to_eye, film_normal);
        float panel = smoothstep(0.88, 0.99, dot(film_mirror, key_direction));
        float strip = smoothstep(0.86, 0.96, dot(film_mirror, kFillDirection));
        sheen = wet * (0.04 + 0.80 * grazing) * kSky + wet * 0.16 * panel * kKeyColour * visible
              + wet * 0.05 * strip * vec3(0.6, 0.8, 1.0);
    }
#endif

    float facing = dot(normal, key_direction);
    const float kWrap = 0.12;  // light that bone lets through
    float key = max((facing + kWrap) / (1.0 + kWrap), 0.0) * mix(0.06, 1.0, visible);
    vec3 light = kKeyColour * key + kFillColour * max(dot(normal, kFillDirection), 0.0) + hemisphere(normal);
    // Light inside the bone gives the edge of the shadow a warm tint.
    light += vec3(0.34, 0.13, 0.05) * key * (1.0 - visible);

    vec3 half_way = normalize(key_direction + to_eye);
    // Dry bone is matt: a broad, faint shine. A wet one has the film's narrow highlight.
    float mirrored = max(dot(normal, half_way), 0.0);
    float gloss = pow(mirrored, 14.0) * 0.11;
    gloss *= 1.0 - point.milled;
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
    return vec4(toneMap(shaded * falloff(p_C)), opacity.x + (1.0 - opacity.x) * opacity.y * outline);
}
