//! provides  the scene's overlay, which lies among what effects draw in the hooks material and display
//! reads     gbuffer, overlay_pages: premultiplied sRGB

//@ include lib/raster.glsl
//@ include lib/srgb.glsl

uniform sampler2DArray overlay_pages;
uniform usampler2D overlay_table;

/// Premultiplied sRGB at a post, over a pixel of so many posts; 0 beside the raster.
vec4 overlay_colour(in vec2 post, in float posts_a_pixel) {
    return raster_texels(overlay_pages, overlay_table, frame.overlay_texels, frame.overlay_shape, post, posts_a_pixel);
}

#ifdef OVERLAY_RASTER
vec4 overlay_here;     // its colour at this pixel
vec4 overlay_beneath;  // what effects above a flat overlay draw over: it, and the effects below it

/// Lit: its colours take the place of the ground's reflectance.
void core_on_material(inout Surface s) {
    if (frame.overlay_shape.w == 0.0) return;
    vec4 laid = overlay_here;
    vec3 reflectance = srgb_decoded(min(laid.rgb / max(laid.a, 1e-3), 1.0));
    s.diffuse = mix(s.diffuse, reflectance, laid.a);
    s.ambient = mix(s.ambient, reflectance, laid.a);
    s.specular *= 1.0 - laid.a;
    s.emissive *= 1.0 - laid.a;
    // The image has its own texture: bumps of materials would be drawn over it.
    s.normal = normalize(mix(s.normal, s.geometric_normal, laid.a));
}

/// Flat: in its own colours. Effects above it begin with nothing, so that one that changes what others drew, as a
/// cover of voids does, leaves the overlay as it is.
void core_on_display(in Surface s, inout vec4 overlay) {
    if (frame.overlay_shape.w > 0.0) return;
    overlay_beneath = overlay_here + overlay * (1.0 - overlay_here.a);
    overlay = vec4(0.0);
}
#endif
