#include "report/days.h"

#include <functional>

#include <nlohmann/json.hpp>

#include "report/doubts.h"
#include "report/json_parts.h"
#include "sun/seasons.h"

namespace relevo::report {
namespace {

using nlohmann::ordered_json;
using sun::EventKind;

constexpr EventKind kSunKinds[] = {EventKind::AstronomicalDawn, EventKind::NauticalDawn,
                                   EventKind::CivilDawn,        EventKind::Sunrise,
                                   EventKind::Transit,          EventKind::Sunset,
                                   EventKind::CivilDusk,        EventKind::NauticalDusk,
                                   EventKind::AstronomicalDusk, EventKind::LowerTransit};
constexpr const char* kTwilights =
    "twilights: centre of the sun 6 (civil), 12 (nautical), 18 (astronomical) degrees below the "
    "level horizon; golden hour: centre from 4 below to 6 above; blue hour: from 6 to 4 below; all "
    "without refraction";

constexpr EventKind kMoonKinds[] = {EventKind::Moonrise, EventKind::Transit, EventKind::Moonset,
                                    EventKind::LowerTransit};
constexpr const char* kPhases =
    "phases: the moon's apparent geocentric ecliptic longitude is 0, 90, 180 or 270 degrees more "
    "than the sun's; illuminated fraction: at the middle of the local day";

ordered_json lit_json(const std::vector<light::LitInterval>& lit) {
    ordered_json json = ordered_json::array();
    for (const light::LitInterval& interval : lit) {
        json.push_back({{"first_utc", utc_json<ordered_json>(interval.begin.utc)},
                        {"last_utc", utc_json<ordered_json>(interval.end.utc)},
                        {"first_azimuth_deg", angle_deg(interval.begin.azimuth_rad)},
                        {"last_azimuth_deg", angle_deg(interval.end.azimuth_rad)},
                        {"first_apparent_elevation_deg", angle_deg(interval.begin.elevation_rad)},
                        {"last_apparent_elevation_deg", angle_deg(interval.end.elevation_rad)},
                        {"from_midnight", interval.begin.midnight},
                        {"to_midnight", interval.end.midnight}});
        if (!interval.not_known.empty())
            json.back()["not_known"] = spans_json<ordered_json>(interval.not_known);
    }
    return json;
}

/// Finds place, definitions and light.
/// @param horizon  null without a DEM
/// @returns what the light is found with; none without a DEM
std::optional<light::DirectLight> find_light(const View& view, const geo::PlaceText& at,
                                             const light::TerrainHorizon* horizon,
                                             DayResult& result) {
    if (!horizon) check_has_ground(at);
    result.place = horizon ? horizon->place() : at.place;
    result.definition = view.rule(result.place).description();
    if (!horizon) return {};
    light::DirectLight direct(*horizon, view.light(result.place));
    result.light = direct.days(result.asked.first, result.asked.last, result.asked.zone);
    result.doubt =
        light::doubt_of(direct, result.light, horizon->profile(kDoubtDirections), view.highest_m);
    result.light_definition = direct.definition();
    result.horizon_definition = horizon->description();
    return direct;
}

/// @param day_json  of one, by its number, without light
ordered_json days_json(const DayResult& result, std::size_t days,
                       const std::function<ordered_json(std::size_t)>& day_json) {
    auto json = json_of_shape<ordered_json>(fmt::format("{}-day", result.words.body));
    json["place"] = place_json<ordered_json>(result.place);
    json["zone"] = result.asked.zone.name();
    add_assumption(json, result.asked.assumption);
    json["definition"] = result.definition;
    json[result.words.key] = result.words.definition;
    if (!result.light.empty()) {
        json["light_definition"] = result.light_definition;
        json["horizon_definition"] = result.horizon_definition;
    }
    if (result.has_holes()) json["hole_sectors"] = sectors_json<ordered_json>(result.doubt.holes);
    const auto with_light = [&](std::size_t i) {
        ordered_json day = day_json(i);
        if (result.light.empty()) return day;
        const std::string key = result.words.light;
        day[key] = lit_json(result.light[i].lit);
        const light::LightDay& light = result.light[i];
        day[key + "_h"] = light.lit_s / 3600;
        const bool is_lit = !light.lit.empty();
        const auto utc = [](sun::Instant at) { return utc_json<ordered_json>(at); };
        day[fmt::format("first_{}_utc", result.words.body)] =
            is_lit ? utc(light.lit.front().begin.utc) : ordered_json();
        day[fmt::format("last_{}_utc", result.words.body)] =
            is_lit ? utc(light.lit.back().end.utc) : ordered_json();
        day["minutes"] = light.lit_s / 60;
        if (result.has_holes()) day["not_known_h"] = result.light[i].not_known_s / 3600;
        return day;
    };
    ordered_json& all = json["days"] = ordered_json::array();
    for (std::size_t i = 0; i < days; ++i)
        all.push_back(with_light(i));
    return json;
}

ordered_json sun_json(const SunDays& result, std::size_t i) {
    const sun::Day& day = result.days[i];
    ordered_json json;
    json["date"] = sun::to_string(day.date);
    const char* polar = polar_of(day);
    json["polar"] = polar ? ordered_json(polar) : ordered_json();
    for (const EventKind kind : kSunKinds)
        json[std::string(sun::name_of(kind)) + "_utc"] = utc_json<ordered_json>(day.first(kind));
    json["day_length_h"] = day.day_length_s / 3600;
    json["golden_hour"] = spans_json<ordered_json>(day.golden_hour);
    json["blue_hour"] = spans_json<ordered_json>(day.blue_hour);
    json["events"] = events_json<ordered_json>(day.events, result.asked.zone);
    return json;
}

ordered_json seasons_json(int year) {
    const sun::Seasons s = sun::seasons(year);
    return {{"year", year},
            {"march_equinox_utc", utc_json<ordered_json>(s.march_equinox)},
            {"june_solstice_utc", utc_json<ordered_json>(s.june_solstice)},
            {"september_equinox_utc", utc_json<ordered_json>(s.september_equinox)},
            {"december_solstice_utc", utc_json<ordered_json>(s.december_solstice)}};
}

ordered_json first_json(const sun::MoonDay& day, EventKind kind) {
    for (const sun::Event& event : day.events)
        if (event.kind == kind) return utc_json<ordered_json>(event.utc);
    return nullptr;
}

ordered_json moon_json(const MoonDays& result, std::size_t i) {
    const sun::MoonDay& day = result.days[i];
    ordered_json json;
    json["date"] = sun::to_string(day.date);
    const char* all_day = all_day_of(day);
    json["all_day"] = all_day ? ordered_json(all_day) : ordered_json();
    for (const EventKind kind : kMoonKinds)
        json[std::string(sun::name_of(kind)) + "_utc"] = first_json(day, kind);
    json["moon_up_h"] = day.moon_up_s / 3600;
    json["illuminated_fraction"] = day.illuminated_fraction;
    json["phase"] = sun::phase_name(day.phase_longitude_rad);
    ordered_json& phases = json["phases"] = ordered_json::array();
    for (const sun::PhaseTime& phase : day.phases)
        phases.push_back({{"phase", sun::name_of(phase.phase)},
                          {"utc", utc_json<ordered_json>(phase.utc)},
                          {"local", sun::to_iso(phase.utc, result.asked.zone)}});
    json["events"] = events_json<ordered_json>(day.events, result.asked.zone);
    return json;
}

}  // namespace

const DayWords kSunWords{"direct_sun",
                         "sun",
                         "twilight_definition",
                         kTwilights,
                         "date,polar",
                         kSunKinds,
                         ",day_length_h,golden_hour,blue_hour"};

const DayWords kMoonWords{"direct_moonlight",
                          "moon",
                          "phase_definition",
                          kPhases,
                          "date,all_day",
                          kMoonKinds,
                          ",moon_up_h,illuminated_fraction,phase,phase_time"};

const char* polar_of(const sun::Day& day) {
    return day.sun == sun::Crossing::AboveAllDay   ? "day"
           : day.sun == sun::Crossing::BelowAllDay ? "night"
                                                   : nullptr;
}

const char* all_day_of(const sun::MoonDay& day) {
    return day.moon == sun::Crossing::AboveAllDay   ? "up"
           : day.moon == sun::Crossing::BelowAllDay ? "down"
                                                    : nullptr;
}

std::vector<sun::TimeSpan> not_known_of(const std::vector<light::LitInterval>& lit) {
    std::vector<sun::TimeSpan> spans;
    for (const light::LitInterval& interval : lit)
        spans.insert(spans.end(), interval.not_known.begin(), interval.not_known.end());
    return spans;
}

std::shared_ptr<const SunDays> sun_days(const View& view, const Days& asked,
                                        const geo::PlaceText& at, const dem::Posts* posts) {
    const auto result = std::make_shared<SunDays>(DayResult{kSunWords, asked});
    if (posts) result->horizon.emplace(*posts, at.place, view.horizon(at));
    result->direct = find_light(view, at, result->horizon ? &*result->horizon : nullptr, *result);
    sun::DayOptions options;
    options.rule = view.rule(result->place);
    if (!posts)
        result->days = sun::day_events(asked.first, asked.last, asked.zone, at.place, options);
    for (const light::LightDay& day : result->light)
        result->days.push_back(day.flat);
    return result;
}

std::shared_ptr<const MoonDays> moon_days(const View& view, const Days& asked,
                                          const geo::PlaceText& at, const dem::Posts* posts) {
    const auto result = std::make_shared<MoonDays>(DayResult{kMoonWords, asked});
    std::optional<light::TerrainHorizon> horizon;
    if (posts) horizon.emplace(*posts, at.place, view.horizon(at));
    if (find_light(view, at, horizon ? &*horizon : nullptr, *result))
        result->light_definition += "; at any phase, and by day too";
    result->days = sun::moon_days(asked.first, asked.last, asked.zone, result->place,
                                  view.rule(result->place));
    return result;
}

std::string json_of(const SunDays& result) {
    ordered_json json =
        days_json(result, result.days.size(), [&](std::size_t i) { return sun_json(result, i); });
    ordered_json& seasons = json["seasons"] = ordered_json::array();
    for (int year = result.asked.first.year; year <= result.asked.last.year; ++year)
        seasons.push_back(seasons_json(year));
    return json.dump();
}

std::string json_of(const MoonDays& result) {
    return days_json(result, result.days.size(),
                     [&](std::size_t i) { return moon_json(result, i); })
        .dump();
}

}  // namespace relevo::report
