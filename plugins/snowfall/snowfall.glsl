//! provides  falling snow: flakes before the eye, and ground and sky that fade behind them
//! hook      visibility, ambient, atmosphere, sky, image
//! reads     distance, direction; frame.seconds
//! writes    light, radiance, transmittance
//! source    extinction 3.912 / visibility: H. Koschmieder, Theorie der horizontalen Sichtweite (1924);
//!           fall of aggregates, 1 to 1.5 m/s: J. Locatelli and P. Hobbs, J. Geophys. Res. 79 (1974)

//@ include lib/ground.glsl

uniform float snowfall_visibility_m = 3000.0; //@ range(50, 20000) unit(m) label("Visibility") description("How far one sees: over 1000 m in light snow, below 500 m in heavy snow")
uniform float snowfall_light = 1.6;           //@ range(0, 2) label("Light") description("Light below the clouds, of that of a clear day, with the longer exposure that it gets")
uniform float snowfall_flakes = 1.0;          //@ range(0, 4) label("Flakes") description("Factor on the number of flakes")
uniform float snowfall_radius_mm = 3.5;       //@ range(0.5, 10) unit(mm) label("Radius") description("Of the largest flakes")
uniform float snowfall_fall_mps = 1.2;        //@ range(0, 10) unit(m/s) label("Fall")
uniform vec3 snowfall_wind = vec3(0.8, 0.3, 0.0); //@ direction label("Wind") description("Where to it blows: east, north, up")
uniform float snowfall_wind_mps = 1.0;        //@ range(0, 30) unit(m/s) label("Wind speed")
uniform float snowfall_shutter_s = 0.003;     //@ range(0, 0.2) unit(s) label("Shutter") description("Exposure time, over which flakes are drawn out")

const int snowfall_layers = 9;
const float snowfall_nearest_m = 0.7, snowfall_growth = 1.45;  // distances of the layers
const float snowfall_cells = 16.0;  // cells of a layer along its distance
const float snowfall_repeat = 64.0; // cells after which flakes repeat
const float snowfall_white = 0.95, snowfall_air = 0.7;  // radiance of flakes and of air, of that of white ground

float snowfall_transmittance(in float distance_m) {
    return exp(-3.912 * distance_m / snowfall_visibility_m);
}

/// Irradiance of level ground below the clouds, grey.
vec3 snowfall_irradiance() {
    vec3 clear = frame.sky_irradiance.rgb + frame.sun_light[0].rgb * max(frame.sun_apparent.z, 0.0);
    return vec3(snowfall_light * dot(clear, vec3(0.2126, 0.7152, 0.0722)));
}

/// Radiance of air and clouds that are filled with snow, the same all around.
vec3 snowfall_radiance() {
    return snowfall_air / 3.14159265 * snowfall_irradiance();
}

/// The clouds' light has no direction.
void snowfall_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
#if !HAS_outside
    factor = 0.0;
#endif
}

void snowfall_on_ambient(in Surface s, inout vec3 irradiance) {
#if !HAS_outside
    float open = dot(irradiance, vec3(1.0)) / max(dot(light_of_sky_at(s.height_m, s.up), vec3(1.0)), 1e-9);
    irradiance = snowfall_irradiance() * min(open, 1.0);
#endif
}

void snowfall_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {
#if !HAS_outside
    radiance = mix(snowfall_radiance(), radiance, snowfall_transmittance(s.distance_m));
#endif
}

void snowfall_on_sky(in vec3 direction, inout vec3 radiance, inout vec3 transmittance) {
    radiance = snowfall_radiance();
    transmittance = vec3(0.0);
}

/// Four even numbers of 0 to 1 for a cell of a layer. Cells repeat.
vec4 snowfall_random(in ivec3 cell, in int layer) {
    uvec3 c = uvec3(cell) & 63u;
    uint h = c.x | c.y << 6 | c.z << 12 | uint(layer) << 18;
    uvec4 r = uvec4(h, h ^ 0x9e3779b9u, h ^ 0x85ebca6bu, h ^ 0xc2b2ae35u);
    for (int i = 0; i < 2; ++i) {
        r = (r ^ (r >> 16)) * 0x7feb352du;
        r = (r ^ (r >> 15)) * 0x846ca68bu;
    }
    return vec4(r >> 8) / 16777216.0;
}

/// How much of a pixel the flake covers that is nearest to a ray at a layer, 0..1.
/// @param pixel_rad  angle of a pixel
float snowfall_flake(in int layer, in vec3 direction, in float pixel_rad) {
    float distance_m = snowfall_nearest_m * pow(snowfall_growth, float(layer));
    float cell_m = distance_m / snowfall_cells;
    vec3 velocity = snowfall_wind * snowfall_wind_mps - vec3(0.0, 0.0, snowfall_fall_mps);
    // The eye among the flakes, in cells, modulo their repetition.
    vec3 eye = vec3(frame.eye_anchor.zw, frame.eye_m.w) / cell_m;
    vec3 drift = velocity / cell_m * frame.seconds;
    eye = mod(eye, snowfall_repeat) - mod(drift, snowfall_repeat);
    ivec3 cell = ivec3(floor(eye + direction * snowfall_cells));
    vec4 random = snowfall_random(cell, layer);
    if (random.w > 0.7 * snowfall_flakes) return 0.0;
    vec3 centre = (vec3(cell) + 0.25 + 0.5 * random.xyz - eye) * cell_m;  // from the eye [m]
    float along_m = dot(centre, direction);
    if (along_m <= 0.0) return 0.0;
    // Beside the ray, where the shutter draws the flake out [pixels].
    vec3 beside = (centre - along_m * direction) / (along_m * pixel_rad);
    vec3 path = (velocity - dot(velocity, direction) * direction) * snowfall_shutter_s / (along_m * pixel_rad);
    float path_px = length(path);
    float at = path_px > 1e-3 ? clamp(dot(beside, path) / (path_px * path_px), -0.5, 0.5) : 0.0;
    float away_px = length(beside - at * path);
    float radius_px = (0.4 + 0.6 * random.w / max(0.7 * snowfall_flakes, 1e-3)) * 1e-3 * snowfall_radius_mm / (along_m * pixel_rad);
    float drawn_px = max(radius_px, 0.7);
    // Small or moving flakes are drawn larger than they are, and fainter: their light stays the same.
    float area = radius_px * radius_px / (drawn_px * drawn_px) * 2.0 * drawn_px / (2.0 * drawn_px + path_px);
    // Flakes come and go where the next layer begins.
    float far = abs(along_m / distance_m - 1.0) * snowfall_cells;
    float soft_px = max(0.7 * drawn_px, 0.5);
    return area * (1.0 - smoothstep(drawn_px - soft_px, drawn_px + soft_px, away_px)) * (1.0 - smoothstep(0.3, 0.7, far));
}

void snowfall_on_image(in Pixel p, inout vec3 radiance) {
    float pixel_rad = length(frame.pixel_ray_dx.xyz);  // in the middle of the picture
    vec3 flake = snowfall_white / 3.14159265 * snowfall_irradiance() * frame.exposure;
    for (int layer = snowfall_layers - 1; layer >= 0; --layer) {
        if (snowfall_nearest_m * pow(snowfall_growth, float(layer)) > p.distance_m) continue;
        radiance = mix(radiance, flake, snowfall_flake(layer, p.direction, pixel_rad));
    }
}
