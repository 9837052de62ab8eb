//! provides  water where the DEM has sea and lakes, or up to a level: a mirror of the sky with the sun's
//!           glitter, and the floor seen through it
//! hook      displace, material, lit
//! reads     water pages, height [m], diffuse, the sky's radiance without the sun's disc
//! writes    position; normal, diffuse, ambient, specular, shininess; radiance
//! source    light in water: R. M. Pope and E. S. Fry, Applied Optics 36 (1997), 8710, and A. Bricaud, A. Morel
//!           and L. Prieur, Limnology and Oceanography 26 (1981), 43; waves: C. Cox and W. Munk,
//!           J. Optical Society of America 44 (1954), 838; their mirror: E. Bruneton, F. Neyret and N.
//!           Holzschuch, Real-time realistic ocean lighting, Computer Graphics Forum 29 (2010), 487

//@ include lib/surface.glsl
//@ include lib/water.glsl

uniform float sea_level_m = 0.0; //@ range(-500, 9000) unit(m) label("Level") description("0: water where the DEM has sea and lakes. Otherwise all ground at or below this height is flooded")
uniform float sea_least_depth_m = 10.0; //@ range(0, 1000) unit(m) label("Least depth") description("Added to the depth of flooded ground, whose height may equal the level")
uniform float sea_wind_m_s = 5.0; //@ range(0, 20) unit(m/s) label("Wind") description("Wind speed: more wind widens the sun's glitter")
uniform float sea_yellow = 0.2; //@ range(0, 10) unit(1/m) label("Yellow substance") description("Absorption at 440 nm by dissolved matter: 0.01 in the open ocean, 0.2 near a coast, above 1 in an estuary")

const vec3 sea_absorption = vec3(0.264, 0.0565, 0.0101);  // of pure water at 610, 550 and 465 nm [1/m]
const vec3 sea_yellow_by_colour = vec3(0.0925, 0.214, 0.705);  // exp(-0.014 (wavelength - 440 nm))
const vec3 sea_scattered = vec3(0.004, 0.026, 0.036);     // albedo of deep water, chosen by eye: blue-green

const vec3 sea_sand = vec3(0.30, 0.28, 0.21);  // of a floor whose colour nobody knows, chosen by eye
const float sea_tide_m = 2.0;  // added to its depth: charts count from low water
// And so much for each metre between posts: shelves slope by a hundredth or less, so that a shallow post says nothing
// of the water half-way to the next one, and bright plates with the grid's corners would tell of the grid.
const float sea_shelf = 0.01;

/// How much of a flood a point is: all of it up to the level, none from 0.3 m above on.
float sea_share(in float height_m) {
    return 1.0 - smoothstep(sea_level_m, sea_level_m + 0.3, height_m);
}

/// Height of the DEM itself at a point. The ground is drawn as coarsely as the picture allows, and coasts
/// and shadows on the water would move with that.
float sea_height_m(in Surface s) {
    return s.height_m + dot(surface_point(s) - s.position_m, s.up) / frame.height_range.z;
}

/// Mean square slope of the waves. source: Cox and Munk, clean surface
float sea_roughness() {
    return 0.003 + 0.00512 * sea_wind_m_s;
}

/// Share of the light that rough water mirrors, on average over its waves.
/// source: Bruneton et al., section 4.3; C. Schlick, Computer Graphics Forum 13 (1994), 233
/// @param cosine  between the view and the vertical
float sea_mirrored(in float cosine) {
    float slope = sqrt(0.5 * sea_roughness());  // along the view, which is half of all
    float grazing = 1.0 - clamp(cosine, 0.0, 1.0);
    return 0.02 + 0.98 * pow(grazing, 5.0 * exp(-2.69 * slope)) / (1.0 + 22.7 * slope * sqrt(slope));
}

/// Albedo of water over a floor: light goes down to it and up again.
vec3 sea_albedo(in vec3 floor_albedo, in float depth_m) {
    vec3 passed = exp(-2.0 * (sea_absorption + sea_yellow * sea_yellow_by_colour) * depth_m);
    return sea_scattered + floor_albedo * passed;
}

/// Highlight of the waves that mirror the sun, as Phong's exponent and its peak over the irradiance.
/// source: Cox and Munk's Gaussian of slopes; a lobe of normals cos^n has n = 2 / variance, one of mirrored
/// rays a quarter of that
vec2 sea_glitter(in float cosine) {
    float variance = sea_roughness();
    return vec2(0.5 / variance, sea_mirrored(cosine) / (4.0 * variance * max(cosine, 0.15)));
}

/// What stands on a point: x, the share that is water; y, how deep its floor is seen [m].
vec2 sea_water(in Surface s, in float height_m) {
    if (sea_level_m != 0.0)
        return vec2(sea_share(height_m), max(sea_level_m - height_m, 0.0) + sea_least_depth_m);
    const float unseen_m = 1000.0;
    vec4 water = water_of(s);
    return vec2(water.x, mix(unseen_m, max(-height_m, 0.0) + sea_tide_m + sea_shelf / frame.normal_texels_per_m, water.y * water.z));
}

/// From a floor up to the level.
vec3 sea_lift_m(in VertexFrame v) {
    return max(sea_level_m - v.height_m, 0.0) * frame.height_range.z * v.up;
}

void sea_on_displace(in VertexFrame v, inout vec3 position_m) {
    bool floods = sea_level_m != 0.0;
    float depth_m = sea_level_m - v.height_m;
    // A lake's heights are its surface already, whatever its level.
    vec4 water = floods || depth_m <= 0.0 ? vec4(1.0) : water_at(v.post, 1.0);
    float lifted = water.x > 0.0 && water.y > 0.5 ? 1.0 : 0.0;
    position_m += lifted * sea_lift_m(v);
}

void sea_on_material(inout Surface s) {
    float height_m = sea_height_m(s);
    vec2 stands = sea_water(s, height_m);
    float water = stands.x;
    vec3 albedo = sea_albedo(sea_level_m != 0.0 ? s.diffuse : sea_sand, stands.y);
    vec2 glitter = sea_glitter(-dot(s.position_m, s.up) / s.distance_m);
    // Who asks for the surface gets that of the water, not how far the drawn floor is off.
    s.height_m = mix(s.height_m, height_m, water);
    s.geometric_normal = normalize(mix(s.geometric_normal, s.up, water));
    s.normal = normalize(mix(s.normal, s.up, water));
    s.diffuse = mix(s.diffuse, albedo, water);
    s.ambient = mix(s.ambient, albedo, water);
    s.shininess = mix(s.shininess, glitter.x, water);
    // Low over the water the glitter is many times as bright as snow, which no picture can show.
    s.specular = mix(s.specular, vec3(min(glitter.y, 0.4)), water);
}

void sea_on_lit(in Surface s, inout vec3 radiance) {
    vec3 view = s.position_m / s.distance_m;
    float cosine = -dot(view, s.up);
    // What is mirrored in waves lies higher than in a level mirror, and never below the horizon.
    vec3 mirrored = view + (2.0 * max(cosine, 0.0) + sqrt(sea_roughness())) * s.up;
    float share = sea_water(s, sea_height_m(s)).x * sea_mirrored(cosine);
    radiance = mix(radiance, background_radiance(normalize(mirrored), false), share);
}
