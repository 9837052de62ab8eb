//! provides  the local vertical and compass directions, and the light of the sun, at a point
//! reads     light_by_height, which render/light_by_height.h makes
//! source    render/frame_block.h: the tables; tests/render/test_frame_block.cpp bounds their errors

//@ include lib/filtered.glsl

uniform sampler2DArray light_by_height;  // by sine of the light's elevation and height; layers: direct light and sky of
                                         // the DEM's heights, direct light of heights up to 16 km

const vec2 light_by_height_size = vec2(64.0, 16.0);  // LightByHeight: columns, rows

/// Normal of the ellipsoid at a point given relative to the eye [m].
vec3 up_at(in vec3 position_m) {
    return normalize(frame.up_at_eye.xyz + mat3(frame.up_matrix) * position_m);
}

vec3 east_at(in vec3 up) {
    return normalize(cross(frame.polar_axis.xyz, up));
}

/// Coordinates of the DEM's own ground, whatever the exaggeration that it is drawn with: east and
/// north from the DEM's centre, and the height [m].
/// @param position_m  as drawn, relative to the eye
vec3 ground_at(in vec3 position_m, in vec3 up, in float height_m) {
    vec2 drawn_m = position_m.xy + frame.eye_m.xy;
    return vec3(drawn_m - (frame.height_range.z - 1.0) * height_m * up.xy, height_m);
}

/// The same from the point of frame.eye_anchor, east and north: to 0.1 mm near the eye, wherever on the Earth [m].
vec2 ground_anchored_at(in vec3 position_m, in vec3 up, in float height_m) {
    vec2 drawn_m = position_m.xy + frame.eye_anchor.zw;
    return drawn_m - (frame.height_range.z - 1.0) * height_m * up.xy;
}

float height_unit_of(in float height_m) {
    return clamp((height_m - frame.height_range.x) * frame.height_range.y, 0.0, 1.0);
}

/// Where a sine of the sun's elevation is on the scale of frame.sun_light_table, which is finest near the
/// horizon, where a degree changes the light most.
float sun_light_scale(in float sine) {
    return sine / (abs(sine) + 0.1);
}

/// The sun as seen from a point with the given local vertical, at the middle of the DEM's heights.
/// @param to_sun  its apparent direction: refraction lifts it towards the vertical
/// @returns irradiance on a surface that faces it, rgb
vec3 sun_light(in vec3 up, out vec3 to_sun) {
    float scaled = sun_light_scale(dot(frame.sun_direction.xyz, up));
    float at = clamp((scaled - frame.sun_light_domain.x) * frame.sun_light_domain.y, 0.0, 127.0);
    int entry = min(int(at), 126);
    vec4 light = mix(frame.sun_light_table[entry], frame.sun_light_table[entry + 1], at - float(entry));
    to_sun = normalize(frame.sun_direction.xyz + light.a * up);
    return light.rgb;
}

/// A layer of light_by_height. @param row  of the height, 0 to 1
vec3 light_in_layer(in float layer, in float row, in vec3 up) {
    float scaled = sun_light_scale(dot(frame.sun_direction.xyz, up));
    vec2 at = vec2((scaled - frame.sun_light_domain.x) * frame.sun_light_domain.y / 127.0, row);
    at = (clamp(at, 0.0, 1.0) * (light_by_height_size - 1.0) + 0.5) / light_by_height_size;
    return filtered(light_by_height, vec3(at, layer)).rgb;
}

float light_row(in float height_m) { return (height_m - frame.light_heights.x) * frame.light_heights.y; }

/// The sun, or the moon that lights a night, as seen from a point of the ground.
/// @param height_m  of the point above sea level, not exaggerated  @param to_sun  as sun_light()
/// @returns irradiance on a surface that faces it, rgb
vec3 sun_light_at(in float height_m, in vec3 up, out vec3 to_sun) {
    sun_light(up, to_sun);
    return light_in_layer(0.0, light_row(height_m), up);
}

/// Irradiance of level ground by the whole sky at a point of the ground, rgb.
vec3 light_of_sky_at(in float height_m, in vec3 up) { return light_in_layer(1.0, light_row(height_m), up); }

const float light_aloft_m = 16000.0;  // LightByHeight::kAloft_m

/// Irradiance on a surface that faces the sun, or the moon that lights a night, at a height from 0 to 16 km.
vec3 sun_light_aloft(in float height_m, in vec3 up) { return light_in_layer(2.0, height_m / light_aloft_m, up); }
