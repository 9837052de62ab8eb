//! provides  overlay_colour: the colours of the scene's overlay
//! reads     gbuffer, overlay_pages: premultiplied sRGB

//@ include lib/raster.glsl

uniform sampler2DArray overlay_pages;
uniform usampler2D overlay_table;

/// Premultiplied sRGB at a post, over a pixel of so many posts; 0 beside the raster.
vec4 overlay_colour(in vec2 post, in float posts_a_pixel) {
    return raster_texels(overlay_pages, overlay_table, frame.overlay_texels, frame.overlay_shape, post, posts_a_pixel);
}
