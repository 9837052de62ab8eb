//! provides  river_at: rivers where water runs by the heights of the DEM
//! reads     land_classes, whose second layer has the nearest river of each site, climate/rivers.h
//!           r: direction of its normal, g: way to it, b: width, a: share of the texel

//@ include lib/land.glsl

const float river_reach = 2.5;    // climate/rivers.h: kRiverReach
const float river_line_px = 1.7;  // width of rivers that are narrower

/// Metres between columns and rows of the sites.
vec2 river_sites_m() {
    return 1.0 / (frame.ground_extent.zw * (frame.posts.xy - 1.0) * frame.land_cover.zw);
}

/// Share of a pixel that a river covers.
/// @param away_m  from the middle of the pixel to the middle of the river  @param wide_m  width of the river
float river_covered(in float away_m, in float wide_m, in float pixel_m) {
    float half_m = 0.5 * wide_m, reach_m = 0.5 * pixel_m;
    return max(min(half_m, away_m + reach_m) - max(-half_m, away_m - reach_m), 0.0) / pixel_m;
}

/// Shares of a pixel, 0..1. @param post  of Surface  @param pixel_m  width of a pixel on the ground
/// @param wander  moves them, in sites: between sites far apart their bends are not known
/// @param wider  rivers narrower than a pixel are drawn so much wider at most, so that they are seen; 0: no rivers
/// @returns x: of rivers, y: of rivers and their banks
vec2 river_at(in vec2 post, in float pixel_m, in vec2 wander, in float wider) {
#ifdef BEYOND_PX
    return vec2(0.0);  // heights are the DEM's
#else
    vec2 at = post * frame.land_cover.zw + wander, corner = floor(at), t = at - corner, apart_m = river_sites_m();
    float site_m = sqrt(apart_m.x * apart_m.y);
    ivec2 last = textureSize(land_classes, 0).xy - 1;
    vec2 shares[4];
    for (int i = 0; i < 4; ++i) {
        vec2 site = corner + vec2(i & 1, i >> 1);
        vec4 river = texelFetch(land_classes, ivec3(clamp(ivec2(site), ivec2(0), last), 1), 0);
        shares[i] = vec2(0.0);
        if (river.b > 0.0) {
            float angle = radians(180.0) * river.r, width_m = 4.0 * site_m * river.b * river.b;
            float off_m = dot((at - site) * apart_m, vec2(cos(angle), sin(angle)));
            float away_m = abs(off_m - (2.0 * river.g - 1.0) * river_reach * site_m);
            float drawn_m = min(max(width_m, river_line_px * pixel_m), wider * width_m);
            shares[i] = vec2(river_covered(away_m, drawn_m, pixel_m),
                             river_covered(away_m, min(4.0 * drawn_m, 2.0 * site_m), pixel_m));
        }
    }
    vec2 near = mix(mix(shares[0], shares[1], t.x), mix(shares[2], shares[3], t.x), t.y);
    float wide = pixel_m / site_m;
    float far = textureLod(land_classes, vec3((at + 0.5) / vec2(last + 1), 1.0), log2(max(wide, 1.0))).a;
    far = min(0.5 * wider * far, 1.0);
    return mix(near, vec2(far, min(4.0 * far, 1.0)), smoothstep(0.5, 1.5, wide));
#endif
}
