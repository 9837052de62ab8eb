#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "cli/day_parts.h"
#include "cli/day_verb.h"
#include "cli/sun.h"
#include "geo/format.h"
#include "sun/moon_events.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;
using sun::EventKind;

constexpr EventKind kMoonKinds[] = {EventKind::Moonrise, EventKind::Transit, EventKind::Moonset,
                                    EventKind::LowerTransit};
constexpr const char* kPhases =
    "phases: the moon's apparent geocentric ecliptic longitude is 0, 90, 180 or 270 degrees more "
    "than the sun's; illuminated fraction: at the middle of the local day";

/// All figures of the verb, before they are written as text, CSV or JSON.
struct MoonDayResult {
    geo::Geodetic place;
    DaysArguments::Days asked;
    std::string definition;
    std::vector<sun::MoonDay> days;
    std::vector<light::LightDay> light;  ///< of the same days; empty without a DEM
    std::string light_definition, horizon_definition;
    light::Doubt doubt;
};

const char* all_day_of(const sun::MoonDay& day) {
    return day.moon == sun::Crossing::AboveAllDay   ? "up"
           : day.moon == sun::Crossing::BelowAllDay ? "down"
                                                    : nullptr;
}

ordered_json first_json(const sun::MoonDay& day, EventKind kind) {
    for (const sun::Event& event : day.events)
        if (event.kind == kind) return utc_json(event.utc);
    return nullptr;
}

ordered_json day_json(const MoonDayResult& result, std::size_t i) {
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
                          {"utc", utc_json(phase.utc)},
                          {"local", sun::to_iso(phase.utc, result.asked.zone)}});
    json["events"] = events_json(day.events, result.asked.zone);
    if (!result.light.empty()) {
        json["direct_moonlight"] = lit_json(result.light[i].lit);
        json["direct_moonlight_h"] = result.light[i].lit_s / 3600;
        if (!result.doubt.holes.empty()) json["not_known_h"] = result.light[i].not_known_s / 3600;
    }
    return json;
}

ordered_json json_of(const MoonDayResult& result) {
    ordered_json json;
    json["place"] = place_json(result.place);
    json["zone"] = result.asked.zone.name();
    add_assumption(json, result.asked.assumption);
    json["definition"] = result.definition;
    json["phase_definition"] = kPhases;
    if (!result.light.empty()) {
        json["light_definition"] = result.light_definition;
        json["horizon_definition"] = result.horizon_definition;
    }
    if (!result.doubt.holes.empty()) json["hole_sectors"] = sectors_json(result.doubt.holes);
    if (result.asked.single) {
        json.update(day_json(result, 0));
        return json;
    }
    ordered_json& days = json["days"] = ordered_json::array();
    for (std::size_t i = 0; i < result.days.size(); ++i)
        days.push_back(day_json(result, i));
    return json;
}

/// The columns of a day. @param light  of the terrain @param holes  what is not known for holes
std::string moon_columns(bool light, bool holes) {
    std::string text = "date,all_day";
    for (const EventKind kind : kMoonKinds)
        text += fmt::format(",{}", sun::name_of(kind));
    text += ",moon_up_h,illuminated_fraction,phase,phase_time";
    if (light) text += ",direct_moonlight,direct_moonlight_h";
    if (holes) text += ",not_known,not_known_h";
    return text;
}

std::string row_of(const MoonDayResult& result, std::size_t i, bool holes) {
    const sun::Zone& zone = result.asked.zone;
    const sun::MoonDay& day = result.days[i];
    const char* all_day = all_day_of(day);
    std::string text = sun::to_string(day.date) + "," + (all_day ? all_day : "");
    for (const EventKind kind : kMoonKinds) {
        std::string times;
        for (const sun::Event& event : day.events)
            if (event.kind == kind)
                times += (times.empty() ? "" : ";") + sun::to_iso(event.utc, zone);
        text += "," + times;
    }
    text += fmt::format(",{:.4f},{:.4f},{},{}", day.moon_up_s / 3600, day.illuminated_fraction,
                        sun::phase_name(day.phase_longitude_rad),
                        day.phases.empty() ? "" : sun::to_iso(day.phases.front().utc, zone));
    if (!result.light.empty())
        text += fmt::format(",{},{:.4f}", spans_of(result.light[i].lit, zone),
                            result.light[i].lit_s / 3600);
    if (!holes) return text;
    return text + fmt::format(",{},{:.4f}", spans_of(not_known_of(result.light[i].lit), zone),
                              result.light[i].not_known_s / 3600);
}

std::vector<std::string> rows_of(const MoonDayResult& result, bool holes) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < result.days.size(); ++i)
        rows.push_back(row_of(result, i, holes));
    return rows;
}

/// What the figures mean.
std::vector<std::string> definitions_of(const MoonDayResult& result) {
    std::vector<std::string> definitions{result.definition, kPhases};
    if (!result.light.empty()) {
        definitions.push_back(result.light_definition);
        definitions.push_back(result.horizon_definition);
    }
    if (!result.doubt.holes.empty())
        definitions.push_back(not_known_text(result.doubt, "direct moonlight"));
    return definitions;
}

