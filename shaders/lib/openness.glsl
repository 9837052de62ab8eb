//! provides  surface_open_sky: how much of the sky a point of the ground sees, of what it would see on an endless slope
//! reads     light_sky (core/render/ground_light.h)
//! source    core/light/horizons.h: sky_view()

uniform sampler2D light_sky;  // r: that share, times coverage; g: coverage

float surface_open_sky(in Surface s) {
    vec2 at = (s.post + 0.5) * frame.light_grid.y / vec2(textureSize(light_sky, 0));
    float level = log2(max(s.pixel_posts * frame.light_grid.y, 1.0));
    vec2 share = textureLod(light_sky, at, level).rg;
    return share.g > 0.0 ? share.r / share.g : 1.0;
}
