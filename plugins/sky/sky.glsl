//! provides  the sky: its colours, the sun and the stars in it, and its light on slopes
//! hook      background_radiance, beyond, ambient
//! reads     directions of the view, and of sun and moon with refraction; height of the eye [m]
//! writes    radiance, linear sRGB; irradiance
//! source    Costa and Celes, Tecnicas simples para visualizacao foto-realista de terrenos em tempo real
//!           usando placas graficas programaveis (Tecgraf, PUC-Rio), equations 1 to 3; the textures are
//!           made by tools/sky, which names its model; stars: the Bright Star Catalogue

//@ include lib/air.glsl
//@ include lib/air_pixel.glsl
//@ include lib/beyond.glsl
//@ include lib/filtered.glsl
//@ include lib/ground.glsl
//@ include lib/moon.glsl
//@ include lib/surround.glsl

uniform sampler3D sky_light;  // irradiance of slopes over that of level ground, by azimuth from the sun, normal and sun's elevation (tools/sky/textures.h)
uniform sampler2DArray sky_times;  // the paper's day, sunset and night
uniform sampler3D sky_star_cells;  // by direction, unfolded like an octahedron; a column of stars

uniform int sky_colours = 0; //@ enum(model, three) static label("Colours") description("model: the clear atmosphere. three: the paper's skies of day, sunset and night, blended by the sun's elevation")
uniform float sky_brightness = 1.3; //@ range(0, 10) label("Brightness") description("For sky.colours three: brightness of the sky without glow and disc; above 1 because the glow is weaker than a real aureole")
uniform float sky_horizon = 0.5; //@ range(0.05, 2) label("Horizon") description("For sky.colours three: exponent of the paper's equation 3 at sea level; higher values extend the horizon's colours upwards")
uniform float sky_day_deg = 25.0; //@ angle range(1, 90) unit(deg) label("Day from") description("For sky.colours three: elevation of the sun above which only the sky of day is used")
uniform float sky_night_deg = -12.0; //@ angle range(-90, -1) unit(deg) label("Night from") description("For sky.colours three: elevation of the sun below which only the sky of night is used")

uniform float sky_power = 20.0; //@ range(1, 4000) label("Glow, power") description("For sky.colours three: least exponent of the glow around the sun (the paper's equation 1); the next two are 4 and 16 times it")
uniform vec3 sky_weights = vec3(0.133, 0.532, 0.346); //@ range(0, 1) label("Glow, weights") description("For sky.colours three: weights of the glow's three powers; all 1 in the paper")
uniform float sky_aureole = 0.3; //@ range(0, 100) label("Glow") description("For sky.colours three: brightness of the glow, relative to the sunlight at the camera")
uniform bool sky_air_mass = true; //@ static label("Glow by air mass") description("For sky.colours three: more glow around a low sun, which shines through more air; off in the paper")
uniform float sky_disc_power = 65000.0; //@ range(100, 1000000) label("Power of the disc") description("Size of the sun's disc: 65000 falls to one half at 0.265 degrees, the sun's true size")
uniform float sky_disc = 30.0; //@ range(0, 10000) label("Disc") description("Brightness of the sun's disc, relative to the sunlight at the camera")
uniform float sky_disc_edge = 8.0; //@ range(1, 100) label("Edge of the disc") description("Sharpness of the disc's edge; 1, a soft spot, in the paper")

uniform float sky_stars = 1.0; //@ range(0, 1000) label("Stars") description("Brightness relative to the true one; 0: no stars")

uniform bool sky_earth = true; //@ static label("Earth") description("On: plain ground below the horizon, lit by sun and sky and seen through its air. Off: the colour of the horizon, as in the paper")
uniform vec3 sky_earth_albedo = vec3(0.13, 0.14, 0.10); //@ range(0, 1) label("Albedo of the Earth") description("Albedo of the ground outside the DEM, and around a slope")
uniform bool sky_earth_sea = true; //@ static label("Sea around the DEM") description("On: the sea continues beyond a DEM that is mostly sea. Off: the albedo of the Earth")
uniform float sky_earth_depth = 0.12; //@ range(0, 10) label("Air above the Earth") description("For sky.colours three: vertical optical depth of the air over the ground outside the DEM")

