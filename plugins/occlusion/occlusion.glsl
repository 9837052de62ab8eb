//! provides  ambient occlusion in the picture: less light of the sky in hollows
//! hook      ambient
//! reads     depth of the ground
//! writes    irradiance
//! source    M. McGuire et al., The Alchemy screen-space ambient obscurance algorithm, HPG 2011, eq. 10, with a
//!           falloff that ends at the radius

//@ include lib/screen.glsl

uniform float occlusion_radius_m = 60.0; //@ range(0.1, 10000) unit(m) label("Radius") description("How far away ground hides the sky; far from the camera at least as far as 16 pixels")
uniform float occlusion_amount = 1.5; //@ range(0, 4) label("Amount")

uniform sampler2D occlusion_depth; //@ from(core.ground_depth)
uniform sampler2D occlusion_raw;
uniform sampler2D occlusion_smooth;

const int occlusion_samples = 12;
const float occlusion_bias = 0.02;     // sine: what is less steep hides nothing
const float occlusion_narrowest_px = 16.0;  // of the radius in the picture
const float occlusion_widest_px = 96.0;

/// How much a point hides of the sky of another one. @param towards  from that one [m]
float occlusion_by(in vec3 towards, in vec3 normal, in float radius_m) {
    float distance_m = length(towards);
    float share = distance_m / radius_m;
    float near = max(1.0 - share * share, 0.0);
    return near * max(dot(towards, normal) / max(distance_m, 1e-3) - occlusion_bias, 0.0);
}

/// Visible share of the sky (r) and depth (g) of every second pixel.
vec4 occlusion_pass_raw(in Texel t) {
    ivec2 last = textureSize(occlusion_depth, 0) - 1;
    ivec2 pixel = min(2 * ivec2(t.at_px), last);
    float depth_m = screen_depth(occlusion_depth, pixel);
    if (depth_m == kSky_m) return vec4(1.0, depth_m, 0.0, 0.0);
    vec3 here = screen_position(occlusion_depth, pixel);
    vec3 normal = screen_normal(occlusion_depth, pixel);
    float pixel_m = depth_m * length(frame.pixel_ray_dx.xyz);
    float radius_m = max(occlusion_radius_m, occlusion_narrowest_px * pixel_m);
    float radius_px = min(radius_m / pixel_m, occlusion_widest_px);
    // A spiral, turned from texel to texel of a square of 4 x 4, which the next pass averages.
    ivec2 cell = ivec2(t.at_px) & 3;
    float turned = 0.3926991 * float(cell.x + 4 * cell.y);
    float hidden = 0.0;
    for (int i = 0; i < occlusion_samples; ++i) {
        float share = (float(i) + 0.5) / float(occlusion_samples);
        float angle = turned + 2.3999632 * float(i);
        ivec2 other = pixel + ivec2(radius_px * share * vec2(cos(angle), sin(angle)));
        if (any(lessThan(other, ivec2(0))) || any(greaterThan(other, last))) continue;
        if (screen_depth(occlusion_depth, other) == kSky_m) continue;
        hidden += occlusion_by(screen_position(occlusion_depth, other) - here, normal, radius_m);
    }
    float seen = 1.0 - 2.0 * hidden / float(occlusion_samples);
    return vec4(clamp(seen, 0.0, 1.0), depth_m, 0.0, 0.0);
}

/// The mean of 4 x 4 texels, of those at about the same depth.
vec4 occlusion_pass_smooth(in Texel t) {
    ivec2 here = ivec2(t.at_px), last = ivec2(t.size_px) - 1;
    float depth_m = texelFetch(occlusion_raw, here, 0).g;
    float sum = 0.0, weight = 0.0;
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            vec2 other = texelFetch(occlusion_raw, clamp(here + ivec2(x, y), ivec2(0), last), 0).rg;
            float alike = abs(other.g - depth_m) < 0.05 * depth_m ? 1.0 : 0.0;
            sum += alike * other.r;
            weight += alike;
        }
    }
    return vec4(weight > 0.0 ? sum / weight : 1.0);
}

void occlusion_on_ambient(in Surface s, inout vec3 irradiance) {
    float seen = textureLod(occlusion_smooth, gl_FragCoord.xy * frame.viewport.zw, 0.0).r;
    irradiance *= clamp(1.0 - occlusion_amount * (1.0 - seen), 0.0, 1.0);
}
