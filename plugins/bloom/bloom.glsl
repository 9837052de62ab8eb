//! provides  bloom: light that the eye scatters around what is bright
//! hook      image
//! reads     radiance of the whole picture, linear, exposed
//! writes    radiance
//! source    scattered light: CIE 135/1, Disability glare (1999), the age-adapted Stiles-Holladay equation; levels, each
//!           half as large as the one before: J. Jimenez, Next Generation Post Processing in Call of Duty: Advanced
//!           Warfare, SIGGRAPH 2014, here with weights that keep the sum of light

uniform float bloom_amount = 1.0; //@ range(0, 3) label("Amount") description("Factor on the light that the eye scatters")
uniform float bloom_age = 30.0; //@ range(1, 100) unit(years) label("Age") description("Of the eye: at 70 years it scatters twice as much as at 20 by angles above 2 degrees")

uniform sampler2D bloom_scene; //@ from(core.radiance)
uniform sampler2D bloom_half;
uniform sampler2D bloom_quarter;
uniform sampler2D bloom_eighth;
uniform sampler2D bloom_sixteenth;
uniform sampler2D bloom_thirtysecond;
uniform sampler2D bloom_last;
uniform sampler2D bloom_to_thirtysecond;
uniform sampler2D bloom_to_sixteenth;
uniform sampler2D bloom_to_eighth;
uniform sampler2D bloom_to_quarter;
uniform sampler2D bloom_to_half;

/// The mean of four reads around a point. @param at_px, aside  in texels
vec4 bloom_around(in sampler2D from, in vec2 at_px, in float aside) {
    vec2 texel = 1.0 / vec2(textureSize(from, 0));
    vec4 sum = texture(from, (at_px + vec2(-aside, -aside)) * texel);
    sum += texture(from, (at_px + vec2(aside, -aside)) * texel);
    sum += texture(from, (at_px + vec2(-aside, aside)) * texel);
    sum += texture(from, (at_px + vec2(aside, aside)) * texel);
    return 0.25 * sum;
}

/// A texel of half the size: the mean of 4 x 4 texels of `from`, with weights 1 3 3 1 both ways. Each
/// read is the mean of two texels each way with weights 1 and 3.
vec4 bloom_halved(in sampler2D from, in Texel t) {
    return bloom_around(from, 2.0 * t.at_px, 0.75);
}

/// Angle between neighbouring pixels in the middle of the picture [degrees]; 0 on maps, which nobody's eye sees.
float bloom_pixel_deg() {
    return frame.map_x == vec4(0.0) ? degrees(length(frame.pixel_ray_dx.xyz)) : 0.0;
}

/// Share of the light that level `k` spreads, 1 the half-size one. Level k is nearly a normal distribution; its standard
/// deviation is 0.72 * 2^k pixels. The integral over ln(sigma) of such distributions with weights 2 pi C / (1.2533 sigma)
/// is C / angle^3, and with weights 2 pi C it is C / angle^2. The equation holds from 0.1 degrees.
float bloom_share(in int k) {
    float sigma_deg = 0.72 * exp2(float(k)) * bloom_pixel_deg();
    float held = clamp(1.5 + log2(max(sigma_deg, 1e-6) / 0.1), 0.0, 1.0);
    float aged = 1.0 + pow(bloom_age / 62.5, 4.0);
    float per_octave = log(2.0) * radians(360.0) / (degrees(1.0) * degrees(1.0));
    return bloom_amount * held * per_octave * (10.0 / (1.2533 * max(sigma_deg, 0.03)) + 5.0 * aged);
}

/// The same of level k and all coarser ones.
float bloom_share_from(in int k) {
    float sum = 0.0;
    for (int i = k; i <= 6; ++i) sum += bloom_share(i);
    return min(sum, 1.0);
}

/// Level `k` and all coarser ones, by their shares. Linear filters twice: weights of a quadratic spline.
vec4 bloom_doubled(in sampler2D fine, in sampler2D coarse, in int k, in Texel t) {
    float coarser = bloom_share_from(k + 1) / max(bloom_share_from(k), 1e-9);
    return mix(texelFetch(fine, ivec2(t.at_px), 0), bloom_around(coarse, 0.5 * t.at_px, 0.5), coarser);
}

vec4 bloom_pass_half(in Texel t) {
    return bloom_halved(bloom_scene, t);
}

vec4 bloom_pass_quarter(in Texel t) {
    return bloom_halved(bloom_half, t);
}

vec4 bloom_pass_eighth(in Texel t) {
    return bloom_halved(bloom_quarter, t);
}

vec4 bloom_pass_sixteenth(in Texel t) {
    return bloom_halved(bloom_eighth, t);
}

vec4 bloom_pass_thirtysecond(in Texel t) {
    return bloom_halved(bloom_sixteenth, t);
}

vec4 bloom_pass_last(in Texel t) {
    return bloom_halved(bloom_thirtysecond, t);
}

vec4 bloom_pass_to_thirtysecond(in Texel t) {
    return bloom_doubled(bloom_thirtysecond, bloom_last, 5, t);
}

vec4 bloom_pass_to_sixteenth(in Texel t) {
    return bloom_doubled(bloom_sixteenth, bloom_to_thirtysecond, 4, t);
}

vec4 bloom_pass_to_eighth(in Texel t) {
    return bloom_doubled(bloom_eighth, bloom_to_sixteenth, 3, t);
}

vec4 bloom_pass_to_quarter(in Texel t) {
    return bloom_doubled(bloom_quarter, bloom_to_eighth, 2, t);
}

vec4 bloom_pass_to_half(in Texel t) {
    return bloom_doubled(bloom_half, bloom_to_quarter, 1, t);
}

void bloom_on_image(in Pixel p, inout vec3 radiance) {
    vec2 at = p.at_px / (2.0 * vec2(textureSize(bloom_to_half, 0)));
    radiance = mix(radiance, texture(bloom_to_half, at).rgb, bloom_share_from(1));
}
