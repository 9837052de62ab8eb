//! provides  overlay_colour: colours of the overlay raster at a post
//! reads     gbuffer, overlay_pages: premultiplied sRGB, in the slots of the normal pages

//@ include lib/pages.glsl

uniform sampler2DArray overlay_pages;

/// Colours of a level at a post.
vec4 overlay_at(in vec2 post, in int level) {
    PagePlace at = page_place(post, level);
    return textureLod(overlay_pages, vec3((at.node + 1.5) / kNormalPage_px, float(at.layer)), 0.0);
}

/// Premultiplied sRGB at a post. @param posts_a_pixel  side of the pixel in posts
vec4 overlay_colour(in vec2 post, in float posts_a_pixel) {
    float level = clamp(log2(posts_a_pixel), 0.0, frame.normal_levels - 1.0);
    return mix(overlay_at(post, int(level)), overlay_at(post, min(int(level) + 1, int(frame.normal_levels) - 1)),
               fract(level));
}
