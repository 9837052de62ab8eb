//! provides  overlay_colour: the colours of a raster that lies on the ground by place
//! reads     gbuffer, overlay_pages: premultiplied sRGB, a virtual texture of its own (render/overlay_pages.h)

//@ include lib/pages.glsl

uniform sampler2DArray overlay_pages;
uniform usampler2D overlay_table;  // as page_table

/// Colours at a texel of the finest level, as a level has them.
vec4 overlay_at(in vec2 texel, in int level) {
    uvec2 page = texelFetch(overlay_table, ivec2(texel) >> (kNormalNodesLog2 + level), level).rg;
    if (page.r == kNoPage) return vec4(0.0);
    int shift = kNormalNodesLog2 + int(page.g);
    vec2 node = (texel - vec2((ivec2(texel) >> shift) << shift)) * exp2(-float(page.g));
    return textureLod(overlay_pages, vec3((node + 1.5) / kNormalPage_px, float(page.r)), 0.0);
}

/// Premultiplied sRGB at a post, over a pixel of so many posts; 0 beside the raster.
vec4 overlay_colour(in vec2 post, in float posts_a_pixel) {
    vec2 per_post = frame.overlay_texels.zw;
    vec2 texel = (post - frame.overlay_texels.xy) * per_post;
    if (any(lessThan(texel, vec2(-0.5))) || any(greaterThan(texel, frame.overlay_shape.xy + 0.5))) return vec4(0.0);
    texel = clamp(texel, vec2(0.0), frame.overlay_shape.xy * (1.0 - 1e-6));
    float last = frame.overlay_shape.z - 1.0;
    float level = clamp(log2(posts_a_pixel * sqrt(per_post.x * per_post.y)), 0.0, last);
    return mix(overlay_at(texel, int(level)), overlay_at(texel, int(min(floor(level) + 1.0, last))), fract(level));
}
