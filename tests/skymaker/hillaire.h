#pragma once

#include <vector>

#include "sky/air.h"

namespace relevo::skymaker {

/// S. Hillaire's clear sky over a round Earth, at sea level, lit by the sun alone: what the
/// program's own sky is compared with.
///
/// Single scattering is integrated along the ray; all further orders are the light scattered
/// twice, taken as coming from everywhere alike, times the sum of a geometric series.
/// Source: S. Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique,
/// Computer Graphics Forum 39(4), 2020, section 5.
class HillaireSky {
  public:
    explicit HillaireSky(const sky::Air& air = {});

    /// What a direction of the sky sends, without the sun's disc, as shares of the solar irradiance
    /// in the unit where a white diffuse surface that faces the sun outside the atmosphere has
    /// radiance 1.
    /// @param sine        of the direction's elevation, 0..1
    /// @param sun_sine    of the sun's elevation
    /// @param azimuth_cos cosine of the horizontal angle between the two
    sky::Spectrum radiance(double sine, double sun_sine, double azimuth_cos) const;

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
    sky::Spectrum many(double height_m, double sun_sine) const;
    void pass(sky::Spectrum& through, const Columns& columns, double length_m) const;

    sky::Air air_;
    sky::Extinction extinction_;
    std::vector<Lit> to_sun_;          // by height and sine of the sun
    std::vector<sky::Spectrum> many_;  // likewise
};

}  // namespace relevo::skymaker