uniform bool sky_slopes = true; //@ static label("Light by direction") description("On: a slope receives light from the part of the sky that it faces and from the ground around it. Off: the same light everywhere")

const float sky_fold = 0.14;       // tools/sky/textures.h: how heights of the sun are spread ...
const float sky_lowest = 0.68822;  // ... over the slices: folded(sin 18 deg)
const float sky_span = 1.56541;    // folded(1) + folded(sin 18 deg)
const vec3 sky_size = vec3(48.0, 64.0, 1.0);         // texels of the paper's skies
const vec3 sky_light_size = vec3(12.0, 12.0, 40.0);  // and of the light of slopes

/// The horizontal part of a direction, unit length; shrinks to 0 over the last 0.6 degrees before the
/// zenith, which has none.
vec3 sky_level(in vec3 direction, in vec3 up) {
    vec3 level = direction - dot(direction, up) * up;
    return level * inversesqrt(max(dot(level, level), 1e-4));
}

/// Equation 2: 0 away from the sun, 1 towards it, one half where one of the two is the zenith.
float sky_s(in vec3 to_sun, in vec3 direction, in vec3 up) {
    return 0.5 * dot(sky_level(to_sun, up), sky_level(direction, up)) + 0.5;
}

/// The exponent h of equation 3. The horizon's white is the air between eye and space, which thins by
/// e every 8.43 km: an eye up there sees a narrower band of it.
float sky_exponent(in float eye_height_m) {
    return sky_horizon * exp(-clamp(eye_height_m, 0.0, 20000.0) / 8430.0);
}

/// Equation 3: 0 on the horizon and below, 1 in the zenith.
/// @param sine  of the elevation
float sky_t(in float sine, in float exponent) {
    return sine > 0.0 ? pow(min(sine, 1.0), exponent) : 0.0;
}

/// The sine of an elevation that counts from the horizon, which lies the lower the higher the eye.
float sky_above_horizon(in float sine) {
    return (sine - frame.eye_up.w) / (1.0 - frame.eye_up.w);
}

/// How high the air stands above the horizon, as a sine: for a high eye, air 17 km thick as far away as
/// the horizon is. In it the sky's colours come gradually, which equation 3 there has in no angle at all.
float sky_band() {
    float dip = max(-frame.eye_up.w, 1e-4);
    return min(dip, 0.0027 / dip);
}

/// Light that the air between eye and ground scatters towards the eye, of air that lets none through.
/// @param cosine  of the angle between the view and the sun
vec3 sky_air_light(in float cosine) {
    // The mean of a phase function over all directions is 1; this is 2 towards the sun, 0.5 away from it.
    float phase = 0.5 + 0.375 * (1.0 + cosine) * (1.0 + cosine);
    // A quarter: white ground spreads light over a half space, weighted with the cosine, air over all of it.
    return 0.2 * phase * frame.sun_light[0].rgb + 0.5 * frame.sky_irradiance.rgb;
}

/// Albedo of the plain ground beyond the DEM.
vec3 sky_beyond() {
    return sky_earth_sea ? mix(sky_earth_albedo, surround_sea_albedo, surround_sea()) : sky_earth_albedo;
}

/// What level ground sends upwards.
vec3 sky_ground(in float sun_sine) {
    float sine = frame.eye_moon_light.a > 0.0 ? frame.sun_apparent.z : sun_sine;
    return sky_beyond() * (frame.sky_irradiance.rgb + max(sine, 0.0) * frame.sun_light[0].rgb);
}

/// Plain ground beyond the DEM, through the air above it. @param below  sine, counted from the horizon down
vec3 sky_ground_seen(in vec3 air_light, in float sun_sine, in float below) {
    return mix(air_light, sky_ground(sun_sine), exp(-sky_earth_depth / max(below, 1e-3)));
}

/// Light of the ground around on a slope, of which a slope sees the more the steeper it is.
/// @param cosine  of the slope  @param level  irradiance of level ground
vec3 sky_bounce(in float cosine, in vec3 level) {
    return (0.5 - 0.5 * cosine) * sky_earth_albedo * level;
}

/// Equation 1 without its narrowest term. @param cosine  L . V
float sky_glow(in float cosine) {
    float broad = pow(max(cosine, 0.0), sky_power);
    float middle = broad * broad * broad * broad;
    return dot(sky_weights, vec3(broad, middle, middle * middle * middle * middle));
}

