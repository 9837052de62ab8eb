//! provides  land_cover_at: what covers the ground by a map (--land-cover); land_classes_at: by the shares that come
//!           with the program; land_water_at: water beyond the DEM
//! reads     water pages: the second half of their slices has the map; land_classes and land_around, of
//!           render/natural_ground.h

//@ include lib/climate.glsl
//@ include lib/water.glsl

uniform sampler2DArray land_classes;  // of the DEM: shares of trees, fields, bare ground and towns, then its rivers
uniform sampler2DArray land_around;   // of the DEM and the country around it: the same, then tint and shrubs, then water

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
    float settled; // fields and towns in the country around, kilometres wide
    float known;   // 1, or 0 where nothing is known
};

/// Where a place is in land_around, and the level to read: beyond what is known it is as in the mean.
vec3 land_place(in vec3 up) {
    vec2 place = climate_angles(up) * frame.land_place.xz + frame.land_place.yw, off = abs(place - 0.5);
    return vec3(place, 8.0 * smoothstep(0.4, 0.56, max(off.x, off.y)));
}

/// Share of water in the country around, 0..1. @param up  the ellipsoid's normal there
float land_water_at(in vec3 up) {
    vec3 place = land_place(up);
    return textureLod(land_around, vec3(place.xy, 2.0), place.z).r;
}

/// @param post, pixel_posts  as land_cover_at
/// @param up                 the ellipsoid's normal there
LandClasses land_classes_at(in vec2 post, in float pixel_posts, in vec3 up) {
    vec3 place = land_place(up);
#ifdef BEYOND_PX
    vec4 shares = textureLod(land_around, vec3(place.xy, 0.0), place.z);
#else
    vec2 texels = vec2(textureSize(land_classes, 0).xy);
    float level = floor(log2(max(pixel_posts * frame.land_cover.z, 1.0)) + 0.5);
    vec4 shares = textureLod(land_classes, vec3((post * frame.land_cover.zw + 0.5) / texels, 0.0), level);
    place.z = 0.0;  // the DEM is in the middle
#endif
    vec4 looks = textureLod(land_around, vec3(place.xy, 1.0), place.z);
    vec4 around = textureLod(land_around, vec3(place.xy, 0.0), max(place.z, 1.0));
    return LandClasses(shares.r, shares.g, shares.b, shares.a, looks.a, 4.0 * looks.rgb - 2.0, around.g + around.a,
                       frame.land_cover.y);
}
