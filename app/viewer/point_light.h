#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "dem/heightfield.h"
#include "geo/geodetic.h"
#include "scene/scene.h"
#include "sun/zone.h"

namespace relevo::viewer {

/// When the sun reaches a point of the ground on a day.
struct PointLight {
    geo::Geodetic place;
    sun::Date date;
    std::vector<sun::TimeSpan> lit;
    double lit_s = 0, flat_s = 0;  ///< of that day, here and over a flat horizon
    std::string error;             ///< why there is no answer

    bool is_lit(sun::Instant utc) const;
    /// When that changes next on that day.
    std::optional<sun::Instant> next_change(sun::Instant utc) const;
};

/// Works it out on a thread of its own, from every post of the DEM.
/// @param loaded  all posts or means of them; must outlive the work
std::future<PointLight> light_at(const geo::Geodetic& place, sun::Date date, const sun::Zone& zone,
                                 const scene::Scene& scene, const dem::Heightfield& loaded);

}  // namespace relevo::viewer
