//! provides  colours and shading of a relief map, whatever the time
//! hook      display
//! reads     generalised heights of the DEM (core/render/height_means.h), water
//! writes    the picture itself
//! source    light of a sky that is brighter on one side: P. Kennelly and A. J. Stewart, General sky models for
//!           illuminating terrains, IJGIS 28 (2014) 383; haze, warm light and cool shade: E. Imhof, Cartographic Relief
//!           Presentation (1982), chapters 9 and 13; slopes by their width: after R. Weibel, Models and experiments for
//!           adaptive computer-assisted terrain generalization, CaGIS 19 (1992) 133

//@ include lib/height_means.glsl
//@ include lib/pixel.glsl
//@ include lib/water.glsl

uniform float swiss_light = 315.0; //@ angle range(0, 360) label("Light from") description("Azimuth of the brightest part of the sky")
uniform float swiss_heights = 1.0; //@ range(0, 4) label("Heights") description("Factor on the exaggeration of slopes, which the relief of the DEM sets")
uniform float swiss_detail = 1.0; //@ range(0, 4) label("Detail") description("Factor on the finest forms, of a few pixels")
uniform float swiss_haze = 1.0; //@ range(0, 2) label("Haze") description("Factor on the haze in valleys")
uniform float swiss_floor = 0.35; //@ range(0, 1) label("Sea floor") description("How strongly the relief of a known sea floor is shaded")
uniform float swiss_low_m = 0.0; //@ range(-12000, 9000) unit(m) label("Lowest") description("Height of the first colour of land. If it is not below the highest, the DEM's own range")
uniform float swiss_high_m = 0.0; //@ range(-12000, 9000) unit(m) label("Highest") description("Height of the last colour")

const int swiss_lands = 6, swiss_seas = 4;
const vec3 swiss_land[swiss_lands] = vec3[](
    vec3(0.78, 0.87, 0.81), vec3(0.88, 0.915, 0.81), vec3(0.95, 0.935, 0.82), vec3(0.975, 0.945, 0.87),
    vec3(0.98, 0.965, 0.92), vec3(0.99, 0.99, 0.985)); //@ ramp(low_m, high_m) unit(m) label("Height")
const vec3 swiss_sea[swiss_seas] = vec3[](
    vec3(0.80, 0.89, 0.93), vec3(0.67, 0.81, 0.88), vec3(0.53, 0.71, 0.82), vec3(0.40, 0.59, 0.74)); //@ ramp(0, floor) unit(m) label("Height")
const vec3 swiss_water = vec3(0.70, 0.83, 0.90);  // lakes, and sea of unknown depth
const vec3 swiss_shade = vec3(0.31, 0.35, 0.47), swiss_sun = vec3(1.07, 1.02, 0.86);
const vec3 swiss_air = vec3(0.83, 0.885, 0.925);

const int swiss_bands = 5;  // of widths of forms, each twice as wide as the one before

/// Heights of the first and the last colour of land [m].
vec2 swiss_range() {
    float lowest = frame.height_range.x, highest = lowest + 1.0 / frame.height_range.y;
    return swiss_low_m < swiss_high_m ? vec2(swiss_low_m, swiss_high_m) : vec2(max(lowest, min(highest, 0.0)), highest);
}

/// Place in the range, 0..1.
float swiss_unit(in float height_m) {
    vec2 range = swiss_range();
    return clamp((height_m - range.x) / max(range.y - range.x, 1e-3), 0.0, 1.0);
}

vec3 swiss_land_colour(in float unit) {
    float at = unit * float(swiss_lands - 1);
    int first = min(int(at), swiss_lands - 2);
    return mix(swiss_land[first], swiss_land[first + 1], at - float(first));
}

vec3 swiss_sea_colour(in float height_m) {
    float at = clamp(height_m / min(frame.height_range.x, -1e-3), 0.0, 1.0) * float(swiss_seas - 1);
    int first = min(int(at), swiss_seas - 2);
    return mix(swiss_sea[first], swiss_sea[first + 1], at - float(first));
}

