#pragma once

#include <vector>

#include "base/units.h"
#include "sky/air.h"
#include "sky/values.h"

namespace relevo::sky {

/// Air along a ray, as lengths of it at full density [m]: Extinction times them is an optical
/// depth.
struct Column {
    float rayleigh_m = 0, aerosol_m = 0, ozone_m = 0;
};

/// Air between any height and space, in any direction. It depends on the profiles alone, so it is
/// the same for every Air and wavelength.
class Columns {
  public:
    static constexpr int kSines = 192, kHeights = 64;

    Columns();

    /// Column towards a direction that does not meet the ground; below the horizon that of the
    /// horizon. Errors: 1.5 % (tests/sky/test_atmosphere.cpp).
    Column towards(double height_m, double sine) const;

    /// The one table of the process.
    static const Columns& shared();

  private:
    std::vector<Column> table_;  // by height and sine, dense at the ground and at the horizon
};

/// Semidiameter of the sun's disc.
inline constexpr double kSunRadius_rad = radians(0.2666);

/// Part of the sun's disc above the horizon of a height. @param sine  of its centre's elevation
double disc_above_horizon(double height_m, double sine);

}  // namespace relevo::sky
