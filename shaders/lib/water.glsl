//! provides  water_at: where water stands on the ground, and which ground was a hole
//! reads     water pages, in the layers of the normal pages: render/water_field.h

//@ include lib/pages.glsl

uniform sampler2DArray water_pages;  // r: side of the shore, one half on it; gb: sea, floor known; a: filled 0.5, covered 1

/// Water at a place of the DEM.
/// @param post         column and row
/// @param pixel_posts  posts that a pixel is wide: shores are smooth over that
/// @returns x: share of water, 0 to 1; y: of it, the share that is sea, z: and whose floor the DEM has; w: of holes,
///          0.5 where they are filled and 1 where they are covered
vec4 water_at(in vec2 post, in float pixel_posts) {
    int most = textureQueryLevels(page_table) - 1;
    int level = clamp(int(log2(max(pixel_posts, 1.0)) + 0.5), 0, most);
    PagePlace at = page_place(post, level);
    if (at.layer == kNoPage) return vec4(0.0);
    vec2 node = at.node + 1.0;
    vec2 quad = floor(node);
    vec2 t = node - quad;
    vec4 side = textureGather(water_pages, vec3((quad + 1.0) / kNormalPage_px, float(at.layer)), 0);
    vec2 along = mix(side.wx, side.zy, t.x);  // the row above and the one below
    vec2 slope = vec2(mix(side.z - side.w, side.y - side.x, t.y), along.y - along.x);
    float wide = length(slope) * pixel_posts * at.nodes_per_post;
    float share = (mix(along.x, along.y, t.y) - 0.5) / max(wide, 1e-4) + 0.5;
    vec3 kind = textureLod(water_pages, vec3((node + 0.5) / kNormalPage_px, float(at.layer)), 0.0).gba;
    return vec4(clamp(share, 0.0, 1.0), kind);
}

/// At a visible point.
vec4 water_of(in Surface s) {
    float pixel_m = 0.5 * (length(s.ground_dx_m) + length(s.ground_dy_m));
    return water_at(s.post, pixel_m * frame.normal_texels_per_m);
}
