#include "session/words.h"

#include <functional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "sun/event_time.h"
#include "sun/zone.h"

namespace relevo::session {

namespace {

/// A time's words, parsed as far as possible without a place.
struct ReadTime {
    std::optional<sun::Date> date;
    std::optional<sun::EventTime> event;  ///< nullopt: a time of day
    std::optional<sun::Zone> zone;        ///< if given by name
    bool zone_by_place = false;           ///< needs a zone that depends on the place
};

ReadTime read(const scene::TimeSpec& spec) {
    ReadTime result;
    const bool named = !sun::is_zone_by_place(spec.zone);
    if (named) result.zone = sun::Zone::named(spec.zone);
    if (!sun::is_event_time(spec.at)) {
        if (!spec.date.empty())
            bad_usage(
                "--date: needs an event in --time, such as sunrise@46.55,8.56; write a time of day "
                "as 2026-06-21T18:30");
        result.zone_by_place =
            !named && (sun::is_wall_time(spec.at) || sun::is_solar_zone(spec.zone));
        return result;
    }
    if (!spec.date.empty()) result.date = sun::parse_date(spec.date);
    result.event = sun::parse_event_time(spec.at);
    result.zone_by_place = !named;
    // Checks the day before anything is loaded; whether there is one is independent of the zone.
    sun::day_of(*result.event, result.date, result.zone.value_or(sun::Zone()));
    return result;
}

std::optional<geo::Geodetic> place_of_zone(const ReadTime& words, const light::TerrainAccess& dem,
                                           const std::optional<geo::PlaceText>& here) {
    if (words.event && words.event->place) return words.event->place->place;
    if (here) return here->place;
    if (dem.middle) return dem.middle();
    return std::nullopt;
}

}  // namespace

sun::ChosenZone zone_of(const std::string& words, const geo::Geodetic& place) {
    sun::ChosenZone chosen = sun::choose_zone(words, place);
    const std::string notice = chosen.assumption + "; --tz sets another";
    if (chosen.missing)
        log::warning(notice);
    else if (!chosen.assumption.empty())
        log::info(notice);
    return chosen;
}

bool needs_dem(const scene::TimeSpec& spec) {
    const ReadTime words = read(spec);
    if (words.event) return !words.event->event || !words.event->place;
    return words.zone_by_place;
}

namespace {

using ChooseZone = std::function<sun::ChosenZone(const std::string&, const geo::Geodetic&)>;

sun::ParsedTime parse_with(const ChooseZone& choose, const scene::TimeSpec& spec,
                           const light::TerrainAccess& dem,
                           const std::optional<geo::PlaceText>& here) {
    ReadTime words = read(spec);
    std::string assumption;
    if (const auto place = place_of_zone(words, dem, here); place && words.zone_by_place) {
        sun::ChosenZone chosen = choose(spec.zone, *place);
        words.zone = std::move(chosen.zone);
        assumption = std::move(chosen.assumption);
    }
    sun::ParsedTime parsed = light::parse_time(spec.at, words.date, words.zone, dem, here);
    parsed.assumption = std::move(assumption);
    return parsed;
}

}  // namespace

sun::ParsedTime parse(const scene::TimeSpec& spec, const light::TerrainAccess& dem,
                      const std::optional<geo::PlaceText>& here) {
    sun::ParsedTime parsed = parse_with(zone_of, spec, dem, here);
    if (!parsed.note.empty()) log::info(parsed.note);
    return parsed;
}

sun::ParsedTime parse_quietly(const scene::TimeSpec& spec, const light::TerrainAccess& dem,
                              const std::optional<geo::PlaceText>& here) {
    return parse_with(sun::choose_zone, spec, dem, here);
}

sun::ParsedTime parse_over(const scene::TimeSpec& spec, const dem::Source& source,
                           const dem::Heightfield& loaded) {
    std::optional<dem::Posts> posts;
    return parse(spec, {.middle = [&] { return source.grid().center(); },
                        .posts = [&]() -> const dem::Posts& {
                            if (loaded.reduction == 1)
                                posts.emplace(loaded);
                            else  // at most as many posts as the means have
                                posts.emplace(source,
                                              static_cast<std::int64_t>(loaded.height_m.size()));
                            return *posts;
                        }});
}

std::string sun_text(const sun::Position& position, const sun::Refraction& air) {
    const double elevation_deg = degrees(position.elevation_rad);
    return fmt::format(
        "azimuth {:.2f}, elevation {:.2f} ({})", degrees(position.azimuth_rad), elevation_deg,
        elevation_deg < -2 ? "below the horizon"
                           : fmt::format("{:.2f} with refraction",
                                         degrees(air.apparent_rad(position.elevation_rad))));
}

}  // namespace relevo::session
