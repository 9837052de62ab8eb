//! provides  raster_texels, raster_colour, raster_value: a raster that lies on the ground by place
//! reads     pages of a virtual texture of its own (render/overlay_pages.h)

//@ include lib/pages.glsl
//@ include lib/srgb.glsl

/// What a level has at a texel of the finest one.
/// @param table  as page_table
vec4 raster_texel(in sampler2DArray pages, in usampler2D table, in vec2 texel, in int level) {
    uvec2 page = texelFetch(table, ivec2(texel) >> (kNormalNodesLog2 + level), level).rg;
    if (page.r == kNoPage) return vec4(0.0);
    int shift = kNormalNodesLog2 + int(page.g);
    vec2 node = (texel - vec2((ivec2(texel) >> shift) << shift)) * exp2(-float(page.g));
    return textureLod(pages, vec3((node + 1.5) / kNormalPage_px, float(page.r)), 0.0);
}

/// The raster's texels at a post, over a pixel of so many posts; 0 beside the raster.
/// @param place  post of texel (0, 0), and texels per post
/// @param shape  last column and row of the texels, and number of levels; all 0: no raster
vec4 raster_texels(in sampler2DArray pages, in usampler2D table, in vec4 place, in vec4 shape, in vec2 post,
                   in float posts_a_pixel) {
    vec2 texel = (post - place.xy) * place.zw;
    if (shape.z < 1.0 || any(lessThan(texel, vec2(-0.5))) || any(greaterThan(texel, shape.xy + 0.5))) return vec4(0.0);
    texel = clamp(texel, vec2(0.0), shape.xy * (1.0 - 1e-6));
    float last = shape.z - 1.0;
    float level = clamp(log2(posts_a_pixel * sqrt(place.z * place.w)), 0.0, last);
    return mix(raster_texel(pages, table, texel, int(level)),
               raster_texel(pages, table, texel, int(min(floor(level) + 1.0, last))), fract(level));
}

/// Linear red, green and blue and alpha, from premultiplied sRGB.
vec4 raster_colour(in vec4 texels) {
    return vec4(srgb_decoded(texels.rgb / max(texels.a, 1.0 / 255.0)), texels.a);
}

/// A value, and the part of the pixel that has one, from their product and that part.
vec2 raster_value(in vec4 texels) {
    return vec2(texels.r / max(texels.g, 1e-6), texels.g);
}