std::string csv_of(const MoonDayResult& result) {
    const bool holes = !result.doubt.holes.empty();
    std::string text =
        csv_remarks(definitions_of(result)) + moon_columns(!result.light.empty(), holes) + "\n";
    for (const std::string& row : rows_of(result, holes))
        text += row + "\n";
    return text;
}

void print_definitions(const MoonDayResult& result) {
    fmt::print("\n");
    for (const std::string& definition : definitions_of(result))
        fmt::print("{}\n", definition);
}

void print_day(const MoonDayResult& result) {
    const sun::MoonDay& day = result.days.front();
    const sun::Zone& zone = result.asked.zone;
    fmt::print("date                {}, {}\n", sun::to_string(day.date), zone.name());
    print_events(day.events, zone);
    if (const char* all_day = all_day_of(day))
        fmt::print("all day             the moon stays {}\n", all_day);
    fmt::print("up                  {}\n", hours_text(day.moon_up_s));
    fmt::print("phase               {}, {:.1f} % illuminated\n",
               sun::phase_name(day.phase_longitude_rad), 100 * day.illuminated_fraction);
    for (const sun::PhaseTime& phase : day.phases)
        fmt::print("{:<20}{}\n", sun::name_of(phase.phase), sun::to_iso(phase.utc, zone));
    if (!result.light.empty()) print_lit(result.light.front(), "moonlight", zone);
}

void print_days(const MoonDayResult& result) {
    const sun::Zone& zone = result.asked.zone;
    const bool lit = !result.light.empty();
    fmt::print("dates               {} to {}, {}\n", sun::to_string(result.asked.first),
               sun::to_string(result.asked.last), zone.name());
    fmt::print("\n{:<12}{:<10}{:<10}{:<10}{:>10}{:>8}  {:<24}{}\n", "date", "moonrise", "transit",
               "moonset", "up", "disc", "phase", lit ? "moonlight" : "");
    for (std::size_t i = 0; i < result.days.size(); ++i) {
        const sun::MoonDay& day = result.days[i];
        fmt::print("{:<12}", sun::to_string(day.date));
        for (const EventKind kind : {EventKind::Moonrise, EventKind::Transit, EventKind::Moonset}) {
            std::string time = "-";
            for (const sun::Event& event : day.events)
                if (event.kind == kind && time == "-") time = clock_text(event.utc, zone);
            fmt::print("{:<10}", time);
        }
        const std::string phase = day.phases.empty()
                                      ? std::string(sun::phase_name(day.phase_longitude_rad))
                                      : fmt::format("{} {}", name_of(day.phases.front().phase),
                                                    clock_text(day.phases.front().utc, zone));
        fmt::print("{:>10}{:>6.0f} %  {:<24}", hours_text(day.moon_up_s),
                   100 * day.illuminated_fraction, phase);
        if (lit) fmt::print("{}", hours_text(result.light[i].lit_s));
        fmt::print("\n");
    }
}

void print_text(const MoonDayResult& result) {
    fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(result.place),
               result.place.height_m);
    result.asked.single ? print_day(result) : print_days(result);
    print_definitions(result);
}

/// @param posts  null without a DEM
MoonDayResult result_at(const DayArguments& arguments, const DaysArguments::Days& asked,
                        const geo::PlaceText& at, const dem::Posts* posts) {
    const std::optional<double>& eye_height_m = arguments.place.eye_height_m;
    if (!posts) check_has_ground(at);
    MoonDayResult result;
    result.asked = asked;
    result.place = at.place;
    if (posts) {
        const light::TerrainHorizon horizon(*posts, at.place,
                                            arguments.terrain.horizon(at, eye_height_m));
        result.place = horizon.place();
        const light::DirectLight direct(horizon, arguments.light.light(result.place, eye_height_m));
        result.light = direct.days(asked.first, asked.last, asked.zone);
        result.doubt = light::doubt_of(direct, result.light, horizon.profile(kDoubtDirections),
                                       arguments.terrain.highest_m);
        result.light_definition = direct.definition() + "; at any phase, and by day too";
        result.horizon_definition = horizon.description();
    }
    const sun::RiseRule rule = arguments.light.rule(result.place, eye_height_m);
    result.definition = rule.description();
    result.days = sun::moon_days(asked.first, asked.last, asked.zone, result.place, rule);
    return result;
}

void run(const DayArguments& arguments) {
    const auto forms = [&](const DaysArguments::Days& asked, const geo::PlaceText& at,
                           const dem::Posts* posts) {
        const auto result =
            std::make_shared<const MoonDayResult>(result_at(arguments, asked, at, posts));
        return DayForms{.point = {.rows = [=] { return rows_of(*result, posts != nullptr); },
                                  .json = [=] { return json_of(*result); },
                                  .doubt = result->doubt},
                        .csv = [=] { return csv_of(*result); },
                        .print = [=] { print_text(*result); }};
    };
    run_days(arguments, {.columns = [](bool terrain) { return moon_columns(terrain, terrain); },
                         .remarks = {kPhases},
                         .forms = forms});
}

}  // namespace

void add_moon_day(Verb moon_verb) {
    const auto arguments = std::make_shared<DayArguments>();
    arguments->light.body = sun::Body::Moon;
    const Verb verb = moon_verb.add_verb(
        "day", "Moonrise, transit, moonset, phase; with a DEM also direct moonlight");
    arguments->add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run(*arguments); });
}

}  // namespace relevo::cli
