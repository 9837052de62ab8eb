//! provides  land_cover_at: what covers the ground by a map (--land-cover); land_classes_at: by the shares that come
//!           with the program
//! reads     water pages: the second half of their slices has the map; land_classes and land_around, of
//!           render/natural_ground.h

//@ include lib/climate.glsl
//@ include lib/water.glsl

uniform sampler2D land_classes;       // of the DEM: shares of trees, fields, bare ground and towns
uniform sampler2DArray land_around;   // of the DEM and the country around it, below: the same; above: tint and shrubs

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

/// What covers land, shared out by climate/land_classes.h: shares of the ground. The rest is grass and shrubs.
struct LandClasses {
    float trees, fields, bare, towns;
    float shrubs;  // of what is left, 0..1
    vec3 tint;     // logarithm to base 2 of how the ground's colour differs from what these usually have
    float known;   // 1, or 0 where nothing is known
};

/// @param post, pixel_posts  as land_cover_at
/// @param up                 the ellipsoid's normal there
LandClasses land_classes_at(in vec2 post, in float pixel_posts, in vec3 up) {
    vec2 place = climate_angles(up) * frame.land_place.xz + frame.land_place.yw;
#ifdef BEYOND_PX
    // Beyond what is known of the country it is as in the mean.
    vec2 off = abs(place - 0.5);
    float level = 8.0 * smoothstep(0.4, 0.56, max(off.x, off.y));
    vec4 shares = textureLod(land_around, vec3(place, 0.0), level);
#else
    vec2 texels = vec2(textureSize(land_classes, 0));
    float wide = floor(log2(max(pixel_posts * frame.land_cover.z, 1.0)) + 0.5), level = 0.0;
    vec4 shares = textureLod(land_classes, (post * frame.land_cover.zw + 0.5) / texels, wide);
#endif
    vec4 around = textureLod(land_around, vec3(place, 1.0), level);
    return LandClasses(shares.r, shares.g, shares.b, shares.a, around.a, 4.0 * around.rgb - 2.0, frame.land_cover.y);
}
