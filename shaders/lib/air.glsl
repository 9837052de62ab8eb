//! provides  air_radiance, air_ground, air_between_eye_and: the clear atmosphere as the eye of the frame sees it;
//!           air_scale_at, air_scale_before, air_scale_beyond, air_rim_at: how much of it there is in aerial views
//! reads     air_sky, air_between: render/air_textures.h makes them, where a program reads them
//!           with NO_MOON nothing of the moon, which then lights nothing
//! source    core/sky/eye_tables.h: what each number means; core/sky/atmosphere.h: the model

//@ include lib/filtered.glsl

const float air_rim = 0.3;  // width of the DEM's rim, as a share of its sides

/// Factor on the depth of the air up to a distance before the ground: below 1 in aerial views of wide DEMs, whose
/// foreground is clear.
float air_scale_at(in float distance_m) {
    return frame.air_scale * max(1.0 - frame.air_near_m / max(distance_m, 1e-3), 0.0);
}

/// How far the DEM is a sea with its floor, 0 to 1: there clearer air over the DEM would be a dark square.
float air_over_sea() {
    return smoothstep(0.5, 0.7, frame.sea_floor_share);
}

/// The same for a distance beyond the DEM: towards its far side the air becomes the true one.
float air_scale_beyond(in float distance_m) {
    float widths = distance_m * sqrt(frame.ground_extent.z * frame.ground_extent.w);
    float whole = min(1.8 * frame.air_scale, 1.0);  // over more than 100 km true air would be all that is seen
    float sea = air_over_sea();  // all of it is seen from afar
    return max(mix(air_scale_at(distance_m), whole, smoothstep(0.5 + 0.4 * sea, 1.3 + 1.7 * sea, widths)),
               smoothstep(2.5, 10.0, widths));
}

/// How far ground of the DEM goes over into what is beyond: 1 on the DEM's rim, and everywhere of a sea.
/// @param post  of Surface
float air_rim_at(in vec2 post) {
    vec2 inside = min(post, frame.posts.xy - 1.0 - post) * frame.posts.zw;
    return max(1.0 - smoothstep(0.0, air_rim, min(inside.x, inside.y)), air_over_sea());
}

/// The same before ground of the DEM. @param rim  air_rim_at()
float air_scale_before(in float rim, in float distance_m) {
    return mix(air_scale_at(distance_m), air_scale_beyond(distance_m), rim);
}

uniform sampler2DArray air_sky;  // by azimuth and elevation; layers: air, sunlight that the aerosol scatters once, ground,
                                 // moonlight that the aerosol scatters once
uniform sampler3D air_between;   // by azimuth, elevation and distance, twice: light scattered more than once, and once

const vec3 air_sky_size = vec3(40.0, 72.0, 32.0);      // EyeLayout: azimuths, rows above the horizon and below
const vec3 air_between_size = vec3(24.0, 48.0, 28.0);  // azimuths, elevations, distances
const float air_even = 0.2;                            // share of the rows that are even in the sine
const float air_asymmetry = 0.8;                       // core/sky/air.h: kAerosolAsymmetry

/// Phase function of the aerosol [1/sr]. @param cosine  of the angle by which light is deflected
float air_aerosol_phase(in float cosine) {
    const float g = air_asymmetry;
    float root = inversesqrt(1.0 + g * g - 2.0 * g * cosine);
    return 0.0795774715 * (1.0 - g * g) * root * root * root;
}

/// Mean of exp(-height) along a straight line between two heights, not below 0.
float air_mean_density(in float from, in float to) {
    float a = max(from, 0.0), rise = max(to, 0.0) - a, middle = exp(-0.5 * (a + max(to, 0.0)));
    return abs(rise) < 0.1 ? middle * (1.0 + rise * rise / 24.0) : (exp(-a) - exp(-a - rise)) / rise;
}

/// Place of a direction among the azimuths, 0 towards the sun and 1 away from it.
float air_azimuth(in vec3 direction) {
    vec3 up = frame.eye_up.xyz, to_sun = frame.eye_sun.xyz;
    float sine = dot(direction, up), sun_sine = dot(to_sun, up);
    float level2 = max((1.0 - sine * sine) * (1.0 - sun_sine * sun_sine), 1e-12);
    float cosine = (dot(direction, to_sun) - sine * sun_sine) * inversesqrt(level2);
    return sqrt(clamp(0.5 - 0.5 * cosine, 0.0, 1.0));
}

/// Place of an elevation: 0 on the horizon, 1 in the zenith, -1 in the nadir. @param sine  of the elevation
float air_elevation(in float sine) {
    float above = sine - frame.eye_up.w;
    bool below = above < 0.0;
    float x = below ? -above / (1.0 + frame.eye_up.w) : above / (1.0 - frame.eye_up.w);
    float band = below ? frame.air_mapping.y : frame.air_mapping.x;
    float place = mix(sqrt(max(x * (1.0 + band) / (x + band), 0.0)), x, air_even);
    return below ? -min(place, 1.0) : min(place, 1.0);
}

