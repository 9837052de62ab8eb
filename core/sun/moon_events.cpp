#include "sun/moon_events.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "sun/sky_path.h"

namespace relevo::sun {
namespace {

void add_events(const PositionTable& table, const Observer& observer, const RiseRule& rule,
                MoonDay& day) {
    const SkyPath path(table, day.span, observer);
    const Crossings moon =
        path.crossings([&](double distance_au) { return rule.center_elevation_rad(distance_au); });
    path.add(day.events, EventKind::Moonrise, EventKind::Moonset, moon);
    path.add_transits(day.events);
    std::ranges::sort(day.events, [](const Event& a, const Event& b) { return a.utc < b.utc; });
    day.moon = moon.state;
    day.moon_up = moon.above;
    for (const TimeSpan& up : moon.above)
        day.moon_up_s += up.length_s();
}

}  // namespace

std::vector<MoonDay> moon_days(Date first, Date last, const Zone& zone, const geo::Geodetic& place,
                               const RiseRule& rule, const EarthRotation& rotation) {
    const std::vector<LocalDay> local = local_days(first, last, zone);
    std::vector<MoonDay> days;
    if (local.empty()) return days;
    const Observer observer(place);
    const Instant begin = local.front().span.begin, end = local.back().span.end;
    const PositionTable table(begin, end, rotation, Body::Moon);
    const std::vector<PhaseTime> phases = moon_phases(begin, end);
    for (const LocalDay& of : local) {
        MoonDay& day = days.emplace_back();
        day.date = of.date;
        day.span = of.span;
        add_events(table, observer, rule, day);
        for (const PhaseTime& phase : phases)
            if (phase.utc >= day.span.begin && phase.utc < day.span.end)
                day.phases.push_back(phase);
        const MoonPosition noon = moon_position(day.span.begin + day.span.length_s() / 2, place);
        day.illuminated_fraction = noon.illuminated_fraction;
        day.phase_longitude_rad = noon.phase_longitude_rad;
    }
    return days;
}

}  // namespace relevo::sun
