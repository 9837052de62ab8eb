#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "sky/spectrum.h"

/// Optical properties of a clear atmosphere: what every computation of the sky's light starts from.
namespace relevo::sky {

/// Radius of the spherical Earth, at sea level [m].
inline constexpr double kEarthRadius_m = 6371000;

/// Height above which the air scatters nothing worth following [m]: 4e-7 of its column is above.
inline constexpr double kTopOfAir_m = 100000;

/// Parameters of the atmosphere. Their defaults are an average clear day (docs/accuracy-sky.md).
struct Air {
    /// Aerosol optical depth at 1 um from sea level to space. 0.04 is clean air, 0.2 turbid.
    double angstrom_beta = 0.08;
    /// Exponent of the aerosol optical depth, beta * wavelength_um^-alpha.
    double angstrom_alpha = 1.3;
    /// Column of ozone [Dobson units].
    double ozone_du = 300;
    /// Reflectance of the ground, Lambertian, the same at all wavelengths.
    double ground_albedo = 0.12;

    bool operator==(const Air&) const = default;
};

/// Extinction at the height where each component is densest [1/m]. Multiply it by the density.
struct Extinction {
    Spectrum rayleigh{};  ///< at sea level; all of it scatters
    Spectrum aerosol{};   ///< at sea level; kAerosolAlbedo of it scatters
    Spectrum ozone{};     ///< at 25 km; absorption alone
};
/// Sources: Rayleigh scattering: J. E. Hansen and L. D. Travis, Space Sci. Rev. 16 (1974), 527, eq.
/// 2.30, as core/sun/daylight.h has it; the ozone layer: E. Bruneton, A Qualitative and
/// Quantitative Evaluation of 8 Clear Sky Models, 2016; cross section of ozone: spectrum.h; aerosol
/// optical depth: A. Angstrom, Techniques of Determining the Turbidity of the Atmosphere, Tellus
/// 13(2), 1961, in an exponential atmosphere.
Extinction extinction(const Air& air);

/// Extinction of white light at sea level [1/m], by the luminance that passes 1 km.
double white_extinction(const Air& air);

/// Vertical optical depth of the aerosol from sea level to space.
/// @param um  wavelength [um]
double aerosol_depth(const Air& air, double um);

/// Length of the air's column, were it all as dense as at sea level.
inline constexpr double kRayleighColumn_m = 8452;
inline constexpr double kAerosolScaleHeight_m = 1200;
/// Single-scattering albedo of the aerosol.
inline constexpr double kAerosolAlbedo = 0.93;
/// Asymmetry parameter of the aerosol's phase function.
inline constexpr double kAerosolAsymmetry = 0.8;

/// Densities relative to the densest. @param height_m above sea level, not negative
/// The air's: U.S. Standard Atmosphere, 1976. An exponential of one scale height has twice as much
/// air from 40 to 80 km, which dusk is as much too bright by.
double rayleigh_density(double height_m);
/// Its change with height [1/m].
double rayleigh_density_slope(double height_m);
inline double aerosol_density(double height_m) {
    return std::exp(-height_m / kAerosolScaleHeight_m);
}
/// A layer from 10 to 40 km, densest at 25 km.
inline double ozone_density(double height_m) {
    return std::max(0.0, 1 - std::abs(height_m - 25000) / 15000);
}

/// Phase functions [1/sr]; their integral over the sphere is 1.
/// @param cosine of the angle by which light is deflected
inline double rayleigh_phase(double cosine) {
    return 3 / (16 * kPi) * (1 + cosine * cosine);
}
/// Source: L. G. Henyey and J. L. Greenstein, Diffuse Radiation in the Galaxy, Astrophysical
/// Journal 93, 1941.
inline double henyey_greenstein(double cosine, double g) {
    return (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}
inline double aerosol_phase(double cosine) {
    return henyey_greenstein(cosine, kAerosolAsymmetry);
}

}  // namespace relevo::sky
