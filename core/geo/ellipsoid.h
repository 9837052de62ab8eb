#pragma once

namespace relevo::geo {

/// The ellipsoid of WGS 84: NIMA TR8350.2, third edition.
inline constexpr double kEquatorialRadius_m = 6378137;
inline constexpr double kFlattening = 1 / 298.257223563;

}  // namespace relevo::geo
