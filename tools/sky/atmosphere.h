#pragma once

#include <vector>

#include "sky/air.h"

namespace relevo::skymaker {

using sky::Air;
using sky::colour_of;
using sky::kWavelengths;
using sky::Spectrum;
using sky::wavelength_um;

/// A clear sky over a round Earth, lit by the sun alone.
///
/// Single scattering is integrated along the ray; all further orders are S. Hillaire's: the light
/// scattered twice, taken as coming from everywhere alike, times the sum of a geometric series.
/// Source: S. Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique,
/// Computer Graphics Forum 39(4), 2020, section 5.
class Atmosphere {
  public:
    explicit Atmosphere(const Air& air = {});

    /// What a direction of the sky sends to an eye at sea level, the sun's disc left out, as shares
    /// of the solar irradiance in the unit where a white diffuse surface that faces the sun outside
    /// the atmosphere has radiance 1.
    struct Radiance {
        Spectrum sky{};
        Spectrum aureole{};  ///< the bright ring of the aerosol around the sun; not part of `sky`
    };
    /// @param sine        of the direction's elevation, 0..1
    /// @param sun_sine    of the sun's elevation
    /// @param azimuth_cos cosine of the horizontal angle between the two
    Radiance radiance(double sine, double sun_sine, double azimuth_cos) const;

    /// Share of the sun's light that passes from outside to sea level; 0 below the horizon.
    Spectrum transmittance(double sun_sine) const;

  private:
    struct Columns {
        double rayleigh_m = 0, aerosol_m = 0, ozone_m = 0;
    };
    struct Lit {
        Columns columns;
        double share = 0;  // of the sun's disc above the Earth's edge
    };

    Lit towards_sun(double height_m, double sine) const;
    Columns columns(double height_m, double sine) const;
    void scatter_many();
    Spectrum many(double height_m, double sun_sine) const;
    void pass(Spectrum& through, const Columns& columns, double length_m) const;

    Air air_;
    sky::Extinction extinction_;
    std::vector<Lit> to_sun_;     // by height and sine of the sun
    std::vector<Spectrum> many_;  // likewise
};

/// The part of the aerosol's forward scattering that is the aureole. The sky draws it as a sum of
/// powers.
/// @param distance  between the unit vectors towards the sun and along the view
/// @returns phase function [1/sr]
double aureole_phase(double distance);

}  // namespace relevo::skymaker
