//! provides  light through plane layers of cloud: the two-stream of core/weather/two_stream.h, in GLSL
//! source    J. H. Joseph, W. J. Wiscombe and J. A. Weinman, J. Atmos. Sci. 33 (1976) 2452; W. E. Meador and
//!           W. R. Weaver, J. Atmos. Sci. 37 (1980) 630, eq. 24 and table 1. Overcast sky: CIE S 011:2003

const float clouds_g = 0.85;  // asymmetry of water droplets
const float clouds_peak = clouds_g * clouds_g;           // share of light that goes on as if unscattered
const float clouds_g_scaled = clouds_g / (1.0 + clouds_g);
const float clouds_gamma1 = 0.75 * (1.0 - clouds_g_scaled);

/// Share of the sun's light that passes a layer scattered, of its irradiance on the level.
/// @param sine  of the sun's elevation
float clouds_diffuse_of_sun(in float tau, in float sine) {
    float mu = max(sine, 0.02);
    float scaled = (1.0 - clouds_peak) * tau;
    float kept = exp(-scaled / mu);
    float gamma3 = 0.25 * (2.0 - 3.0 * clouds_g_scaled * mu);
    float a = clouds_gamma1 * scaled;
    float reflected = clamp((a + (gamma3 - clouds_gamma1 * mu) * (1.0 - kept)) / (1.0 + a), 0.0, 1.0);
    return max(1.0 - reflected - exp(-tau / mu), 0.0);
}

/// Share of the light of an even sky that a layer reflects; the rest passes.
float clouds_reflected_sky(in float tau) {
    float a = clouds_gamma1 * (1.0 - clouds_peak) * tau;
    return a / (1.0 + a);
}

/// Light inside a layer that is lit from one side with irradiance 1, as radiance of white ground.
/// @param before, behind  optical depths towards the light and away from it
/// @param along           1: looking towards the light, -1: away from it
float clouds_inside(in float before, in float behind, in float along) {
    float x = clouds_gamma1 * (1.0 - clouds_peak) * before, y = clouds_gamma1 * (1.0 - clouds_peak) * behind;
    float on = (1.0 + y) / (1.0 + x + y), back = y / (1.0 + x + y);
    return mix(back, on, 0.5 + 0.5 * along);
}

/// Light scattered once, times pi: two lobes of Henyey and Greenstein, the forward one of which makes
/// edges near the sun shine.
float clouds_phase(in float cosine) {
    float a = 1.0 + 0.8 * 0.8 - 2.0 * 0.8 * cosine, b = 1.0 + 0.3 * 0.3 + 2.0 * 0.3 * cosine;
    return 0.25 * (0.7 * (1.0 - 0.64) * inversesqrt(a * a * a) + 0.3 * (1.0 - 0.09) * inversesqrt(b * b * b));
}

/// CIE's overcast sky over the mean of its light on level ground.
float clouds_overcast(in float sine) {
    return 3.0 / 7.0 * (1.0 + 2.0 * max(sine, 0.0));
}
