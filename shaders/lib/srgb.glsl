//! provides  srgb_encoded: linear light to the sRGB curve, 0..1
//! source    IEC 61966-2-1; three square roots instead of a power, off by at most 0.4/255
//!           (tests/render/test_shader_maths.cpp)

vec3 srgb_encoded(in vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    vec3 s1 = sqrt(c);
    vec3 s2 = sqrt(s1);
    vec3 s3 = sqrt(s2);
    vec3 high = 0.662002687 * s1 + 0.684122060 * s2 - 0.323583601 * s3 - 0.0225411470 * c;
    return mix(high, 12.92 * c, lessThan(c, vec3(0.0031308)));
}
