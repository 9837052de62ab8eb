#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "geo/geodetic.h"
#include "sun/events.h"
#include "sun/zone.h"

namespace relevo::sun {

/// A moment named by what the sun does at a place: "sunrise@46.55,8.56",
/// "2026-06-21 sunset-30min@46.55,8.56", "first-light+1h"; the last at the place at hand.
struct EventTime {
    std::optional<Date> date;        ///< where the text begins with one
    std::optional<EventKind> event;  ///< none: first or last light, which needs the terrain
    bool last = false;               ///< of the latter two, last light
    double offset_s = 0;             ///< to be added
    std::optional<geo::PlaceText> place;
    std::string text;  ///< as it was given, for messages
};

/// "1h30min", "45s", "90min" in seconds; nothing where it is no duration.
std::optional<double> parse_duration_s(std::string_view text);

/// A step of time in seconds, above 0: "3min", "1h30min", "45s", or minutes alone, "3"; nothing
/// where it is none.
std::optional<double> parse_step_s(std::string_view text);

/// Whether a time is given so: by an `@` or the name of an event.
bool is_event_time(std::string_view text);

/// Reads `[DATE ]EVENT[+OFFSET|-OFFSET][@LAT,LON[,H]]`. Events: sunrise, sunset, noon (transit),
/// midnight (lower transit), civil-dawn, civil-dusk, nautical-dawn, nautical-dusk,
/// astronomical-dawn, astronomical-dusk, first-light, last-light. Offsets: 30min, 1h30min, 45s.
/// Between date and event stands a blank or a T.
/// @throws Error (BadInput) for an unknown event, with the nearest one, an offset or date that is
///     none, an offset of more than a year; (Usage) for a place that is none
EventTime parse_event_time(std::string_view text);

/// The local day that is meant: that of the text, else `given` (`--date`).
/// @throws Error (BadInput) where there is neither, or both and they differ, or no zone
TimeSpan day_of(const EventTime& time, const std::optional<Date>& given,
                const std::optional<Zone>& zone);

/// The time in which a day's events are looked for: from half a day before the noon of the local
/// day to half a day after it, so that its evening may end after midnight. By clocks that do not
/// have noon between 8 and 16 h, as those of another place, it is the local day itself.
/// @throws Error (BadInput) as day_of
TimeSpan span_of_events(const EventTime& time, const std::optional<Date>& given,
                        const std::optional<Zone>& zone, const geo::Geodetic& place);

/// The moment of an event other than first and last light.
/// @throws Error (BadInput) as day_of, where there is no place, and where the event does not happen
///     on that day
ParsedTime resolve(const EventTime& time, const std::optional<Date>& given,
                   const std::optional<Zone>& zone);

}  // namespace relevo::sun
