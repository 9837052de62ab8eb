//! provides  shadow: soft ones for maps, and light on generalised ground
//! hook      normal, visibility
//! reads     generalised heights of the DEM (core/render/height_means.h), shadow clearances of all posts
//! writes    normal, factor

//@ include lib/ground.glsl
//@ include lib/height_means.glsl
//@ include lib/sun_share.glsl

uniform float softlight_width_px = 1.5; //@ range(0.5, 50) unit(px) label("Width") description("Standard deviation of what smooths the ground for its light, at least 1.5 posts")
uniform float softlight_shadows = 0.6; //@ range(0, 1) label("Shadows") description("Share of the sun that cast shadows keep off")
uniform float softlight_blur_px = 4.0; //@ range(1, 50) unit(px) label("Blur") description("Width over which edges of cast shadows fade")

const float softlight_least_posts = 1.5;  // single posts are noise, and dots where slopes turn away from the sun
const float softlight_texels = 0.65;      // standard deviation of height_mean() [texels]

void softlight_on_normal(inout Surface s) {
    float level = max(height_mean_level(s) + log2(softlight_width_px / softlight_texels),
                      log2(softlight_least_posts * frame.light_grid.z / softlight_texels));
    level = max(level, 0.0);
    vec2 change = mix(height_mean(s.post, int(level)).yz, height_mean(s.post, int(level) + 1).yz, fract(level));
    vec2 slope = frame.height_range.z * height_mean_slope(change);
    vec3 east = east_at(s.up);
    s.normal = normalize(s.up - slope.x * east - slope.y * cross(s.up, east));
}

void softlight_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    Surface wide = s;
    wide.pixel_posts *= softlight_blur_px;
    factor *= mix(1.0, sun_share(wide, to_sun), softlight_shadows);
}
