//! provides  what exclusive hooks do when no enabled plugin provides them

//@ include lib/ground.glsl
//@ include lib/neutral.glsl

/// Phong's reflection of direct light. @returns radiance for an irradiance of 1
/// source: B. T. Phong, Illumination for computer generated pictures, CACM 18 (1975), eq. 1
vec3 core_on_brdf(in Surface s, in vec3 to_sun, in vec3 to_eye) {
    float facing = max(dot(s.normal, to_sun), 0.0);
    vec3 mirrored = reflect(-to_sun, s.normal);
    float highlight = facing > 0.0 ? pow(max(dot(mirrored, to_eye), 0.0), s.shininess) : 0.0;
    return s.diffuse * facing + s.specular * highlight;
}

/// A plain sky: as bright as the light it sheds, paler towards the horizon.
vec3 core_on_background_radiance(in vec3 direction, in bool with_disc) {
    float height = clamp(dot(direction, normalize(frame.up_at_eye.xyz)), 0.0, 1.0);
    vec3 zenith = frame.sky_irradiance.rgb;
    vec3 horizon = vec3(dot(zenith, vec3(0.2126, 0.7152, 0.0722))) * 1.5 + zenith * 0.5;
    return mix(horizon, zenith, sqrt(height));
}

void core_on_tonemap(inout vec3 colour) {
    colour = neutral_tones(colour);
}

/// Ground without air before it.
vec3 core_on_beyond(in Surface s, in vec3 view) {
    vec3 to_sun;
    vec3 irradiance = sun_light(s.up, to_sun);
    return s.diffuse * (irradiance * max(dot(s.up, to_sun), 0.0) + frame.sky_irradiance.rgb);
}

/// A matt grey wall.
vec3 core_on_side(in Surface s, in float down) {
    vec3 to_sun;
    vec3 irradiance = sun_light(s.up, to_sun);
    vec3 sky = frame.sky_irradiance.rgb * (0.5 + 0.5 * dot(s.normal, s.up));
    return 0.3 * (irradiance * max(dot(s.normal, to_sun), 0.0) + sky);
}

/// The sky, as from within.
vec3 core_on_backdrop(in vec3 direction, in vec2 at) {
    return background_radiance(direction, true);
}
