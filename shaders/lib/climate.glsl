//! provides  climate_ground, climate_snow: what the climate makes of ground at a place, a height and the
//!           frame's date
//! reads     climate_table: render/climate_volume.h makes it, where a program reads it
//! source    core/climate/cover.h: what each number means

uniform sampler3D climate_table;  // below: dryness, growth, green, temperature; above: ice, snow

/// Natural ground but for snow.
struct ClimateGround {
    float dryness;      // rain over what the warmth takes: below 0.5 desert, below 1 steppe, from 1.75 forest
    float growth;       // warmth for plants: from 1 trees grow, below 0 no closed cover of plants
    float green;        // how green what grows is on the date, 0..1
    float temperature;  // mean of the year [degC]
};

/// Longitude off the DEM's centre and latitude. @param up  the ellipsoid's normal there
vec2 climate_angles(in vec3 up) {
    vec3 axis = frame.polar_axis.xyz;
    // Off the axis: towards the DEM's centre, and east of it.
    vec2 off = vec2(axis.y * up.z - axis.z * up.y, up.x);
    return vec2(atan(off.y, off.x), atan(dot(axis, up), length(off)));
}

/// Where a place is in the table, for the functions below. @param up  the ellipsoid's normal there
vec2 climate_place(in vec3 up) {
    return climate_angles(up) * frame.climate_place.xz + frame.climate_place.yw;
}

float climate_level(in float height_m) {
    return clamp(height_m * frame.climate_height.x + frame.climate_height.y, frame.climate_height.z,
                 frame.climate_height.w);
}

/// @param place  climate_place()
ClimateGround climate_ground(in vec2 place, in float height_m) {
    vec4 read = textureLod(climate_table, vec3(place, climate_level(height_m)), 0.0);
    return ClimateGround(read.r, read.g, read.b, read.a);
}

/// Balance of ice [m of water a year; above 0 it lies there for good], and the share of level open
/// ground that has snow, 0..1.
vec2 climate_snow(in vec2 place, in float height_m) {
    return textureLod(climate_table, vec3(place, climate_level(height_m) + 0.5), 0.0).rg;
}
