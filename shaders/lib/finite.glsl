//! provides  finite: whether values are numbers; passes hand it on in the alpha of what they draw

/// 1 where all of the components are numbers, 0 where one is none or infinite: an exponent of ones.
/// Told by bits, as compilers may take a comparison with NaN for its opposite's opposite.
float finite(in vec4 values) {
    const uint ones = 0x7f800000u;
    return any(equal(floatBitsToUint(values) & ones, uvec4(ones))) ? 0.0 : 1.0;
}

/// The height that a vertex hands on which an effect moved nowhere; no ground has it [m].
const float kNowhere_m = 1e35;
