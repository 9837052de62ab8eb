//! provides  haze: a layer of air near the ground that thins with height
//! hook      vertex, atmosphere
//! reads     height [m], distance [m], height of the eye [m], the sky's radiance without the sun's disc
//! writes    radiance
//! source    Costa and Celes, Tecnicas simples para visualizacao foto-realista de terrenos em tempo real
//!           usando placas graficas programaveis (Tecgraf, PUC-Rio), section on sky and haze

//@ include lib/air.glsl
//@ include lib/air_pixel.glsl
//@ include lib/air_sun.glsl

uniform bool haze_air = true; //@ static label("Air") description("On: the clear atmosphere of the sky, and haze where it is denser. Off: haze alone, in the colour of the sky behind it, as in the paper")
uniform float haze_density = 0.0; //@ range(0, 100) unit(1/km) label("Density") description("Extinction of green light at height 0. Air that is clearer than the atmosphere's own is drawn as the atmosphere")
uniform float haze_visibility = 0.0; //@ range(0, 1000) unit(km) label("Visibility") description("Meteorological range at height 0, instead of the density: 3.912 / density. 0: the density is used")
uniform float haze_scale_height = 2500.0; //@ range(10, 100000) unit(m) label("Scale height") description("Height over which the haze thins by a factor of e")
uniform float haze_blue = 0.6; //@ range(0, 1) label("Blue") description("Blue scattering relative to red: 1 as in pure air, 0 as in fog and in the paper")

out vec3 haze_strength;  // red, green, blue: share of the sky's colour; with the atmosphere, the optical depth of the haze

/// Extinction at height 0 [1/m]. Koschmieder's visibility is the distance from which 2 % of a black
/// thing's contrast is left: ln 50 = 3.912.
float haze_extinction() {
    return 1e-3 * (haze_visibility > 0.0 ? 3.912 / haze_visibility : haze_density);
}

/// Optical depth of the air between two points in green light: the mean of exp(-height / H) along
/// the straight line between them, times its length.
float haze_depth(in float eye_height_m, in float height_m, in float distance_m) {
    // No air lies below the sea: its floor is seen as it would be from the surface.
    return haze_extinction() * distance_m * air_mean_density(eye_height_m / haze_scale_height, height_m / haze_scale_height);
}

/// Red and blue against green. Pure air scatters with the fourth power of the wavelength, 610, 550
/// and 465 nm.
vec3 haze_colour() {
    return mix(vec3(1.0), vec3(0.661, 1.0, 1.957), haze_blue);
}

vec3 haze_strength_of(in float depth) {
    return 1.0 - exp(-depth * haze_colour());
}

/// The part of the extinction that the atmosphere does not have itself.
float haze_extra_share() {
    float whole = haze_extinction();
    return haze_air ? max(whole - frame.air_mapping.w, 0.0) / max(whole, 1e-12) : 1.0;
}

void haze_on_vertex(in VertexFrame v) {
    float depth = haze_extra_share() * haze_depth(frame.eye_m.w, v.drawn_height_m, v.distance_m);
    haze_strength = haze_air ? depth * haze_colour() : haze_strength_of(depth);
}

#if HAS_shafts

/// Share of the sunlight scattered once before the ground that is left where terrain keeps the sun off.
/// @param depth  of the air up to the ground; `strength` is the haze's
vec3 haze_lit(in Surface s, in vec3 view, in vec3 depth, in vec3 strength) {
    float eye_m = frame.eye_m.w, ground_m = s.height_m * frame.height_range.z;
    float all = max(haze_depth(eye_m, ground_m, s.distance_m), 1e-12);
    vec4 parts;
    for (int i = 0; i < 4; ++i) {
        float way_m = air_sun_part_m(i);
        parts[i] = haze_depth(eye_m, mix(eye_m, ground_m, way_m / s.distance_m), way_m) / all;
    }
    return air_sun_lit(view, s.distance_m, depth, strength, parts);
}

#endif

void haze_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {
    // What is seen from outside, as a model on a table, has no air before it.
#if !HAS_outside
    if (haze_air) {
        AirBetween air = air_between_eye_and(view, s.distance_m);
        float scale = air_scale_before(air_rim_at(s.post), s.distance_m);
        vec3 passed = exp(-scale * (air.depth + haze_strength));
        vec3 once = air.once * (1.0 - passed);
#if HAS_shafts
        once *= haze_lit(s, view, scale * air.depth, scale * haze_strength);
#endif
        air_scattered = (air.radiance - air.once) * (1.0 - passed) + once;
        radiance = radiance * passed + air_scattered;
    } else {
        radiance = mix(radiance, background_radiance(view, false), haze_strength);
    }
#endif
}
