#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "geo/geodetic.h"
#include "light/point/doubt.h"
#include "sun/events.h"
#include "sun/zone.h"

/// Parts of the JSON of figures at a place. `Json` is nlohmann::ordered_json, which no header of
/// core shows.
namespace relevo::report {

/// An angle in degrees, rounded to 0.04 milliarcseconds: 236.9, not 236.89999999999998.
inline double angle_deg(double angle_rad) {
    return std::round(degrees(angle_rad) * 1e8) / 1e8;
}

/// A JSON object that begins with its shape: "relevo-sun-day-1". The number rises when a key goes
/// or changes its meaning.
template <typename Json>
Json json_of_shape(std::string_view name) {
    return {{"schema", "relevo-" + std::string(name) + "-1"}};
}

/// "46.55,8.56" as --at takes it, whole.
template <typename Json>
Json place_json(const geo::Geodetic& place) {
    return {{"lat_deg", angle_deg(place.lat_rad)},
            {"lon_deg", angle_deg(place.lon_rad)},
            {"height_m", place.height_m}};
}

/// Puts `assumptions` into an object, where there is one.
template <typename Json>
void add_assumption(Json& json, const std::string& assumption) {
    if (!assumption.empty()) json["assumptions"] = {assumption};
}

/// The time in UTC with milliseconds, or null.
template <typename Json>
Json utc_json(const std::optional<sun::Instant>& utc) {
    if (!utc) return nullptr;
    return sun::to_iso(*utc, 3);
}

template <typename Json>
Json sectors_json(const std::vector<light::Sector>& sectors) {
    Json array = Json::array();
    for (const light::Sector& s : sectors)
        array.push_back({{"from_azimuth_deg", angle_deg(s.from_azimuth_rad)},
                         {"to_azimuth_deg", angle_deg(s.to_azimuth_rad)}});
    return array;
}

template <typename Json>
Json spans_json(const std::vector<sun::TimeSpan>& spans) {
    Json array = Json::array();
    for (const sun::TimeSpan& span : spans)
        array.push_back(
            {{"begin_utc", utc_json<Json>(span.begin)}, {"end_utc", utc_json<Json>(span.end)}});
    return array;
}

/// [{kind, utc, local, azimuth_deg, elevation_deg}].
template <typename Json>
Json events_json(const std::vector<sun::Event>& events, const sun::Zone& zone) {
    Json json = Json::array();
    for (const sun::Event& event : events)
        json.push_back({{"kind", sun::name_of(event.kind)},
                        {"utc", utc_json<Json>(event.utc)},
                        {"local", sun::to_iso(event.utc, zone)},
                        {"azimuth_deg", angle_deg(event.azimuth_rad)},
                        {"elevation_deg", angle_deg(event.elevation_rad)}});
    return json;
}

}  // namespace relevo::report
