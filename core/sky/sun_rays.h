#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sky/columns.h"

namespace relevo::sky {

/// Rays of the sun that reach a height, which the air bends: where they come from, and the air
/// they pass. Traced through the standard atmosphere in steps, once for a height.
///
/// Errors: 1 arcminute of refraction against Bennett's formula, 0.7 % of the air mass against
/// Kasten and Young's (tests/sky/test_sun_rays.cpp).
/// Source: the ray equation of a spherically layered medium, M. Born and E. Wolf, Principles of
/// Optics, 7th ed. (1999), 3.2.
class SunRays {
  public:
    /// @param height_m  above sea level; below 0 counts as 0
    /// @param bent      false: straight rays
    explicit SunRays(double height_m, bool bent = true);

    double height_m() const { return height_m_; }

    /// Air towards a geometric elevation, which is that without air; nullopt below the horizon of
    /// the sea.
    std::optional<Column> towards(double elevation_rad) const;

    /// How much higher the sun is seen than it stands [rad].
    double refraction_rad(double elevation_rad) const;

    /// Geometric elevation of what is seen on the horizon of the sea.
    double horizon_rad() const { return rays_.front().elevation_rad; }

  private:
    struct Ray {
        double elevation_rad;  ///< geometric
        double apparent_rad;
        Column column;
    };
    Ray trace(double apparent_rad, bool bent) const;
    /// The ray before an elevation, and the part of the way to the next.
    struct Place {
        std::size_t first;
        double share;
    };
    Place place(double elevation_rad) const;

    double height_m_;
    std::vector<Ray> rays_;  ///< by elevation, dense at the horizon
};

/// The rays of a height, rounded to metres; the last ones asked for are kept. May be called from
/// several threads.
std::shared_ptr<const SunRays> sun_rays(double height_m, bool bent);

}  // namespace relevo::sky
