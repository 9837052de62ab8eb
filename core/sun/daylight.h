#pragma once

#include <glm/vec3.hpp>

/// How much light a clear sky lets through and sheds. Everything is relative to the sun's light
/// outside the atmosphere, so that a white diffuse surface that faces it there reflects a radiance
/// of 1.
namespace relevo::sun {

/// Illuminance that an irradiance of 1 stands for: the solar illuminance constant [lux].
inline constexpr double kSolarIlluminance_lux = 127500;

/// Relative optical air mass: 1 at the zenith, about 38 at the horizon.
/// @param apparent_elevation_rad  of the sun, refracted; values below 0 count as 0
/// Accuracy: 0.5 % of the tables it was fitted to; tests/sun/test_daylight.cpp.
/// Source: F. Kasten and A. T. Young, Revised optical air mass tables and approximation formula,
/// Applied Optics 28 (1989), 4735-4738, doi:10.1364/AO.28.004735.
double air_mass(double apparent_elevation_rad);

/// Share of the sun's light that reaches a surface facing it through a clear, clean atmosphere, for
/// the red, green and blue of linear sRGB (taken at 610, 550 and 465 nm). While the disc crosses
/// the horizon the part of it that has risen counts, as seen without terrain.
/// @param apparent_elevation_rad  of the sun's centre, refracted
/// @param height_m                of the surface above sea level; thins the air
/// Source: Rayleigh scattering by J. E. Hansen and L. D. Travis, Space Sci. Rev. 16 (1974), 527,
/// eq. 2.30; ozone (300 DU) by R. E. Bird and C. Riordan, J. Climate Appl. Meteor. 25 (1986), 87,
/// table 1; aerosol by Angstrom's formula with beta 0.04, alpha 1.3 (clean continental air).
glm::dvec3 direct_transmittance(double apparent_elevation_rad, double height_m);

/// Illuminance on level ground from the whole sky without the sun's disc, clear weather, no moon
/// [lux].
/// @param elevation_rad  of the sun's centre, geometric
/// Source: by day the IES's clear sky, 800 + 15500 sqrt(sin h) lux (IESNA RP-21); below the horizon
/// P. K. Seidelmann (ed.), Explanatory Supplement to the Astronomical Almanac (1992), p. 491,
/// scaled by 5 % to meet it at the horizon; never below 0.002 lux, a moonless night sky.
double sky_illuminance_lux(double elevation_rad);

/// The same as a colour: irradiance on level ground, linear sRGB, relative as everything here.
/// Skies are blue by day (a clear sky's correlated colour temperature of about 12000 K) and turn
/// bluer through twilight, when ozone takes the yellow away.
glm::dvec3 sky_irradiance(double elevation_rad);

/// Share of a clear sky's light that an eclipse leaves. The sky follows the visible fraction of the
/// sun up to an obscuration of 99.8 %; in totality it is lit from beyond the umbra, by some lux
/// where 13 000 were.
/// Source: W. E. Sharp, S. M. Silverman, J. W. F. Lloyd, Appl. Optics 10 (1971) 1207; K.-P.
/// Moellmann, M. Vollmer, Eur. J. Phys. 27 (2006) 1299
double eclipsed_sky(double visible_fraction);

/// Factor on radiance that a photographer would choose for a sun at this elevation: 2 with the sun
/// high, more the less light there is, though never so much that dusk looks like day, nor a moonlit
/// night like a sunlit one. It depends on sun and moon alone, never on the picture, so that frames
/// of one moment match.
/// @param elevation_rad     of the sun's centre, geometric
/// @param visible_fraction  of the sun's disc, in an eclipse
/// @param moonlight_lux     on level ground, of the moon and the sky that it lights
double natural_exposure(double elevation_rad, double visible_fraction = 1,
                        double moonlight_lux = 0);

/// Luminance of radiance 1 [cd/m2]: that of a white diffuse surface that faces the sun outside the
/// atmosphere. The same surface has 433 W/m2/sr, over all wavelengths (1361 W/m2).
inline constexpr double kUnitLuminance_cd_m2 = kSolarIlluminance_lux / 3.14159265358979;

/// Exposure value at ISO 100 of a factor on radiance: that of a light meter which makes what it
/// sees middle grey, a reflectance of 0.18.
/// Source: ISO 2720:1974, calibration constant K = 12.5 cd s/m2: L = 2^EV K / 100.
double ev100_of_exposure(double exposure);
/// Its inverse.
double exposure_of_ev100(double ev100);

}  // namespace relevo::sun
