//! provides  fog: a layer of droplets below a height, with a soft top
//! hook      visibility, ambient, atmosphere, sky
//! reads     heights of eye and ground [m], distance [m], the light of sun and sky
//! writes    factor, irradiance, radiance, transmittance
//! source    extinction 3.912 / visibility: H. Koschmieder, Theorie der horizontalen Sichtweite (1924); light of a
//!           layer: W. E. Meador and W. R. Weaver, J. Atmos. Sci. 37 (1980) 630, eq. 24, without absorption

//@ include lib/air.glsl
//@ include lib/air_pixel.glsl
//@ include lib/air_sun.glsl
//@ include lib/eye_light.glsl
//@ include lib/ground.glsl
//@ include lib/noise.glsl

uniform float fog_top_m = 900.0; //@ range(-500, 9000) unit(m) label("Top") description("Height up to which the fog reaches, above sea level")
uniform float fog_visibility_m = 400.0; //@ range(20, 20000) unit(m) label("Visibility") description("How far one sees inside of it: below 1000 m it is fog")
uniform float fog_soft_m = 25.0; //@ range(1, 1000) unit(m) label("Soft top") description("Height over which it thins by a factor of e at its top")
uniform float fog_waves_m = 30.0; //@ range(0, 500) unit(m) label("Waves") description("How much the top rises and falls from place to place")
uniform float fog_wave_length_m = 1500.0; //@ range(50, 50000) unit(m) label("Wave length")
uniform float fog_wind_m_s = 1.0; //@ range(0, 100) unit(m/s) label("Wind") description("Moves the waves with --seconds")
uniform float fog_wind_from_deg = 270.0; //@ angle range(0, 360) unit(deg) label("Wind from")

const float fog_gamma = 0.1125;  // 0.75 (1 - g): what a layer of optical depth 1 reflects, with g = 0.85

float fog_extinction() {
    return 3.912 / fog_visibility_m;
}

/// Top of the fog at a place, as drawn [m]. @param place  east and north [m]
float fog_top_at(in vec2 place) {
    vec2 to = -vec2(sin(fog_wind_from_deg), cos(fog_wind_from_deg));
    vec2 at = (place - to * fog_wind_m_s * frame.seconds) / fog_wave_length_m;
    float wave = 0.6 * noise_smooth(at, 0u) + 0.3 * noise_smooth(mat2(0.8, 0.6, -0.6, 0.8) * at * 2.7, 0u) + 0.1 * noise_smooth(at * 7.1, 0u);
    return (fog_top_m + fog_waves_m * (2.0 * wave - 1.0)) * frame.height_range.z;
}

/// Height of all the fog below a height, as if it were nowhere thinner [m]: the integral of
/// 1 / (1 + exp((h - top) / soft)) from far below, but for a constant.
float fog_below(in float height_m, in float top_m) {
    float soft = fog_soft_m * frame.height_range.z;
    float x = (height_m - top_m) / soft;
    // -soft log(1 + exp(-x)), without overflow
    return -soft * (max(-x, 0.0) + log(1.0 + exp(-abs(x))));
}

/// Share of the fog's full density at a height.
float fog_density(in float height_m, in float top_m) {
    return 1.0 / (1.0 + exp(clamp((height_m - top_m) / (fog_soft_m * frame.height_range.z), -60.0, 60.0)));
}

/// Optical depth along a straight line between two heights.
float fog_depth(in float from_m, in float to_m, in float distance_m, in float top_m) {
    float rise = to_m - from_m;
    float mean = abs(rise) < 0.5 ? fog_density(0.5 * (from_m + to_m), top_m)
                                 : (fog_below(to_m, top_m) - fog_below(from_m, top_m)) / rise;
    return fog_extinction() * distance_m * clamp(mean, 0.0, 1.0);
}

/// Optical depth of the fog above a height.
float fog_above(in float height_m, in float top_m) {
    return -fog_extinction() * fog_below(height_m, top_m) / frame.height_range.z;
}

/// Light of the fog towards the eye.
/// @param over  optical depth above the part that is seen  @param under  below it  @param sun  share of the sun there
vec3 fog_light(in vec3 view, in float over, in float under, in float sun) {
    vec3 to_sun = light_at_eye_direction();
    float mu = max(dot(to_sun, frame.eye_up.xyz), 0.0), sine = dot(view, frame.eye_up.xyz);
    float x = fog_gamma * over, y = fog_gamma * under;
    float all = mix(y, 1.0 + y, 0.5 + 0.5 * sine) / (1.0 + x + y);
    const float pi = 3.14159265;
    // From above one sees light that was scattered once at all depths: S. Chandrasekhar, Radiative Transfer (1950).
    float from_above = mu / (mu + max(-sine, 1e-4)), inside = fog_density(frame.eye_m.w, fog_top_m * frame.height_range.z);
    float once = pi * air_aerosol_phase(dot(view, to_sun)) * mix(from_above, exp(-over / max(mu, 0.08)), inside);
    return air_lit * (sun * (mu * all + 0.5 * once) * light_at_eye() + all * frame.sky_irradiance.rgb);
}

