//! provides  houses_at: what stands on the ground by the heights of a surface model (--surface); houses_over: their colours
//! reads     house pages, in the layers of the normal pages: session/land_cover.h

//@ include lib/pages.glsl

uniform sampler2DArray house_pages;  // rgb: shares of houses, streets and trees; a: of a house's random number

/// What stands on a pixel's ground: shares of it, 0..1. The rest is open.
struct Houses {
    float built, street, trees;
    float random;  // of the house, 0..1
};

/// @param post         column and row of the DEM
/// @param pixel_posts  posts that a pixel is wide
Houses houses_at(in vec2 post, in float pixel_posts) {
#ifdef BEYOND_PX
    return Houses(0.0, 0.0, 0.0, 0.0);  // heights are the DEM's
#else
    int most = textureQueryLevels(page_table) - 1;
    PagePlace at = page_place(post, clamp(int(log2(max(pixel_posts, 1.0)) + 0.5), 0, most));
    if (at.layer == kNoPage) return Houses(0.0, 0.0, 0.0, 0.0);
    vec4 read = textureLod(house_pages, vec3((at.node + 1.5) / kNormalPage_px, float(at.layer)), 0.0);
    return Houses(read.r, read.g, read.b, read.a / max(read.r, 1.0 / 255.0));
#endif
}

/// The ground with houses on it: walls are what is steep there. Some roofs are of tiles.
/// @param steep  tangent of the slope
vec3 houses_over(in vec3 ground, in Houses houses, in float steep, in vec3 roof, in vec3 wall) {
    float other = fract(houses.random * 7.0), is_wall = smoothstep(0.9, 1.5, steep);
    vec3 tiles = mix(vec3(0.75 + 0.5 * other), vec3(1.45, 1.0, 0.8), smoothstep(0.7, 0.75, houses.random));
    vec3 house = mix(roof * tiles, wall * (0.85 + 0.3 * other), is_wall);
    return mix(ground, house, smoothstep(mix(0.3, 0.04, is_wall), mix(0.7, 0.16, is_wall), houses.built));
}
