//! provides  skylight: the sky's light as far as the ground around leaves the sky in sight
//! hook      ambient
//! reads     the share of the sky that every post sees (core/render/ground_light.h)
//! writes    irradiance
//! source    Dozier and Frew, IEEE Trans. Geosci. Remote Sensing 28 (1990) 963: sky-view factor

//@ include lib/ground.glsl
//@ include lib/openness.glsl

uniform float skylight_albedo = 0.2;  //@ range(0, 1) label("Albedo") description("Albedo of the ground that hides the sky and reflects light instead")
uniform float skylight_strength = 1.0;  //@ range(0, 4) label("Strength") description("1: physical; higher values darken hollows further")

void skylight_on_ambient(in Surface s, inout vec3 irradiance) {
    float seen = pow(max(surface_open_sky(s), 1e-5), skylight_strength);  // 0 to the power of 0 is undefined
    // What hides the sky is taken to be level ground, half of it in the sun.
    vec3 to_sun;
    vec3 direct = sun_light_at(s.height_m, s.up, to_sun);
    vec3 level = light_of_sky_at(s.height_m, s.up) + 0.5 * max(dot(to_sun, s.up), 0.0) * direct;
    irradiance = seen * irradiance + (1.0 - seen) * skylight_albedo * level;
}
