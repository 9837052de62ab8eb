#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "geo/geodetic.h"
#include "sun/position_table.h"
#include "sun/rise_rule.h"
#include "sun/zone.h"

namespace relevo::sun {

enum class EventKind {
    AstronomicalDawn,  ///< the centre rises through -18 degrees, true elevation
    NauticalDawn,      ///< -12
    CivilDawn,         ///< -6
    Sunrise,           ///< by the RiseRule
    Transit,           ///< the centre crosses the meridian on the side of noon
    Sunset,
    CivilDusk,
    NauticalDusk,
    AstronomicalDusk,
    LowerTransit,  ///< the meridian on the side of midnight
    Moonrise,      ///< by the moon's RiseRule
    Moonset,
};

/// "sunrise", "civil_dawn", "lower_transit", ...
std::string_view name_of(EventKind kind);

struct Event {
    EventKind kind;
    Instant utc;
    double azimuth_rad = 0;    ///< of the centre, clockwise from true north
    double elevation_rad = 0;  ///< of the centre, true
};

/// Whether the sun crosses a threshold on a local day.
enum class Crossing {
    Crosses,      ///< at least once
    AboveAllDay,  ///< of the horizon: polar day
    BelowAllDay,  ///< of the horizon: polar night
};

struct DayOptions {
    RiseRule rule;
};

/// What the sun does on a local day.
struct Day {
    Date date;
    TimeSpan span;  ///< the local day
    /// In order of time. Near the poles, and where the clocks are far from the sun's time, any of
    /// them may come twice on a local day, or not at all.
    std::vector<Event> events;
    Crossing sun = Crossing::Crosses;
    Crossing civil = Crossing::Crosses;
    Crossing nautical = Crossing::Crosses;
    Crossing astronomical = Crossing::Crosses;
    std::vector<TimeSpan> sun_up;       ///< within the local day
    std::vector<TimeSpan> golden_hour;  ///< likewise
    std::vector<TimeSpan> blue_hour;    ///< likewise
    double day_length_s = 0;            ///< of sun_up, together
    std::string definition;             ///< of rising and setting, to be printed with the result

    /// The first of its kind on that day.
    std::optional<Instant> first(EventKind kind) const;
    std::vector<Instant> all(EventKind kind) const;
};

/// The events of a local day.
/// @throws Error (BadInput) outside 1900-2100, for an impossible place, for a day that the zone
///     skipped
/// Accuracy: against JPL's DE431 with UT1 known, 0.0025 s median, 0.012 s worst of 2700 events at
/// 25 places, 1900-2100; of 4840 minutes printed by the U.S. Naval Observatory 97.6 % are the same
/// and the rest the next one, within two degrees of the pole 4 minutes (tests/sun/test_events.cpp).
/// Real air moves sunrise by 20 to 60 s from day to day.
Day day_events(Date date, const Zone& zone, const geo::Geodetic& place,
               const DayOptions& options = {},
               const EarthRotation& rotation = EarthRotation::built_in());

/// The events of all local days from `first` to `last`, without those that the zone skipped. A
/// year takes 16 ms and the PositionTable's 25 (tests/bench/bench_sun.cpp).
std::vector<Day> day_events(Date first, Date last, const Zone& zone, const geo::Geodetic& place,
                            const DayOptions& options = {},
                            const EarthRotation& rotation = EarthRotation::built_in());

/// The events within a span that lies in the table.
Day day_events(const PositionTable& table, const TimeSpan& span, const Observer& observer,
               const DayOptions& options);

}  // namespace relevo::sun
