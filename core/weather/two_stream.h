#pragma once

namespace relevo::weather {

/// A plane cloud layer.
struct CloudLayerOptics {
    double optical_depth = 10;
    double asymmetry = 0.85;              ///< g of the phase function; water droplets
    double single_scattering_albedo = 1;  ///< 1: nothing is absorbed
};

/// What becomes of the light that meets a layer, as shares of the irradiance on its top. Their sum
/// with what the layer absorbs is 1.
struct LayerLight {
    double direct = 0;     ///< passes unscattered
    double diffuse = 0;    ///< passes scattered, at least once
    double reflected = 0;  ///< leaves at the top

    double transmitted() const { return direct + diffuse; }
};

/// Light of a parallel beam through a layer over black ground, by the delta-Eddington
/// approximation: the forward peak of the phase function counts as unscattered in its equations,
/// but `direct` is what really is unscattered, exp(-tau / mu).
/// @param mu  cosine of the beam's zenith angle, above 0 and at most 1
/// @throws Error (BadInput) for optical depths and albedos that are none, NaN among them
/// Accuracy: reflected, transmitted and absorbed add up to 1 within 1e-9 for any optical depth from
///     0 to 1e9; within 0.07 of the irradiance, in the mean 0.01, of photons followed one by one
///     with Henyey and Greenstein's phase function, for mu of 0.3 and more
///     (tests/weather/test_two_stream.cpp).
/// Source: J. H. Joseph, W. J. Wiscombe and J. A. Weinman, The Delta-Eddington Approximation for
///     Radiative Flux Transfer, J. Atmos. Sci. 33 (1976) 2452; W. E. Meador and W. R. Weaver,
///     Two-Stream Approximations to Radiative Transfer in Planetary Atmospheres, J. Atmos. Sci. 37
///     (1980) 630, equations 14, 15, 20, 21 and table 1.
LayerLight beam_through(const CloudLayerOptics& layer, double mu);

/// The same for light that comes from all the sky alike. `direct` is 0.
LayerLight sky_through(const CloudLayerOptics& layer);

/// The irradiance below a layer over reflecting ground, as a share of what meets its top: light
/// goes to and fro between ground and layer.
/// @param through  of beam_through() or sky_through()
/// @param sky      of sky_through(): what the layer does with the light of the ground
/// @param albedo   of the ground, 0 to 1
LayerLight over_ground(const LayerLight& through, const LayerLight& sky, double albedo);

}  // namespace relevo::weather
