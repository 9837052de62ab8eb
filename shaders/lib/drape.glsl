//! provides  draped: the colours of a raster that lies on the ground by place
//! reads     gbuffer, drape pages: premultiplied sRGB, in the layers of the normal pages

//@ include lib/pages.glsl

uniform sampler2DArray drape_pages;

/// Colours at a post, as a level of the pyramid has them.
vec4 drape_at(in vec2 post, in int level) {
    PagePlace at = page_place(post, level);
    return textureLod(drape_pages, vec3((at.node + 1.5) / kNormalPage_px, float(at.layer)), 0.0);
}

/// Premultiplied sRGB at a post, over a pixel of so many posts.
vec4 draped(in vec2 post, in float posts_a_pixel) {
    float level = clamp(log2(posts_a_pixel), 0.0, frame.normal_levels - 1.0);
    return mix(drape_at(post, int(level)), drape_at(post, min(int(level) + 1, int(frame.normal_levels) - 1)),
               fract(level));
}
