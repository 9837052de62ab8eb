//! provides  texture shading: ridges lighter and hollows darker, whatever the light
//! hook      material, display
//! reads     generalised heights of the DEM (core/render/height_means.h)
//! writes    diffuse, ambient, and colours of maps
//! source    L. Brown, Texture shading: a new technique for depicting terrain relief, ICA Mountain Cartography Workshop
//!           (2010): the fractional Laplacian of the heights, here a sum over octaves of them

//@ include lib/height_means.glsl

uniform float ridges_amount = 0.25; //@ range(0, 1) label("Amount") description("How much lighter the sharpest ridges are")
uniform float ridges_detail = 0.8; //@ range(0, 2) label("Detail") description("Exponent of the Laplacian, times 2: 0 shows the broadest forms, 2 the finest")
uniform float ridges_contrast = 1.5; //@ range(0, 10) label("Contrast") description("How soon forms are as light or as dark as they get")

const int ridges_octaves = 6;

/// How far a point is a ridge (1) or a hollow (-1). @param level  height_mean_level() of the finest forms
float ridges_at(in vec2 post, in float level) {
    float finest = max(level, 0.0), sum = 0.0;
    float before = height_mean(post, int(finest)).x, here = 0.0;
    for (int i = 0; i <= ridges_octaves; ++i) {
        float after = height_mean(post, int(finest) + 1 + i).x;
        float smoother = mix(before, after, fract(finest));
        float known = smoothstep(-2.0, 1.0, level + float(i - 1));  // the finest forms of a DEM are noise
        if (i > 0) sum += known * (here - smoother) * exp2(-ridges_detail * float(i - 1));
        here = smoother;
        before = after;
    }
    return tanh(ridges_contrast * height_mean_exaggeration() * sum / (height_mean_texel_m() * exp2(finest)));
}

float ridges_factor(in Surface s) {
    return 1.0 + ridges_amount * ridges_at(s.post, height_mean_level(s));
}

void ridges_on_material(inout Surface s) {
    float factor = ridges_factor(s);
    s.diffuse = min(s.diffuse * factor, vec3(1.0));
    s.ambient = min(s.ambient * factor, vec3(1.0));
}

void ridges_on_display(in Surface s, inout vec4 overlay) {
    overlay.rgb = min(overlay.rgb * ridges_factor(s), vec3(overlay.a));
}