/// The narrowest term, (L . V)^k. The cosine of so small an angle has lost it by the time that it is
/// a float: with k = 65000 the power itself is off by 9e-3, this by 1e-5.
/// @param distance2  |L - V|^2
float sky_narrow(in float distance2) {
    return exp(-0.5 * sky_disc_power * distance2);
}

/// The disc: one half where the sun's limb is, whatever the sharpness of the edge.
float sky_sun(in float distance2) {
    return clamp(0.5 + sky_disc_edge * (sky_narrow(distance2) - 0.5), 0.0, 1.0);
}

/// Relative air mass. source: G. V. Rozenberg, Twilight, 1966: at most 40, on the horizon
float sky_air_mass_of(in float sun_sine) {
    float sine = max(sun_sine, 0.0);
    return 1.0 / (sine + 0.025 * exp(-11.0 * sine));
}

/// Place of a height of the sun among the slices, 0..1.
float sky_slice(in float sun_sine) {
    return clamp((sun_sine / (sky_fold + abs(sun_sine)) + sky_lowest) / sky_span, 0.0, 1.0);
}

/// Weights of day, sunset and night, sum 1: two at most above zero.
vec3 sky_blend(in float sun_sine) {
    float day = clamp(sun_sine / sin(sky_day_deg), 0.0, 1.0);
    float night = clamp(sun_sine / sin(sky_night_deg), 0.0, 1.0);
    return vec3(day, 1.0 - day - night, night);
}

/// Texture coordinates that have the first and the last texel's centre at 0 and 1.
vec3 sky_texel(in vec3 at, in vec3 size) {
    return at * (1.0 - 1.0 / size) + 0.5 / size;
}

const float sky_star_grid = 96.0;  // tools/sky/stars.h: cells across,
const float sky_star_width = 0.6;  // standard deviation of a star's image [px],
const float sky_star_scattered = 0.15;  // and the share of its light that is three times as wide
const float sky_star_reach = 2.8e-5;  // greatest variance [rad2]: a star ends 1 degree from its place
// Magnitude 0 as a share of the sun's light, whose own is -26.76. source: C. N. A. Willmer, The
// Absolute Magnitude of the Sun in Several Filters, Astrophys. J. Suppl. 236 (2018) 47
const float sky_star_light = 1.977e-11;
// Optical depth of a clear zenith at sea level. source: core/sun/daylight.h, direct_transmittance
const vec3 sky_depth = vec3(0.176, 0.210, 0.304);

/// How far refraction moves a direction up, as a length along the vertical.
/// source: fitted to G. G. Bennett, J. Navigation 35 (1982) 255, to 0.5 arcsec from -0.5 degrees up
/// @param sine  of the apparent elevation, -0.01 or more
float sky_bend(in float sine) {
    return 0.00029043 / (sine + 0.0022149 / (sine + 0.0765018));
}

/// Where a star is catalogued that is seen in a direction of the local frame: ICRS, unit.
vec3 sky_catalogued(in vec3 direction, in vec3 up) {
    float sine = max(dot(direction, up), -0.01);
    vec3 airless = normalize(direction - frame.eye_sun_light.a * sky_bend(sine) * up);
    return normalize(vec3(dot(frame.celestial[0].xyz, airless) - frame.celestial[0].w,
                          dot(frame.celestial[1].xyz, airless) - frame.celestial[1].w,
                          dot(frame.celestial[2].xyz, airless) - frame.celestial[2].w));
}

