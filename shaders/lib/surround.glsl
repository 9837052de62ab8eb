//! provides  surround_sea, surround_sea_albedo: the sea around a DEM that is mostly sea; surround_sea_here: where the
//!           DEM ends in one; surround_post: the nearest post of the DEM
//! reads     share of the DEM's posts that are floor of a sea, and of those along its edge that are sea; water pages;
//!           land_around

//@ include lib/land.glsl
//@ include lib/water.glsl

/// Albedo of a deep sea as overviews show it, chosen by eye.
const vec3 surround_sea_albedo = vec3(0.006, 0.037, 0.108);

/// How far what lies beyond the DEM is sea, 0 to 1: nobody knows it, but around a DEM that is mostly sea it is likely.
float surround_sea() {
    return smoothstep(0.5, 0.7, frame.sea_floor_share);
}

/// Column and row of a place, also beyond the DEM. @param ground_m  of Surface
vec2 surround_place(in vec2 ground_m) {
    return 0.5 * (frame.posts.xy - 1.0) + frame.light_axes.xy * ground_m.x + frame.light_axes.zw * ground_m.y;
}

vec2 surround_post(in vec2 ground_m) {
    return clamp(surround_place(ground_m), vec2(0.0), frame.posts.xy - 1.0);
}

/// How far a place beyond the DEM is water, 0 to 1: near the DEM as its edge is, over a width that grows with the distance
/// from it, and farther away as a map of coarse cells has it.
/// @param up  the ellipsoid's normal there
float surround_sea_here(in vec2 ground_m, in vec3 up) {
    vec2 post = surround_post(ground_m), outwards = surround_place(ground_m) - post;
    vec2 aside = vec2(-outwards.y, outwards.x);
    float some = 0.0;
    for (int i = -3; i <= 3; ++i) {
        vec4 water = water_at(clamp(post + 0.25 * float(i) * aside, vec2(0.0), frame.posts.xy - 1.0),
                              8.0 + 0.5 * length(outwards));
        some += water.x * mix(water.y, 1.0, frame.land_cover.y) / 7.0;
    }
    some *= max(smoothstep(0.05, 0.15, frame.sea_rim_share), frame.land_cover.y);
    some = max(mix(some, 1.0, smoothstep(0.7, 0.85, frame.sea_rim_share)), surround_sea());
    float mapped = smoothstep(0.35, 0.65, land_water_at(up)), away_m = length(outwards) / frame.normal_texels_per_m;
    return mix(some, mapped, frame.land_cover.y * smoothstep(1000.0, 12000.0, away_m));
}

/// Albedo of a deep sea that is seen from low enough to mirror the sky, as that of `sea`.
const vec3 surround_deep_albedo = vec3(0.004, 0.026, 0.036);

/// Share of the light that such a sea mirrors, at a wind of 5 m/s.
/// source: E. Bruneton et al., Real-time realistic ocean lighting, Computer Graphics Forum 29 (2010), 487, section 4.3
/// @param cosine  between the view and the vertical
float surround_mirrored(in float cosine) {
    return 0.02 + 0.98 * pow(1.0 - clamp(cosine, 0.0, 1.0), 3.62) / 1.94;
}
