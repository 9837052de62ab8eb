#pragma once

#include <memory>
#include <string>

#include "light/point/alignment.h"
#include "light/point/doubt.h"
#include "report/asked.h"

namespace relevo::report {

/// When sun or moon stand over a summit.
struct WhenOptions {
    std::string over;  ///< LAT,LON for the highest post nearby, or LAT,LON,H for that point
    double summit_radius_m = 100, tolerance_deg = 0.5;

    /// The point that is meant. @throws Error as geo::parse_place() and light::summit_near()
    geo::Geodetic target(const dem::Posts& posts) const;
};

struct When {
    std::unique_ptr<const light::TerrainHorizon> horizon;
    light::Alignments found;
    Days asked;
    light::Doubt doubt;  ///< of terrain beyond the DEM
    sun::Body body = sun::Body::Sun;

    /// Whether a void of the DEM is in the way.
    bool through_hole() const;
};

/// Of View::body. @param target  as WhenOptions::target()
When when(const View& view, const WhenOptions& options, const Days& asked, const geo::PlaceText& at,
          const dem::Posts& posts, const geo::Geodetic& target);
std::string json_of(const When& result);
/// Of a passage: "sun_visible", "moon_visible".
std::string visible_key(sun::Body body);
/// Warns of voids and of terrain beyond the DEM.
void warn_of(const When& result);

}  // namespace relevo::report
