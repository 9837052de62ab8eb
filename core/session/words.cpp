#include "session/words.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "sun/zone.h"

namespace relevo::session {

bool needs_dem(const scene::Moment& moment) {
    if (!sun::is_event_time(moment.time)) return false;
    const sun::EventTime event = sun::parse_event_time(moment.time);
    return !event.event || !event.place;
}

sun::ParsedTime parse(const scene::Moment& moment, const light::TerrainAccess& dem,
                      const std::optional<geo::PlaceText>& here) {
    std::optional<sun::Zone> in_zone;
    if (!moment.zone.empty()) in_zone = sun::Zone::named(moment.zone);
    std::optional<sun::Date> on_date;
    if (!moment.date.empty()) {
        if (!sun::is_event_time(moment.time))
            bad_usage(
                "--date: goes with an event in --time, such as sunrise@46.55,8.56; a time of "
                "day is written 2026-06-21T18:30");
        on_date = sun::parse_date(moment.date);
    }
    sun::ParsedTime parsed = light::parse_time(moment.time, on_date, in_zone, dem, here);
    if (!parsed.note.empty()) log::info(parsed.note);
    return parsed;
}

sun::ParsedTime parse_over(const scene::Moment& moment, const dem::Source& source,
                           const dem::Heightfield& loaded) {
    std::optional<dem::Posts> posts;
    return parse(moment, {.middle = [&] { return source.grid().center(); },
                          .posts = [&]() -> const dem::Posts& {
                              if (loaded.reduction == 1)
                                  posts.emplace(loaded);
                              else  // as many again as the means, while this is computed
                                  posts.emplace(source,
                                                static_cast<std::int64_t>(loaded.height_m.size()));
                              return *posts;
                          }});
}

sun::Refraction refraction_at(const std::string& model, const geo::Geodetic& place) {
    if (model == "none") return sun::Refraction::none();
    if (model == "saemundsson") return sun::Refraction::saemundsson();
    return sun::Refraction::standard(place);
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
