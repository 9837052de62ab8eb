#pragma once

#include <array>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace relevo::sky {

/// Wavelengths that light is followed at: 400 to 700 nm, every 20.
inline constexpr int kWavelengths = 16;
using Spectrum = std::array<double, kWavelengths>;

double wavelength_um(int i);

/// Spectral irradiance of the sun outside the atmosphere [W/m2/nm].
/// Source: ASTM G-173 reference spectra, ETR column, averaged over 10 nm, as E. Bruneton tabulates
/// it (Precomputed Atmospheric Scattering, 2017, demo.cc).
const Spectrum& solar_irradiance();

/// Absorption cross section of ozone at 233 K [m2 a molecule].
/// Source: University of Bremen, Serdyuchenko et al. 2011, averaged over 10 nm, likewise.
const Spectrum& ozone_cross_section();

/// Linear sRGB of light whose spectrum is the sun's times `share`; a share of 1 everywhere is
/// white, (1, 1, 1). Colours outside of sRGB may have a negative part.
/// Source: C. Wyman, P.-P. Sloan, P. Shirley, Simple Analytic Approximations to the CIE XYZ Color
/// Matching Functions, Journal of Computer Graphics Techniques 2(2), 2013; IEC 61966-2-1.
glm::dvec3 colour_of(const Spectrum& share);

/// CIE 1931 tristimulus values of light whose spectrum is the sun's times `share`. The sun's own
/// has Y = 1; its X and Z are those of a light of 5900 K, where colour_of has white.
glm::dvec3 xyz_of(const Spectrum& share);
/// The same from what colour_of returns.
glm::dvec3 xyz_of_colour(const glm::dvec3& linear_srgb);

/// CIE 1976 u' and v'. Source: CIE 015:2018, section 8.2.
glm::dvec2 chromaticity(const glm::dvec3& xyz);

}  // namespace relevo::sky
