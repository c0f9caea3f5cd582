// The light rig is fixed to the camera, so that what one looks at is always lit: a warm key from the upper left with a
// shadow, a cool fill from the right, a rim from behind, and a hemisphere. A browser whose processor draws has no
// shadow map.
uniform vec3 key_direction;   // C, towards the light
uniform float light_reach;    // m from the eye to where its own light is as bright as the room's; 0: the room's
#ifdef GL_ES
const float light_strength = 1.0;
#else
uniform float light_strength;  // against the room's, without a reach
#endif
#ifndef GL_ES
#define SHADOW
#endif
#ifdef SHADOW
uniform sampler2DShadow shadow_map;
uniform bool has_shadow;
uniform float shadow_texel;   // m in the world per texel of the shadow map
uniform mat4 shadow_from_camera;
#endif

const vec3 kKeyColour = vec3(1.00, 0.94, 0.85) * 2.35;
const vec3 kFillColour = vec3(0.60, 0.70, 0.92) * 0.30;
const vec3 kRimColour = vec3(0.75, 0.86, 1.00);
const vec3 kSky = vec3(0.27, 0.29, 0.33);
const vec3 kGround = vec3(0.17, 0.12, 0.09);
const vec3 kFillDirection = normalize(vec3(0.85, -0.15, 0.45));

vec3 toneMap(vec3 linear) {
    // The tone curve is Narkowicz' fit of the ACES film curve; then comes the display's gamma.
    vec3 film = (linear * (2.51 * linear + 0.03)) / (linear * (2.43 * linear + 0.59) + 0.14);
    return pow(clamp(film, 0.0, 1.0), vec3(1.0 / 2.2));
}

float keyVisibility(vec3 p_C, vec3 normal) {
#ifdef SHADOW
    vec3 offset = normal * shadow_texel * (1.5 + 2.5 * (1.0 - max(dot(normal, key_direction), 0.0)));
    vec4 clip = shadow_from_camera * vec4(p_C + offset, 1.0);
    vec3 uvw = clip.xyz * 0.5 + 0.5;
    if (any(lessThan(uvw.xy, vec2(0.0))) || any(greaterThan(uvw.xy, vec2(1.0)))) return 1.0;
    uvw.z = clamp(uvw.z, 0.0, 1.0);
    vec2 texel = 1.3 / vec2(textureSize(shadow_map, 0));
    float sum = 0.0;
    // A processor that draws goes round a loop, but through every branch.
    for (int y = -1, last = has_shadow ? 1 : -2; y <= last; ++y)
        for (int x = -1; x <= 1; ++x) sum += texture(shadow_map, vec3(uvw.xy + vec2(x, y) * texel, uvw.z));
    return has_shadow ? sum / 9.0 : 1.0;
#else
    return 1.0;
#endif
}

float falloff(vec3 p_C) {
    if (light_reach <= 0.0) return light_strength;
    float spot = mix(0.5, 1.0, smoothstep(0.60, 0.97, -normalize(p_C).z));
    return spot * 1.5 / (0.85 + dot(p_C, p_C) / (light_reach * light_reach));
}

vec3 hemisphere(vec3 normal) { return mix(kGround, kSky, 0.5 + 0.5 * normal.y); }
