//! provides  land_cover_at: what covers the ground by a map (--land-cover)
//! reads     water pages: the second half of their slices has the map

//@ include lib/water.glsl

/// What covers the ground of a pixel: shares of it, 0..1. The rest is bare.
struct LandCover {
    float trees, plants, ice;
    float known;  // how far the map tells anything, 0..1; 0 without a map
};

/// @param post         column and row of the DEM
/// @param pixel_posts  posts that a pixel is wide
LandCover land_cover_at(in vec2 post, in float pixel_posts) {
    if (frame.land_cover.x == 0.0) return LandCover(0.0, 0.0, 0.0, 0.0);
    int most = textureQueryLevels(page_table) - 1;
    PagePlace at = page_place(post, clamp(int(log2(max(pixel_posts, 1.0)) + 0.5), 0, most));
    if (at.layer == kNoPage) return LandCover(0.0, 0.0, 0.0, 0.0);
    float slice = float(at.layer) + float(textureSize(water_pages, 0).z / 2);
    vec4 read = textureLod(water_pages, vec3((at.node + 1.5) / kNormalPage_px, slice), 0.0);
    vec3 shares = read.rgb / max(read.a, 1.0 / 255.0);
    return LandCover(shares.r, shares.g, shares.b, read.a);
}
