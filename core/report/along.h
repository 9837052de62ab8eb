#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dem/places.h"
#include "light/point/light_along.h"
#include "report/asked.h"
#include "sun/zone.h"

namespace relevo::report {

/// When a walk is, as it is asked for.
struct WalkWords {
    std::string start, zone;  ///< of --start and --tz; empty: the track's own, that of its start
    std::optional<double> speed_kmh;  ///< none: by the track's own times
    /// Reads `start`, where events happen at the first point.
    std::function<sun::ParsedTime(const geo::PlaceText& first)> parse_start;
    ChooseZone choose;

    /// What a track without times of its own needs, before any work is done.
    /// @param path  of the track, for messages, here and below @throws Error (Usage)
    void check(const dem::NamedLine& line, const std::string& path) const;
};

/// Where a walk is in the sun.
struct Along {
    std::string name;
    std::size_t points = 0;
    sun::Zone zone;
    std::string assumption;  ///< of the zone; empty where none was made
    std::string air;
    light::LightAlong found;

    const light::WalkSum& sum(light::WalkLight light) const {
        return found.sums[static_cast<std::size_t>(light)];
    }
};

/// @param line  of two places or more
/// @throws Error (BadInput) where a point has no time or one before that of the last point, and as
///     light::Walk and light::light_along()
Along along(const View& view, const WalkWords& words, const dem::NamedLine& line,
            const std::string& path, const dem::Posts& posts);
/// How long a walk has each light in an hour of the zone's clocks.
struct WalkHour {
    sun::Instant begin;
    std::array<double, light::kWalkLights> time_s{};  ///< by WalkLight
};
/// From the hour in which it begins to that in which it ends, also those in between without light.
std::vector<WalkHour> hours_of(const Along& result);

/// @param by_hour  `hours` in the place of `stretches`
std::string json_of(const Along& result, bool by_hour = false);

}  // namespace relevo::report