bool fog_is_ground = false;  // set by the hooks of the ground: haze then asks for the sky

void fog_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    fog_is_ground = true;
#if !HAS_outside
    float drawn_m = s.height_m * frame.height_range.z;
    factor *= exp(-fog_above(drawn_m, fog_top_at(s.ground_m.xy)) / max(dot(to_sun, s.up), 0.05));
#endif
}

void fog_on_ambient(in Surface s, inout vec3 irradiance) {
#if !HAS_outside
    float tau = fog_above(s.height_m * frame.height_range.z, fog_top_at(s.ground_m.xy));
    float passes = 1.0 / (1.0 + fog_gamma * tau), mu = max(frame.sun_apparent.z, 0.0);
    vec3 to_sun, light = sun_light_at(s.height_m, s.up, to_sun);
    vec3 sun = mu * light / max(light_of_sky_at(s.height_m, s.up), vec3(1e-9));
    irradiance *= passes + max(passes - exp(-tau / max(mu, 0.05)), 0.0) * sun;
#endif
}

/// How far on the eye's way to the ground it passes the mean top of the fog, 0 to 1; else 1.
float fog_entry(in float drawn_m) {
    float top_m = fog_top_m * frame.height_range.z;
    float share = clamp((frame.eye_m.w - top_m) / max(frame.eye_m.w - drawn_m, 1.0), 0.0, 1.0);
    return frame.eye_m.w > top_m && drawn_m < top_m ? share : 1.0;
}

/// How much more light a slope of the fog's top gets than level fog. @param top_m  fog_top_at(place)
float fog_relief(in vec2 place, in float top_m) {
    vec3 to_sun = light_at_eye_direction();
    vec2 sunward = normalize(to_sun.xy + 1e-6);
    float step_m = 0.04 * fog_wave_length_m;
    float rise = (fog_top_at(place + step_m * sunward) - top_m) / step_m;
    float low = sqrt(max(1.0 - to_sun.z * to_sun.z, 0.0));
    return clamp(1.0 - 2.0 * low * rise, 0.5, 1.6);
}

void fog_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {
#if !HAS_outside
    float drawn_m = s.height_m * frame.height_range.z;
    float entry = fog_entry(drawn_m);
    vec2 place = mix(frame.eye_m.xy, s.ground_m.xy, entry);
    float top_m = fog_top_at(place);
    float depth = fog_depth(frame.eye_m.w, drawn_m, s.distance_m, top_m);
    // From above, the visible part of thick fog lies at an optical depth of 1 from the eye.
    float above = fog_above(min(frame.eye_m.w, drawn_m), top_m), inside = fog_density(frame.eye_m.w, top_m);
    float over = mix(min(above, 1.0), above, inside);
    float under = max(fog_above(drawn_m, top_m) - over, 0.0) + 2.0;
    float relief = mix(fog_relief(place, top_m), 1.0, inside);
    radiance = mix(relief * fog_light(view, over, under, air_sun_at(entry * s.distance_m)), radiance, exp(-depth));
#endif
}

void fog_on_sky(in vec3 direction, inout vec3 radiance, inout vec3 transmittance) {
#if !HAS_outside
    float sine = dot(direction, frame.eye_up.xyz), top_m = fog_top_m * frame.height_range.z;
    // From above the air before mountains keeps its own colour.
    if (fog_is_ground && frame.eye_m.w > top_m) return;
    float up = fog_above(frame.eye_m.w, top_m) / max(sine, 0.005);
    // Below the horizon the fog lies on ground that is not in the DEM.
    float below = frame.eye_m.w > top_m ? 8.0 - 8.0 * smoothstep(-0.012, -0.002, sine - frame.eye_up.w) : 50.0;
    float depth = sine > 0.0 ? up : max(below, up);
    float passes = exp(-depth);
    radiance = mix(fog_light(direction, sine > 0.0 ? 0.5 * min(up, 8.0) : 1.0, 4.0, 1.0), radiance, passes);
    transmittance *= passes;
#endif
}
