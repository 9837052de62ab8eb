//! provides  grading: exposure, contrast, saturation, warmth, a table of colours and a vignette
//! hook      image, finish
//! writes    radiance before tone mapping, colours behind it

//@ include lib/srgb.glsl

uniform sampler3D grade_look;  // one texel a side: no file is named

uniform float grade_exposure = 0.0; //@ range(-10, 10) unit(EV) label("Exposure") description("In stops: 1 is twice as bright")
uniform float grade_warmth = 0.0; //@ range(-1, 1) label("Warmth") description("Redder above 0, bluer below, equally bright")
uniform float grade_contrast = 1.1; //@ range(0, 4) label("Contrast") description("Exponent around middle grey")
uniform float grade_saturation = 1.0; //@ range(0, 4) label("Saturation") description("0: grey")
uniform float grade_vignette = 0.25; //@ range(0, 1) label("Vignette") description("How much darker the corners are")

const float grade_grey = 0.18;  // contrast leaves it as it is
const vec3 grade_luminance = vec3(0.2126, 0.7152, 0.0722);  // of linear sRGB. source: IEC 61966-2-1

void grade_on_image(in Pixel p, inout vec3 radiance) {
    float before = dot(radiance, grade_luminance);
    vec3 warmed = radiance * exp2(grade_warmth * vec3(0.5, 0.0, -0.5));
    float after = dot(warmed, grade_luminance);
    radiance = exp2(grade_exposure) * warmed * (after > 0.0 ? before / after : 1.0);
}

/// The colour that the table has for a linear colour of 0 to 1. Its entries are sRGB.
vec3 grade_looked_up(in vec3 colour) {
    float side = float(textureSize(grade_look, 0).x);
    if (side < 2.0) return colour;
    vec3 at = (srgb_encoded(colour) * (side - 1.0) + 0.5) / side;
    return srgb_decoded(clamp(textureLod(grade_look, at, 0.0).rgb, 0.0, 1.0));
}

void grade_on_finish(in Pixel p, inout vec3 colour) {
    float brightness = max(dot(colour, grade_luminance), 0.0);
    float wanted = grade_grey * pow(max(brightness / grade_grey, 1e-6), grade_contrast);
    vec3 contrasted = colour * (wanted / max(brightness, grade_grey * 1e-6));
    contrasted = mix(vec3(wanted), contrasted, grade_saturation);
    contrasted = grade_looked_up(clamp(contrasted, 0.0, 1.0));
    // 0 in the middle, 1 in the corners. cos^4 of a lens would depend on the field of view.
    vec2 off = 2.0 * p.in_picture - 1.0;
    float corner = 0.5 * dot(off, off);
    colour = clamp(contrasted, 0.0, 1.0) * (1.0 - grade_vignette * corner * corner);
}
