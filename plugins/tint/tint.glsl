//! provides  colours by height (hypsometric tints), slope or aspect; or one for all ground
//! hook      material, visibility, ambient, display
//! reads     height [m], the DEM's own normal, water pages
//! writes    diffuse, ambient, specular, normal of water, light of sun and sky; where it is unlit the picture itself
//! source    tints: after E. Imhof, Cartographic Relief Presentation (1982), chapter 13, from the green
//!           of lowlands over ochre to the white of heights, and blues that darken with depth

//@ include lib/ground.glsl
//@ include lib/srgb.glsl
//@ include lib/water.glsl

uniform int tint_by = 0; //@ enum(height, slope, aspect, plain) static label("Colour by") description("What the colour shows")
uniform bool tint_lit = true; //@ static label("Lit") description("On: lit by the sun. Off: exactly the colours of the legend")
uniform float tint_low_m = 0.0; //@ range(-12000, 9000) unit(m) label("Lowest") description("Height of the first colour of land. If it is not below the highest, the DEM's own range")
uniform float tint_high_m = 0.0; //@ range(-12000, 9000) unit(m) label("Highest") description("Height of the last colour")
uniform vec3 tint_plain = vec3(0.72, 0.71, 0.69); //@ colour label("Plain") description("Colour of the ground if Colour by is plain")
uniform float tint_sun = 1.0; //@ range(0, 1) label("Sun") description("Factor on the direct sunlight")
uniform float tint_sky = 1.0; //@ range(0, 20) label("Sky") description("Factor on the light of the sky")
uniform float tint_sky_colour = 1.0; //@ range(0, 1) label("Colour of the sky") description("Share of its colour that the sky's light keeps; 0: white light")

// sRGB: what lies between two is mixed as it is seen. Seas from the shore down, slopes every 10 degrees, aspects every 45.
const int tint_lands = 8, tint_seas = 4, tint_slopes = 7, tint_aspects = 8;
const vec3 tint_land[tint_lands] = vec3[](
    vec3(0.475, 0.643, 0.518), vec3(0.651, 0.757, 0.561), vec3(0.831, 0.847, 0.647), vec3(0.910, 0.835, 0.620),
    vec3(0.843, 0.702, 0.502), vec3(0.745, 0.588, 0.451), vec3(0.749, 0.690, 0.647), vec3(0.957, 0.949, 0.937)); //@ ramp(low_m, high_m) unit(m) label("Height") where(by, height)
const vec3 tint_sea[tint_seas] = vec3[](
    vec3(0.741, 0.859, 0.902), vec3(0.541, 0.733, 0.831), vec3(0.333, 0.565, 0.733), vec3(0.173, 0.365, 0.569)); //@ ramp(0, floor) unit(m) label("Height") where(by, height)
const vec3 tint_slope[tint_slopes] = vec3[](
    vec3(0.965, 0.961, 0.937), vec3(0.953, 0.914, 0.702), vec3(0.961, 0.812, 0.427), vec3(0.933, 0.604, 0.271),
    vec3(0.851, 0.318, 0.184), vec3(0.659, 0.118, 0.235), vec3(0.353, 0.067, 0.314)); //@ ramp(0, 60) unit(°) label("Slope") where(by, slope)
const vec3 tint_aspect[tint_aspects] = vec3[](
    vec3(0.290, 0.435, 0.690), vec3(0.310, 0.624, 0.682), vec3(0.361, 0.722, 0.478), vec3(0.714, 0.812, 0.361),
    vec3(0.949, 0.812, 0.290), vec3(0.918, 0.569, 0.251), vec3(0.812, 0.353, 0.373), vec3(0.561, 0.353, 0.627)); //@ ramp(ring) label("Aspect") where(by, aspect)
const vec3 tint_level = vec3(0.851, 0.851, 0.831);  // ground without aspect

const vec3 tint_water = vec3(0.624, 0.784, 0.863);  // lakes, and sea of unknown depth

