//! provides  bloom: light that a lens scatters around what is bright
//! hook      image
//! reads     radiance of the whole picture, linear, exposed
//! writes    radiance
//! source    J. Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, SIGGRAPH 2014:
//!           halved from level to level, then doubled and added; here with weights that keep the sum of light

uniform float bloom_amount = 0.06; //@ range(0, 1) label("Amount") description("Share of the light that is scattered")
uniform float bloom_spread = 0.6; //@ range(0, 1) label("Spread") description("How much of the scattered light goes on to the next, twice as wide level")

uniform sampler2D bloom_scene; //@ from(core.radiance)
uniform sampler2D bloom_half;
uniform sampler2D bloom_quarter;
uniform sampler2D bloom_eighth;
uniform sampler2D bloom_sixteenth;
uniform sampler2D bloom_last;
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

/// A level, and the next coarser one doubled. Linear filters twice: weights of a quadratic spline.
vec4 bloom_doubled(in sampler2D fine, in sampler2D coarse, in Texel t) {
    return mix(texelFetch(fine, ivec2(t.at_px), 0), bloom_around(coarse, 0.5 * t.at_px, 0.5),
               bloom_spread);
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

vec4 bloom_pass_last(in Texel t) {
    return bloom_halved(bloom_sixteenth, t);
}

vec4 bloom_pass_to_sixteenth(in Texel t) {
    return bloom_doubled(bloom_sixteenth, bloom_last, t);
}

vec4 bloom_pass_to_eighth(in Texel t) {
    return bloom_doubled(bloom_eighth, bloom_to_sixteenth, t);
}

vec4 bloom_pass_to_quarter(in Texel t) {
    return bloom_doubled(bloom_quarter, bloom_to_eighth, t);
}

vec4 bloom_pass_to_half(in Texel t) {
    return bloom_doubled(bloom_half, bloom_to_quarter, t);
}

void bloom_on_image(in Pixel p, inout vec3 radiance) {
    vec2 at = p.at_px / (2.0 * vec2(textureSize(bloom_to_half, 0)));
    radiance = mix(radiance, texture(bloom_to_half, at).rgb, bloom_amount);
}
