#pragma once

#include <optional>
#include <string>

#include "geo/geodetic.h"
#include "sun/refraction.h"
#include "weather/station_air.h"

namespace relevo::light {

/// @param model  "standard", "saemundsson" or "none"
/// @param air    that "standard" takes instead of the standard atmosphere
sun::Refraction refraction_at(const std::string& model, const geo::Geodetic& place,
                              const std::optional<weather::StationAir>& air = {});

}  // namespace relevo::light
