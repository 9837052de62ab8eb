//! provides  beyond_seen: the level ground that is made up around a DEM seen from the air; beyond_distance_m,
//!           beyond_distance_above, beyond_horizon_m: where it is, and levels above it
//! reads     with BEYOND, in programs of the sky, beyond_ground of beyond.frag.glsl
//! frame     a sphere at the height frame.beyond_m, around the Earth's centre below the eye

//@ include lib/air.glsl

uniform sampler2D beyond_ground;  // beyond.frag.glsl

const float beyond_radius_m = 6371000.0;

/// To its horizon [m].
float beyond_horizon_m() {
    float above_m = max(frame.eye_m.w - frame.beyond_m * frame.height_range.z, 1.0);
    return sqrt(above_m * (2.0 * beyond_radius_m + above_m));
}

/// To a level above that ground [m]; below 0 where a ray passes over it, or where nothing is made up.
float beyond_distance_above(in vec3 direction, in float level_m) {
    float above_m = frame.eye_m.w - frame.beyond_m * frame.height_range.z - level_m;
    float down = (beyond_radius_m + above_m) * dot(direction, frame.eye_up.xyz);
    float over = above_m * (2.0 * beyond_radius_m + above_m), inside = down * down - over;
    bool meets = frame.beyond > 0.0 && above_m > 0.0 && down < 0.0 && inside > 0.0;
    return meets ? over / (sqrt(max(inside, 0.0)) - down) : -1.0;
}

/// To that ground [m].
float beyond_distance_m(in vec3 direction) {
    return beyond_distance_above(direction, 0.0);
}

#ifdef BEYOND

/// Radiance of that ground through its air in a direction of this pixel, and 1; all 0 where the pixel shows none.
vec4 beyond_seen(in vec3 direction) {
    vec2 at = gl_FragCoord.xy / (BEYOND_PX * vec2(textureSize(beyond_ground, 0)));
    vec4 read = textureLod(beyond_ground, at, 0.0);
    return beyond_distance_m(direction) >= 0.0 && read.a > 0.0 ? vec4(read.rgb / (read.a * frame.exposure), 1.0) : vec4(0.0);
}

#else

vec4 beyond_seen(in vec3 direction) { return vec4(0.0); }

#endif