/// Turns the lower half of an octahedron outwards; is its own inverse.
vec2 sky_fold_over(in vec2 p) {
    return (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
}

ivec2 sky_star_cell(in vec3 direction) {
    vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    vec2 p = d.z < 0.0 ? sky_fold_over(d.xy) : d.xy;
    return clamp(ivec2((0.5 * p + 0.5) * sky_star_grid), ivec2(0), ivec2(sky_star_grid) - 1);
}

vec3 sky_star_centre(in ivec2 cell) {
    vec2 p = (2.0 * vec2(cell) + 1.0) / sky_star_grid - 1.0;
    float z = 1.0 - abs(p.x) - abs(p.y);
    return normalize(vec3(z < 0.0 ? sky_fold_over(p) : p, z));
}

/// Illuminance of a star in multiples of magnitude 0, as a colour. @param code  tools/sky/stars.h
vec3 sky_star_colour(in float code) {
    float mag_steps = floor((code - 1.0) / 16.0);
    float colour_steps = code - 1.0 - 16.0 * mag_steps;
    float b_v = 0.15 * colour_steps - 0.35;
    float red = 0.7829 + b_v * (0.3121 + b_v * 0.0325);
    float blue = 1.567 + b_v * (0.2023 * b_v - 0.9949);
    float green = (1.0 - 0.2126 * red - 0.0722 * blue) / 0.7152;
    // 10^(-0.4 m)
    return exp2(-1.3287712 * (0.0625 * mag_steps - 1.5)) * vec3(red, green, blue);
}

/// Variance of a star's image [rad2]: of the same size all over the picture, where a pixel is smaller
/// towards the edges.
float sky_star_spread(in vec3 direction) {
    vec3 ahead = cross(frame.pixel_ray_dy.xyz, frame.pixel_ray_dx.xyz);
    float pixel = length(ahead);  // solid angle of the middle one
    float cosine = dot(ahead, direction) / pixel;
    return sky_star_width * sky_star_width * pixel * cosine * cosine * cosine;
}

/// Light of the stars as the air lets it through.
vec3 sky_starlight(in vec3 direction, in vec3 up) {
    vec3 there = sky_catalogued(direction, up);
    ivec2 cell = sky_star_cell(there);
    vec3 from_centre = there - sky_star_centre(cell);
    // A point's image: what is sharp, and what lens and eye scatter, by which one sees how bright it is.
    float spread = sky_star_spread(direction);
    float sharp = 0.5 / min(spread, sky_star_reach), soft = 0.5 / min(9.0 * spread, sky_star_reach);
    int last = textureSize(sky_star_cells, 0).z;
    vec3 light = vec3(0.0);
    for (int i = 0; i < last; ++i) {
        vec4 star = texelFetch(sky_star_cells, ivec3(cell, i), 0);
        if (star.a == 0.0) break;
        vec3 apart = from_centre - star.rgb;
        float apart2 = dot(apart, apart);
        light += sky_star_colour(star.a) * mix(sharp * exp(-sharp * apart2),
                                               soft * exp(-soft * apart2), sky_star_scattered);
    }
    float mass = sky_air_mass_of(dot(direction, up)) *
                 exp(-clamp(frame.eye_m.w, 0.0, 20000.0) / 8430.0);
    // Radiance 1 is an irradiance of 1 shared out over pi, and a Gaussian's peak 1 / (2 pi variance).
    return sky_stars * sky_star_light * light * exp(-mass * sky_depth);
}

float sky_luminance() {
    return dot(frame.sky_irradiance.rgb, vec3(0.2126, 0.7152, 0.0722));
}

/// The paper's skies: three, blended by the sun's height, with the sun's glow.
vec3 sky_of_paper(in vec3 direction, in bool with_disc) {
    vec3 up = frame.eye_up.xyz;
    vec3 to_sun = frame.eye_sun.xyz;
    float sun_sine = dot(to_sun, up);
    float sine = dot(direction, up);
    float above = sky_earth ? sky_above_horizon(sine) : sine;
    vec2 at = vec2(sky_s(to_sun, direction, up), sky_t(above, sky_exponent(frame.eye_m.w)));
    if (sky_earth) at.y *= smoothstep(0.0, sky_band(), above);
    vec2 texel = sky_texel(vec3(at, 0.0), sky_size).xy;
    vec3 blend = sky_blend(sun_sine);
    vec3 colour = vec3(0.0);
    for (int time = 0; time < 3; ++time)  // day, sunset, night
        colour += blend[time] * filtered(sky_times, vec3(texel, float(time))).rgb;
    float haze = sky_air_mass ? sky_air_mass_of(sun_sine) : 1.0;
    float cosine = dot(to_sun, direction);
    vec3 radiance = sky_brightness * sky_luminance() * colour +
                    sky_aureole * haze * sky_glow(cosine) * frame.eye_sun_light.rgb;
    if (!sky_earth) return radiance;
    // Light from the horizon comes through much air, from below the horizon through less.
    vec3 air_light = mix(radiance, sky_air_light(cosine), smoothstep(0.0, 0.2, -above));
    return with_disc && above < 0.0 ? sky_ground_seen(air_light, sun_sine, -above) : air_light;
}

/// Sun, moon and stars, which stand over the horizon.
vec3 sky_bodies(in vec3 direction) {
    vec3 up = frame.eye_up.xyz, to_sun = frame.eye_sun.xyz;
    vec3 apart = to_sun - direction;
    float uncovered = moon_uncovered(direction);
    vec3 radiance = uncovered * sky_disc * sky_sun(dot(apart, apart)) * frame.eye_sun_light.rgb;
#if HAS_night
    radiance += uncovered * sky_starlight(direction, up);
#endif
    return radiance + moon_on_sky(direction, to_sun, uncovered);
}

/// Glow of the moon in the paper's skies, as that of the sun.
vec3 sky_moon_glow(in vec3 direction) {
    return sky_aureole * sky_air_mass_of(dot(frame.eye_moon.xyz, frame.eye_up.xyz)) *
           sky_glow(dot(frame.eye_moon.xyz, direction)) * frame.eye_moon_light.rgb;
}

vec3 sky_on_background_radiance(in vec3 direction, in bool with_disc) {
    vec3 radiance;
    if (sky_colours == 0) {
        air_in_sky = true;
        // What fades into the sky, and mirrors, see no ground.
        radiance = with_disc && sky_earth ? air_radiance(direction) + sky_beyond() * air_ground(direction)
                                          : air_radiance_of_sky(direction);
        vec4 beyond = with_disc && sky_earth ? beyond_seen(direction) : vec4(0.0);
        radiance = mix(radiance, beyond.rgb, beyond.a);
        if (with_disc) radiance = sky_behind_clouds(radiance);
    } else {
        radiance = sky_of_paper(direction, with_disc);
#if HAS_night
        if (frame.eye_moon_light.a > 0.0) radiance += sky_moon_glow(direction);
#endif
    }
    // What has set is behind the Earth.
    if (with_disc && dot(direction, frame.eye_up.xyz) > frame.eye_up.w) radiance += sky_bodies(direction);
    return radiance;
}

/// Ground beyond the DEM, with the air before it as the DEM has it.
vec3 sky_on_beyond(in Surface s, in vec3 view) {
    float sea = sky_earth_sea ? surround_sea_here(s.ground_m.xy, s.up) : 0.0;
    vec3 to_sun, direct = sun_light_at(s.height_m, s.up, to_sun);
    float facing = dot(to_sun, normalize(mix(s.normal, s.up, sea)));
    vec3 light = light_of_sky_at(s.height_m, s.up) + max(facing, 0.0) * direct;
    // Where the floor is seen, the sea is a map, and mirrors nothing.
    bool is_map = frame.sea_floor_share > 0.1;
    float cosine = -dot(view, s.up), mirrored = is_map ? 0.0 : sea * surround_mirrored(cosine);
    vec3 radiance = light * mix(s.diffuse, is_map ? surround_sea_albedo : surround_deep_albedo, sea);
    radiance = mix(radiance, sky_on_background_radiance(normalize(view + 2.0 * cosine * s.up), false), mirrored);
    AirBetween air = air_between_eye_and(view, s.distance_m);
    return mix(air.radiance, radiance, exp(-air_scale_beyond(s.distance_m) * air.depth));
}

void sky_on_ambient(in Surface s, inout vec3 irradiance) {
    irradiance = light_of_sky_at(s.height_m, s.up);
    if (sky_slopes) {
        vec3 to_sun = frame.eye_sun.xyz, to_light;
        vec3 at = vec3(sky_s(to_sun, s.normal, s.up), clamp(dot(s.normal, s.up), 0.0, 1.0),
                       sky_slice(dot(to_sun, s.up)));
        vec3 direct = sun_light_at(s.height_m, s.up, to_light);
        vec3 level = irradiance + max(dot(to_light, s.up), 0.0) * direct;
        irradiance = irradiance * filtered(sky_light, sky_texel(at, sky_light_size)).rgb +
                     sky_bounce(dot(s.normal, s.up), level);
    }
}