/// Light on a slope, less that on level ground, over it: of a sky with a broad bright part 45 degrees high.
float swiss_shading(in vec2 slope) {
    vec3 normal = normalize(vec3(-slope, 1.0));
    vec3 middle = vec3(0.7071 * sin(swiss_light), 0.7071 * cos(swiss_light), 0.7071);
    float light = 0.0, level = 0.0;
    for (int ring = 0; ring < 3; ++ring) {
        float high = radians(22.0 + 23.0 * float(ring));
        for (int i = 0; i < 16; ++i) {
            float azimuth = radians(22.5 * float(i));
            vec3 towards = vec3(cos(high) * vec2(sin(azimuth), cos(azimuth)), sin(high));
            float weight = cos(high) * (0.15 + 1.6 * exp(3.0 * (dot(towards, middle) - 1.0)));
            light += weight * max(dot(normal, towards), 0.0);
            level += weight * towards.z;
        }
    }
    return light / level - 1.0;
}

/// The ground of a point, generalised: fine forms of low and gentle ground are left out, broad ones are stronger.
struct swiss_Ground {
    vec2 slope;    // exaggerated, to the east and the north
    float valley;  // 0..1
};

swiss_Ground swiss_ground(in Surface s, in float unit) {
    float level = height_mean_level(s), finest = max(level, 0.0);
    vec3 band[swiss_bands + 1];  // ever smoother heights [m] and slopes
    vec3 before = height_mean(s.post, int(finest));
    for (int i = 0; i <= swiss_bands; ++i) {
        vec3 after = height_mean(s.post, int(finest) + 1 + i);
        vec3 here = mix(before, after, fract(finest));
        band[i] = vec3(here.x, height_mean_slope(here.yz));
        before = after;
    }
    float z = swiss_heights * height_mean_exaggeration();
    float steep = z * length(band[2].yz);
    float detail = clamp(0.15 + 0.45 * smoothstep(0.05, 0.5, unit) + 0.7 * smoothstep(0.15, 0.6, steep), 0.0, 1.0);
    vec2 slope = 1.5 * band[swiss_bands].yz;
    for (int i = 0; i < swiss_bands; ++i) {
        float share = i == 0 ? 0.9 * swiss_detail * detail : i == 1 ? mix(1.0, detail, 0.7) : 0.75 + 0.2 * float(i);
        share *= smoothstep(-2.0, 1.0, level + float(i));  // the finest forms of a DEM are noise
        slope += share * (band[i].yz - band[i + 1].yz);
    }
    float widest_m = height_mean_texel_m() * exp2(finest + float(swiss_bands + 1));
    float below = z * (band[swiss_bands].x - band[0].x) / widest_m;
    float low = max((1.0 - smoothstep(0.0, 0.4, unit)), smoothstep(0.0, 0.35, below) * (1.0 - unit));
    slope *= z / (1.0 + 0.3 * z * length(slope));  // the steepest ground keeps its form in the shade
    return swiss_Ground(slope, low * (1.0 - smoothstep(0.15, 0.7, steep)));
}

vec3 swiss_colour(in Surface s) {
    float unit = swiss_unit(s.height_m);
    swiss_Ground ground = swiss_ground(s, unit);
    float light = swiss_shading(ground.slope) * (0.7 + 0.5 * smoothstep(0.02, 0.5, unit));
    float dark = 1.0 - exp(min(2.2 * light, 0.0)), bright = clamp(light, 0.0, 1.0);
    vec3 colour = swiss_land_colour(unit) * mix(vec3(1.0), swiss_shade, dark) * mix(vec3(1.0), swiss_sun, bright);
    colour = mix(colour, swiss_air, 0.32 * swiss_haze * ground.valley);
    vec4 water = water_of(s);
    float floor_share = water.x * water.y * water.z;
    vec3 sea = swiss_sea_colour(s.height_m) * (1.0 + swiss_floor * clamp(light, -0.9, 0.4));
    colour = mix(colour, sea, floor_share);
    return mix(colour, swiss_water, water.x - floor_share);
}

void swiss_on_overlay(in Pixel p, inout vec4 over) {
    if (p.distance_m >= kSky_m) over = vec4(1.0);  // paper
}

/// Puts a colour below lines and rasters that are drawn already.
vec4 swiss_below(in vec4 over, in vec3 colour) {
    return over + (1.0 - over.a) * vec4(clamp(colour, 0.0, 1.0), 1.0);
}

void swiss_on_display(in Surface s, inout vec4 overlay) {
    overlay = swiss_below(overlay, swiss_colour(s));
}
