//! provides  finite: whether values are numbers; passes hand it on in the alpha of what they draw

/// 1 where all of the components are numbers, 0 where one is none or infinite.
float finite(in vec4 values) {
    const float most = 3.0e38;  // the largest float is 3.4e38; no comparison with NaN holds
    return all(lessThan(abs(values), vec4(most))) ? 1.0 : 0.0;
}
