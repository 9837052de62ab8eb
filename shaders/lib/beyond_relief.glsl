//! provides  beyond_relief_m: hills that are made up around a DEM, so that its mountains do not end at its rim;
//!           beyond_met_m: where a ray meets them; beyond_normal
//! reads     the DEM's own ground along its rim, generalised (render/height_means.h)
//! frame     heights are above the level ground of lib/beyond.glsl

//@ include lib/beyond.glsl
//@ include lib/ground.glsl
//@ include lib/height_means.glsl
//@ include lib/noise.glsl
//@ include lib/surround.glsl

/// Lengths along the ground are shares of the DEM's width, the root of its area.
const float beyond_rim_reach = 0.35;   // the ground of the rim goes on for so far, ever lower ...
const float beyond_hill_reach = 2.5;   // ... and hills for so far
const float beyond_hill = 0.13;        // length of the largest hills
const float beyond_hill_height = 0.27; // of them, as a share of their length, by the DEM's mean slope

float beyond_width_m() { return inversesqrt(frame.ground_extent.z * frame.ground_extent.w); }

/// Sharp ridges and wide valleys, about 0 in the mean. @param finest_m  what is shorter is left out
float beyond_hills(in vec2 ground_m, in float finest_m) {
    float length_m = beyond_hill * beyond_width_m(), sum = 0.0, part = 1.0;
    for (int i = 0; i < 6; ++i) {
        float shown = 1.0 - smoothstep(0.2, 0.5, finest_m / length_m);
        if (shown <= 0.0) break;
        sum += shown * part * (0.35 - abs(2.0 * noise_smooth(ground_m / length_m, uint(i)) - 1.0));
        part *= 0.52;
        length_m *= 0.47;
    }
    return sum;
}

/// Height, before exaggeration: on the rim that of the DEM, farther away of ever more of it, hills, and at last 0 [m].
/// @param ground_m  of Surface  @param finest_m  of the hills
float beyond_relief_m(in vec2 ground_m, in float finest_m) {
    vec2 post = surround_post(ground_m);
    float posts = length(surround_place(ground_m) - post), width_m = beyond_width_m();
    float away = posts / (frame.normal_texels_per_m * width_m);
    if (away > beyond_hill_reach) return 0.0;
    // No floor of a sea.
    float wide = frame.light_grid.z * max(posts, finest_m * frame.normal_texels_per_m);
    float rim_m = max(height_mean_linear(post, log2(max(wide, 1.0))), min(frame.beyond_m, 0.0)) - frame.beyond_m;
    float hilly = clamp(3.0 * abs(rim_m) * frame.height_range.y, 0.3, 1.3) * smoothstep(0.0, 0.05, away) *
                  (1.0 - smoothstep(1.0, beyond_hill_reach, away));
    float hill_m = beyond_hill_height * frame.light_map.y * beyond_hill * width_m;
    return (1.0 - surround_sea()) * (rim_m * (1.0 - smoothstep(0.0, beyond_rim_reach, away)) +
                                     hilly * hill_m * beyond_hills(ground_m, finest_m));
}

/// Distance to the ground in a direction [m]: from above all of it, each step goes on to the height that the last one
/// found. Behind a hill it may find the next one, which nobody sees in the haze.
/// @param level_m  to level ground; returned above the horizon
float beyond_met_m(in vec3 direction, in float level_m, in float finest_m) {
    const int steps = 7;
    float top_m = frame.height_range.x + 1.0 / frame.height_range.y - frame.beyond_m;
    float met_m = beyond_distance_above(direction, frame.height_range.z * top_m);
    if (met_m < 0.0) met_m = 0.7 * level_m;  // the eye is lower than the DEM's summits
    if (beyond_distance_m(direction) < 0.0) return level_m;
    for (int i = 0; i < steps; ++i) {
        float height_m = beyond_relief_m((met_m * direction + frame.eye_m.xyz).xy, finest_m);
        float next_m = beyond_distance_above(direction, frame.height_range.z * height_m);
        met_m = mix(met_m, next_m > 0.0 ? next_m : level_m, 0.6);  // else below the horizon of level ground
    }
    return met_m;
}

/// Normal of the drawn ground. @param relief_m  beyond_relief_m() there
vec3 beyond_normal(in vec2 ground_m, in vec3 up, in float finest_m, out float relief_m) {
    float step_m = max(finest_m, 1.0);
    vec3 heights_m;
    for (int i = 0; i < 3; ++i)  // one copy of what is long
        heights_m[i] = beyond_relief_m(ground_m + step_m * vec2(i == 1, i == 2), finest_m);
    relief_m = heights_m.x;
    vec2 slope = frame.height_range.z / step_m * (heights_m.yz - relief_m);
    vec3 east = east_at(up);
    return normalize(up - slope.x * east - slope.y * cross(up, east));
}
