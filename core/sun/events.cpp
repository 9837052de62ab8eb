#include "sun/events.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/error.h"
#include "sun/sky_path.h"

namespace relevo::sun {

namespace {

constexpr double kCivil_rad = radians(-6.0);
constexpr double kNautical_rad = radians(-12.0);
constexpr double kAstronomical_rad = radians(-18.0);
// Golden and blue hour are given by the centre's true elevation; photographers do not agree.
constexpr double kGoldenFrom_rad = radians(-4.0), kGoldenTo_rad = radians(6.0);
constexpr double kBlueFrom_rad = radians(-6.0), kBlueTo_rad = radians(-4.0);

/// What of `spans` is in none of `others`.
std::vector<TimeSpan> without(const std::vector<TimeSpan>& spans,
                              const std::vector<TimeSpan>& others) {
    std::vector<TimeSpan> left;
    for (TimeSpan span : spans) {
        for (const TimeSpan& other : others) {
            if (other.end <= span.begin || other.begin >= span.end) continue;
            if (other.begin > span.begin) left.push_back({span.begin, other.begin});
            span.begin = std::min(other.end, span.end);
        }
        if (span.begin < span.end) left.push_back(span);
    }
    return left;
}

}  // namespace

std::string_view name_of(EventKind kind) {
    constexpr std::array<std::string_view, 12> kNames = {
        "astronomical_dawn", "nautical_dawn", "civil_dawn", "sunrise",
        "transit",           "sunset",        "civil_dusk", "nautical_dusk",
        "astronomical_dusk", "lower_transit", "moonrise",   "moonset"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::optional<Instant> Day::first(EventKind kind) const {
    for (const Event& event : events)
        if (event.kind == kind) return event.utc;
    return std::nullopt;
}

std::vector<Instant> Day::all(EventKind kind) const {
    std::vector<Instant> times;
    for (const Event& event : events)
        if (event.kind == kind) times.push_back(event.utc);
    return times;
}

Day day_events(const PositionTable& table, const TimeSpan& span, const Observer& observer,
               const DayOptions& options) {
    const SkyPath path(table, span, observer);
    Day day;
    day.span = span;
    day.definition = options.rule.description();

    const Crossings sun = path.crossings(
        [&](double distance_au) { return options.rule.center_elevation_rad(distance_au); });
    const Crossings civil = path.crossings(kCivil_rad);
    const Crossings nautical = path.crossings(kNautical_rad);
    const Crossings astronomical = path.crossings(kAstronomical_rad);
    path.add(day.events, EventKind::Sunrise, EventKind::Sunset, sun);
    path.add(day.events, EventKind::CivilDawn, EventKind::CivilDusk, civil);
    path.add(day.events, EventKind::NauticalDawn, EventKind::NauticalDusk, nautical);
    path.add(day.events, EventKind::AstronomicalDawn, EventKind::AstronomicalDusk, astronomical);
    path.add_transits(day.events);
    std::ranges::sort(day.events, [](const Event& a, const Event& b) { return a.utc < b.utc; });
    day.sun = sun.state;
    day.civil = civil.state;
    day.nautical = nautical.state;
    day.astronomical = astronomical.state;
    day.sun_up = sun.above;
    for (const TimeSpan& up : sun.above)
        day.day_length_s += up.length_s();
    day.golden_hour =
        without(path.crossings(kGoldenFrom_rad).above, path.crossings(kGoldenTo_rad).above);
    day.blue_hour = without(path.crossings(kBlueFrom_rad).above, path.crossings(kBlueTo_rad).above);
    return day;
}

Day day_events(Date date, const Zone& zone, const geo::Geodetic& place, const DayOptions& options,
               const EarthRotation& rotation) {
    const Observer observer(place);
    const TimeSpan span = zone.day(date);
    Day day = day_events(PositionTable(span.begin, span.end, rotation), span, observer, options);
    day.date = date;
    return day;
}

std::vector<Day> day_events(Date first, Date last, const Zone& zone, const geo::Geodetic& place,
                            const DayOptions& options, const EarthRotation& rotation) {
    const std::vector<LocalDay> local = local_days(first, last, zone);
    std::vector<Day> days;
    if (local.empty()) return days;
    const Observer observer(place);
    const PositionTable table(local.front().span.begin, local.back().span.end, rotation);
    for (const LocalDay& day : local) {
        days.push_back(day_events(table, day.span, observer, options));
        days.back().date = day.date;
    }
    return days;
}

}  // namespace relevo::sun
