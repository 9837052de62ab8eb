//! provides  shadow: how much of the sun a point of the ground sees past the ground sunward of it
//! hook      visibility
//! reads     vsm.moments (vsm.cpp draws it): mean [m] and mean square [m^2] of the height, above
//!           vsm_rise's zero, of the ground that the sun's rays meet first
//! writes    factor
//! source    W. Donnelly, A. Lauritzen, Variance Shadow Maps, I3D 2006

//@ include lib/surface.glsl

uniform float vsm_bleed = 0.2;    //@ range(0, 0.9) label("Light bleed cut") description("What Chebyshev's bound lets through where shadows overlap, and is taken as none.")
uniform float vsm_deviation_m = 0.3;  //@ range(0, 100) unit(m) label("Least deviation") description("Of the heights in the map, so that rounding casts no shadow.")

uniform float vsm_crease = 0.5;  //@ range(0, 3) label("Crease") description("Deviations.")
uniform float vsm_blur = 0.5;  //@ range(0, 1) label("Blur")

uniform vec4 vsm_across = vec4(0.0);  //@ host
uniform vec4 vsm_along = vec4(0.0);  //@ host
uniform vec4 vsm_rise = vec4(0.0);  //@ host

uniform vec4 vsm_texel_m = vec4(0.0);  //@ host description("Across and up, of the finest map.")

uniform sampler2DArray vsm_moments;

/// Upper bound on the share of what is in a texel that does not lie above a height.
/// @param moments  mean and mean square of the heights
/// source: Chebyshev's one-sided inequality, Donnelly and Lauritzen, equation 5
float vsm_chebyshev(in vec2 moments, in float height, in float least_variance) {
    float variance = max(moments.y, least_variance);
    float above = max(moments.x - height - vsm_crease * sqrt(variance), 0.0);
    return variance / (variance + above * above);
}

/// Cuts off the lower end of the bound, where light bleeds through, and stretches the rest.
/// source: A. Lauritzen, Summed-Area Variance Shadow Maps, GPU Gems 3, 2007, section 8.4.3
float vsm_cut(in float bound, in float bleed) {
    return clamp((bound - bleed) / (1.0 - bleed), 0.0, 1.0);
}

void vsm_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    vec4 point = vec4(surface_point(s), 1.0);
    vec2 at = vec2(dot(vsm_across, point), dot(vsm_along, point));
    vec2 moments = textureLod(vsm_moments, vec3(at, 0.0), 0.0).rg;
    float bound = vsm_chebyshev(moments, dot(vsm_rise, point), vsm_deviation_m * vsm_deviation_m + 0.0 * vsm_blur);
    factor *= vsm_cut(bound, vsm_bleed);
}