/// Where a direction is in air_sky. @param elevation  air_elevation()
vec2 air_sky_place(in vec3 direction, in float elevation) {
    float row = elevation < 0.0 ? air_sky_size.y - elevation * (air_sky_size.z - 1.0) : elevation * (air_sky_size.y - 1.0);
    return vec2((air_azimuth(direction) * (air_sky_size.x - 1.0) + 0.5) / air_sky_size.x,
                (row + 0.5) / (air_sky_size.y + air_sky_size.z));
}

/// Radiance of air_sky at a place of it. @param direction  what sun and moon are scattered into
vec3 air_radiance_at(in vec2 place, in vec3 direction) {
    vec3 radiance = filtered(air_sky, vec3(place, 0.0)).rgb +
                    air_aerosol_phase(dot(direction, frame.eye_sun.xyz)) * filtered(air_sky, vec3(place, 1.0)).rgb;
#ifndef NO_MOON
    if (frame.eye_moon_light.a > 0.0)
        radiance += air_aerosol_phase(dot(direction, frame.eye_moon.xyz)) * filtered(air_sky, vec3(place, 3.0)).rgb;
#endif
    return max(radiance, 0.0);  // a few colours of dusk are outside of sRGB
}

/// Radiance of the air in a direction, up to its end or to the ground, which is not part of it.
vec3 air_radiance(in vec3 direction) {
    return air_radiance_at(air_sky_place(direction, air_elevation(dot(direction, frame.eye_up.xyz))), direction);
}

/// The same, but below the horizon that of the horizon.
vec3 air_radiance_of_sky(in vec3 direction) {
    float elevation = max(air_elevation(dot(direction, frame.eye_up.xyz)), 0.0);
    return air_radiance_at(air_sky_place(direction, elevation), direction);
}

/// What plain ground of the Earth sends through the air, for an albedo of 1; 0 above the horizon.
vec3 air_ground(in vec3 direction) {
    float sine = dot(direction, frame.eye_up.xyz);
    if (sine >= frame.eye_up.w) return vec3(0.0);
    return max(filtered(air_sky, vec3(air_sky_place(direction, air_elevation(sine)), 2.0)).rgb, 0.0);
}

/// Air that light passes: mix(radiance, light, exp(-depth)) is left of the light.
struct AirBetween {
    vec3 radiance;  // of air that lets no light through
    vec3 once;      // the part of it that is sunlight scattered once
    vec3 depth;     // optical depth in red, green and blue
};

/// Where a distance is among the slices of air_between, 0..1: EyeLayout::distance_m().
/// @param way_m  from where the ray enters the air  @param entry_m  from the eye to there
float air_slice(in float sine, in float way_m, in float entry_m) {
    float height_m = max(frame.eye_m.w, 1.0), above_ground = height_m * (12742000.0 + height_m);
    float level_m = sqrt(above_ground);
    float horizon_m = level_m - max(level_m - sqrt(max(above_ground - frame.air_colour.w, 0.0)), 0.0);
    float down = (6371000.0 + height_m) * sine, to_ground2 = down * down - above_ground;
    bool meets = sine < frame.eye_up.w && to_ground2 > 0.0;
    float to_ground_m = meets ? above_ground / (sqrt(to_ground2) - down) - entry_m : horizon_m;
    float share = min(way_m * horizon_m / (to_ground_m * frame.air_mapping.z), 1.0);
    bool high = frame.air_mapping.z < horizon_m + 1e5;  // EyeLayout::kHigh_m
    return high ? 1.0 - sqrt(1.0 - share) : sqrt(share);
}

/// The air between the eye and a point. @param direction  unit vector from the eye  @param distance_m  to the point
AirBetween air_between_eye_and(in vec3 direction, in float distance_m) {
    float sine = dot(direction, frame.eye_up.xyz);
    // An eye above the air looks through empty space first.
    float down = (6371000.0 + max(frame.eye_m.w, 0.0)) * sine;
    float entry_m = max(-down - sqrt(max(down * down - frame.air_colour.w, 0.0)), 0.0);
    float way_m = max(distance_m - entry_m, 0.0);
    vec3 at = vec3(air_azimuth(direction), 0.5 + 0.5 * air_elevation(sine), air_slice(sine, way_m, entry_m));
    vec3 size = vec3(air_between_size.xy, 2.0 * air_between_size.z);
    vec3 place = (at * (air_between_size - 1.0) + 0.5) / size;
    vec4 further = filtered(air_between, place);
    vec3 once = max(filtered(air_between, place + vec3(0.0, 0.0, 0.5)).rgb, 0.0);
    return AirBetween(max(further.rgb, 0.0) + once, once, way_m * further.a * frame.air_colour.rgb);
}
