#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "dem/posts.h"
#include "sun/event_time.h"

namespace relevo::light {

/// A DEM for what may not need it.
struct TerrainAccess {
    std::function<geo::Geodetic()> middle;     ///< called where a place is missing
    std::function<const dem::Posts&()> posts;  ///< called where the terrain matters
};

/// Reads a moment in any form there is: a time of day (sun::parse_time), an event of the sun
/// (sun::parse_event_time), or first or last direct light at a place on a DEM.
/// @param date  the local day, for events that do not name theirs
/// @param dem   the terrain; empty functions: there is none
/// @param here  the place of events that do not name theirs; none: the middle of the DEM
/// @throws Error (BadInput) as those two, where first or last light is asked for without a DEM,
///     and where the sun does not reach the place that day
sun::ParsedTime parse_time(std::string_view text, const std::optional<sun::Date>& date,
                           const std::optional<sun::Zone>& zone, const TerrainAccess& dem = {},
                           const std::optional<geo::PlaceText>& here = {});

}  // namespace relevo::light