/// Heights of the first and the last colour of land [m].
vec2 tint_range() {
    float lowest = frame.height_range.x, highest = lowest + 1.0 / frame.height_range.y;
    return tint_low_m < tint_high_m ? vec2(tint_low_m, tint_high_m) : vec2(max(lowest, min(highest, 0.0)), highest);
}

/// Colour of a sea floor [m]; sRGB, as of all here.
vec3 tint_of_floor(in float height_m) {
    float at = clamp(height_m / min(frame.height_range.x, -1e-3), 0.0, 1.0) * float(tint_seas - 1);
    int first = min(int(at), tint_seas - 2);
    return mix(tint_sea[first], tint_sea[first + 1], at - float(first));
}

/// Colour of the height of land [m], which may be dry below 0.
vec3 tint_of_height(in float height_m) {
    vec2 range = tint_range();
    float at = clamp((height_m - range.x) / max(range.y - range.x, 1e-3), 0.0, 1.0) * float(tint_lands - 1);
    int first = min(int(at), tint_lands - 2);
    return mix(tint_land[first], tint_land[first + 1], at - float(first));
}

/// Colour of a slope [degrees].
vec3 tint_of_slope(in float slope_deg) {
    float at = clamp(slope_deg / 10.0, 0.0, float(tint_slopes - 1));
    int first = min(int(at), tint_slopes - 2);
    return mix(tint_slope[first], tint_slope[first + 1], at - float(first));
}

/// Colour of the direction that a slope faces [degrees from north by east]; level ground has none.
vec3 tint_of_aspect(in float aspect_deg, in float slope_deg) {
    float at = mod(aspect_deg / 45.0, float(tint_aspects));
    int first = int(at) % tint_aspects;
    vec3 facing = mix(tint_aspect[first], tint_aspect[(first + 1) % tint_aspects], at - floor(at));
    return mix(tint_level, facing, smoothstep(0.5, 3.0, slope_deg));
}

/// Where ground faces whose normal leans so far to the east and to the north.
float tint_aspect_deg(in vec2 leans) {
    return degrees(atan(leans.x, leans.y + 1e-9));
}

/// Share of a point that is water whose floor the DEM does not have.
float tint_flat_share(in vec4 water) {
    return water.x * (1.0 - water.y * water.z);
}

/// Colour of ground, dry or the floor of a sea.
vec3 tint_of_ground(in Surface s, in vec4 water) {
    if (tint_by == 0) return mix(tint_of_height(s.height_m), tint_of_floor(s.height_m), water.x * water.y * water.z);
    float slope_deg = degrees(acos(clamp(dot(s.ground_normal, s.up), 0.0, 1.0)));
    if (tint_by == 1) return tint_of_slope(slope_deg);
    vec3 east = east_at(s.up);
    vec2 leans = vec2(dot(s.ground_normal, east), dot(s.ground_normal, cross(s.up, east)));
    return tint_of_aspect(tint_aspect_deg(leans), slope_deg);
}

vec3 tint_colour(in Surface s) {
    vec4 water = water_of(s);
    return mix(tint_of_ground(s, water), tint_water, tint_flat_share(water));
}


void tint_on_material(inout Surface s) {
    s.diffuse = s.ambient = tint_by == 3 ? tint_plain : srgb_decoded(tint_colour(s));
    s.specular = vec3(0.0);
    // Heights of water are noise of radar, or steps.
    s.normal = normalize(mix(s.normal, s.up, tint_flat_share(water_of(s))));
}

void tint_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    factor *= tint_sun;
}

void tint_on_ambient(in Surface s, inout vec3 irradiance) {
    float grey = dot(irradiance, vec3(0.2126, 0.7152, 0.0722));  // luminance, Rec. 709
    irradiance = tint_sky * mix(vec3(grey), irradiance, tint_sky_colour);
}

void tint_on_display(in Surface s, inout vec4 overlay) {
    if (!tint_lit && tint_by != 3) overlay = vec4(tint_colour(s), 1.0);
}
