//! provides  the direct light at the eye: the sun's, or at night the moon's

/// Towards it, with refraction.
vec3 light_at_eye_direction() {
    return frame.eye_moon_light.a > 0.0 ? frame.eye_moon.xyz : frame.eye_sun.xyz;
}

/// Irradiance on a surface that faces it.
vec3 light_at_eye() {
    return frame.eye_moon_light.a > 0.0 ? frame.eye_moon_light.rgb : frame.eye_sun_light.rgb;
}
