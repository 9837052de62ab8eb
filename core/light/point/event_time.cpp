#include "light/point/event_time.h"

#include <fmt/format.h>

#include "base/error.h"
#include "light/point/direct_light.h"

namespace relevo::light {

sun::ParsedTime parse_time(std::string_view text, const std::optional<sun::Date>& date,
                           const std::optional<sun::Zone>& zone, const TerrainAccess& dem,
                           const std::optional<geo::PlaceText>& here) {
    if (!sun::is_event_time(text)) return sun::parse_time(text, zone);
    sun::EventTime time = sun::parse_event_time(text);
    sun::day_of(time, date, zone);  // says what is missing before any work is done
    if (!time.place) time.place = here;
    if (!time.place && dem.middle) time.place = geo::PlaceText{dem.middle()};
    if (time.event || !dem.posts) return sun::resolve(time, date, zone);

    HorizonOptions options;
    options.eye_height_m = time.place->place.height_m;
    options.eye_above_ground = time.place->above_ground || !time.place->has_height;
    const TerrainHorizon horizon(dem.posts(), time.place->place, options);
    const sun::Date of = time.date ? *time.date : *date;
    const std::vector<LitInterval> lit =
        DirectLight(horizon).lit_within(sun::span_of_events(time, date, zone, horizon.place()));
    if (lit.empty())
        bad_input(fmt::format("time: {}: the sun does not reach that point on {}", time.text,
                              sun::to_string(of)));
    const LightEdge& edge = time.last ? lit.back().end : lit.front().begin;
    if (edge.midnight)
        bad_input(
            fmt::format("time: {}: no {} light on {}, the sun shines there at "
                        "midnight",
                        time.text, time.last ? "last" : "first", sun::to_string(of)));
    sun::ParsedTime result;
    result.utc = edge.utc + time.offset_s;
    result.zone = *zone;
    return result;
}

}  // namespace relevo::light
