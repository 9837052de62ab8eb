//! provides  srgb_encoded: linear light to the sRGB curve, 0..1; srgb_decoded: the inverse
//! source    IEC 61966-2-1; a polynomial in the square root instead of a power, off by at most 0.1/255
//!           (tests/render/test_shown.cpp)

vec3 srgb_encoded(in vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    vec3 s = sqrt(c);
    vec3 high = -0.03998186 + s * (1.51484112 + s * (-1.38023050 + s * (1.96670454 + s * (-1.54449795 + s * 0.48316465))));
    return mix(high, 12.92 * c, lessThan(c, vec3(0.0031308)));
}

/// The sRGB curve to linear light, exactly.
vec3 srgb_decoded(in vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}
