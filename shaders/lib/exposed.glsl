//! provides  exposed: radiance as the passes hand it on, within the range of half floats

/// Exposed before it is stored: the light of a night is 1e-8 of a day's, where halves end at 6e-8.
vec3 exposed(in vec3 radiance) {
    return min(radiance * frame.exposure, vec3(60000.0));
}
