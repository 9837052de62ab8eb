#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "chart/sun_path_diagram.h"
#include "cli/day_parts.h"
#include "cli/day_verb.h"
#include "cli/sun.h"
#include "geo/format.h"
#include "sun/position.h"
#include "sun/seasons.h"

namespace relevo::cli {
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

/// All figures of the verb, before they are written as text, CSV or JSON.
struct DayResult {
    geo::Geodetic place;
    DaysArguments::Days asked;
    std::string definition;
    std::vector<sun::Day> days;
    std::vector<light::LightDay> light;  ///< of the same days; empty without a DEM
    std::string light_definition, horizon_definition;
    light::Doubt doubt;
};

const char* polar_of(const sun::Day& day) {
    return day.sun == sun::Crossing::AboveAllDay   ? "day"
           : day.sun == sun::Crossing::BelowAllDay ? "night"
                                                   : nullptr;
}

ordered_json day_json(const DayResult& result, std::size_t i) {
    const sun::Day& day = result.days[i];
    ordered_json json;
    json["date"] = sun::to_string(day.date);
    const char* polar = polar_of(day);
    json["polar"] = polar ? ordered_json(polar) : ordered_json();
    for (const EventKind kind : kSunKinds)
        json[std::string(sun::name_of(kind)) + "_utc"] = utc_json(day.first(kind));
    json["day_length_h"] = day.day_length_s / 3600;
    json["golden_hour"] = spans_json(day.golden_hour);
    json["blue_hour"] = spans_json(day.blue_hour);
    json["events"] = events_json(day.events, result.asked.zone);
    if (!result.light.empty()) {
        json["direct_sun"] = lit_json(result.light[i].lit);
        json["direct_sun_h"] = result.light[i].lit_s / 3600;
        if (!result.doubt.holes.empty()) json["not_known_h"] = result.light[i].not_known_s / 3600;
    }
    return json;
}

ordered_json seasons_json(int year) {
    const sun::Seasons s = sun::seasons(year);
    return {{"year", year},
            {"march_equinox_utc", utc_json(s.march_equinox)},
            {"june_solstice_utc", utc_json(s.june_solstice)},
            {"september_equinox_utc", utc_json(s.september_equinox)},
            {"december_solstice_utc", utc_json(s.december_solstice)}};
}

ordered_json json_of(const DayResult& result) {
    ordered_json json;
    json["place"] = place_json(result.place);
    json["zone"] = result.asked.zone.name();
    add_assumption(json, result.asked.assumption);
    json["definition"] = result.definition;
    json["twilight_definition"] = kTwilights;
    if (!result.light.empty()) {
        json["light_definition"] = result.light_definition;
        json["horizon_definition"] = result.horizon_definition;
    }
    if (!result.doubt.holes.empty()) json["hole_sectors"] = sectors_json(result.doubt.holes);
    if (result.asked.single) {
        json.update(day_json(result, 0));
    } else {
        ordered_json& days = json["days"] = ordered_json::array();
        for (std::size_t i = 0; i < result.days.size(); ++i)
            days.push_back(day_json(result, i));
    }
    ordered_json& seasons = json["seasons"] = ordered_json::array();
    for (int year = result.asked.first.year; year <= result.asked.last.year; ++year)
        seasons.push_back(seasons_json(year));
    return json;
}

/// The columns of a day. @param light  of the terrain @param holes  what is not known for holes
std::string day_columns(bool light, bool holes) {
    std::string text = "date,polar";
    for (const EventKind kind : kSunKinds)
        text += fmt::format(",{}", sun::name_of(kind));
    text += ",day_length_h,golden_hour,blue_hour";
    if (light) text += ",direct_sun,direct_sun_h";
    if (holes) text += ",not_known,not_known_h";
    return text;
}

std::string row_of(const DayResult& result, std::size_t i, bool holes) {
    const sun::Zone& zone = result.asked.zone;
    const sun::Day& day = result.days[i];
    const char* polar = polar_of(day);
    std::string text = sun::to_string(day.date) + "," + (polar ? polar : "");
    for (const EventKind kind : kSunKinds) {
        std::string times;
        for (const sun::Instant utc : day.all(kind))
            times += (times.empty() ? "" : ";") + sun::to_iso(utc, zone);
        text += "," + times;
    }
    text += fmt::format(",{:.4f},{},{}", day.day_length_s / 3600, spans_of(day.golden_hour, zone),
                        spans_of(day.blue_hour, zone));
    if (!result.light.empty())
        text += fmt::format(",{},{:.4f}", spans_of(result.light[i].lit, zone),
                            result.light[i].lit_s / 3600);
    if (!holes) return text;
    return text + fmt::format(",{},{:.4f}", spans_of(not_known_of(result.light[i].lit), zone),
                              result.light[i].not_known_s / 3600);
}

std::vector<std::string> rows_of(const DayResult& result, bool holes) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < result.days.size(); ++i)
        rows.push_back(row_of(result, i, holes));
    return rows;
}

std::string csv_of(const DayResult& result) {
    std::vector<std::string> remarks{result.definition, kTwilights};
    if (!result.light.empty()) {
        remarks.push_back(result.light_definition);
        remarks.push_back(result.horizon_definition);
    }
    const bool holes = !result.doubt.holes.empty();
    if (holes) remarks.push_back(not_known_text(result.doubt, "direct sun"));
    std::string text = csv_remarks(remarks) + day_columns(!result.light.empty(), holes) + "\n";
    for (const std::string& row : rows_of(result, holes))
        text += row + "\n";
    return text;
}

void print_seasons(const DayResult& result) {
    for (int year = result.asked.first.year; year <= result.asked.last.year; ++year) {
        const sun::Seasons s = sun::seasons(year);
        for (const auto& [name, utc] : {std::pair{"March equinox", s.march_equinox},
                                        std::pair{"June solstice", s.june_solstice},
                                        std::pair{"September equinox", s.september_equinox},
                                        std::pair{"December solstice", s.december_solstice}}) {
            const sun::Date on = result.asked.zone.local(utc).wall.date;
            if (on >= result.asked.first && on <= result.asked.last)
                fmt::print("{:<20}{}\n", name, sun::to_iso(utc, result.asked.zone));
        }
    }
}

void print_head(const DayResult& result) {
    fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(result.place),
               result.place.height_m);
    if (result.asked.single)
        fmt::print("date                {}, {}\n", sun::to_string(result.asked.first),
                   result.asked.zone.name());
    else
        fmt::print("dates               {} to {}, {}\n", sun::to_string(result.asked.first),
                   sun::to_string(result.asked.last), result.asked.zone.name());
}

void print_definitions(const DayResult& result) {
    fmt::print("\n{}\n{}\n", result.definition, kTwilights);
    if (!result.light.empty())
        fmt::print("{}\n{}\n", result.light_definition, result.horizon_definition);
    if (!result.doubt.holes.empty()) fmt::print("{}\n", not_known_text(result.doubt, "direct sun"));
}

void print_day(const DayResult& result) {
    const sun::Day& day = result.days.front();
    const sun::Zone& zone = result.asked.zone;
    print_head(result);
    print_events(day.events, zone);
    if (const char* polar = polar_of(day))
        fmt::print("polar {:<14}the sun {} all day\n", polar,
                   day.sun == sun::Crossing::AboveAllDay ? "stays up" : "stays down");
    for (const auto& [name, down_deg, crossing] :
         {std::tuple{"civil twilight", 6, day.civil},
          std::tuple{"nautical twilight", 12, day.nautical},
          std::tuple{"astron. twilight", 18, day.astronomical}}) {
        if (crossing == sun::Crossing::BelowAllDay)
            fmt::print("{:<20}none, the sun's centre stays more than {} degrees down all day\n",
                       name, down_deg);
        else if (crossing == sun::Crossing::AboveAllDay && day.sun != crossing)
            fmt::print("{:<20}the sun's centre stays less than {} degrees down all day\n", name,
                       down_deg);
    }
    fmt::print("day length          {}\n", hours_text(day.day_length_s));
    fmt::print("golden hour         {}\n", spans_text(day.golden_hour, zone));
    fmt::print("blue hour           {}\n", spans_text(day.blue_hour, zone));
    if (!result.light.empty()) print_lit(result.light.front(), "direct sun", zone);
    print_seasons(result);
    print_definitions(result);
}

void print_days(const DayResult& result) {
    const sun::Zone& zone = result.asked.zone;
    print_head(result);
    const bool lit = !result.light.empty();
    fmt::print("\n{:<12}{:<10}{:<10}{:<10}{:<10}{:<10}{:>10}{}\n", "date", "civ. dawn", "sunrise",
               "transit", "sunset", "civ. dusk", "day", lit ? "  direct sun" : "");
    for (std::size_t i = 0; i < result.days.size(); ++i) {
        const sun::Day& day = result.days[i];
        fmt::print("{:<12}", sun::to_string(day.date));
        for (const EventKind kind : {EventKind::CivilDawn, EventKind::Sunrise, EventKind::Transit,
                                     EventKind::Sunset, EventKind::CivilDusk}) {
            const auto utc = day.first(kind);
            fmt::print("{:<10}", utc ? clock_text(*utc, zone) : "-");
        }
        fmt::print("{:>10}", hours_text(day.day_length_s));
        if (lit) {
            fmt::print("  {:>8}", hours_text(result.light[i].lit_s));
            for (const light::LitInterval& interval : result.light[i].lit)
                fmt::print("  {}-{}", clock_text(interval.begin.utc, zone),
                           interval.end.midnight ? "24:00:00" : clock_text(interval.end.utc, zone));
            fmt::print("{}", not_known_text(result.light[i]));
        }
        if (const char* polar = polar_of(day)) fmt::print("  polar {}", polar);
        fmt::print("\n");
    }
    fmt::print("\n");
    print_seasons(result);
    print_definitions(result);
}

/// The days of a place without terrain.
void add_days(const DayArguments& arguments, const geo::PlaceText& at, DayResult& result) {
    check_has_ground(at);
    result.place = at.place;
    sun::DayOptions options;
    options.rule = arguments.light.rule(at.place, arguments.place.eye_height_m);
    result.days = sun::day_events(result.asked.first, result.asked.last, result.asked.zone,
                                  at.place, options);
    result.definition = options.rule.description();
}

/// Those of a place with a horizon. @returns what its diagram is drawn from
light::DirectLight add_lit_days(const DayArguments& arguments, const light::TerrainHorizon& horizon,
                                DayResult& result) {
    const std::optional<double>& eye_height_m = arguments.place.eye_height_m;
    result.place = horizon.place();
    light::DirectLight direct(horizon, arguments.light.light(result.place, eye_height_m));
    result.light = direct.days(result.asked.first, result.asked.last, result.asked.zone);
    result.doubt = light::doubt_of(direct, result.light, horizon.profile(kDoubtDirections),
                                   arguments.terrain.highest_m);
    for (const light::LightDay& day : result.light)
        result.days.push_back(day.flat);
    result.light_definition = direct.definition();
    result.horizon_definition = horizon.description();
    result.definition = arguments.light.rule(result.place, eye_height_m).description();
    return direct;
}

/// @param direct  null without a DEM
chart::Drawing draw(const DayArguments& arguments, const DayResult& result,
                    const light::DirectLight* direct) {
    chart::SunPathDiagram diagram;
    diagram.place = result.place;
    diagram.place_name = arguments.place.name;
    diagram.zone = result.asked.zone;
    diagram.year = result.asked.first.year;
    diagram.refraction = arguments.light.refraction.at(result.place);
    if (result.asked.single) diagram.day = result.days.front();
    if (direct) {
        diagram.terrain = &direct->skyline();
        diagram.terrain_definition = result.horizon_definition;
        diagram.holes = direct->holes();
        if (result.asked.single) diagram.light = result.light.front();
        diagram.light_definition = result.light_definition;
    }
    return diagram.draw();
}

/// A place's days, and what its diagram is drawn from.
struct PlaceDays {
    DayResult result;
    std::optional<light::TerrainHorizon> horizon;
    std::optional<light::DirectLight> direct;  // refers to horizon
};

DayForms forms_of(const DayArguments& arguments, const DaysArguments::Days& asked,
                  const geo::PlaceText& at, const dem::Posts* posts) {
    const auto days = std::make_shared<PlaceDays>();
    DayResult& result = days->result;
    result.asked = asked;
    if (posts) {
        days->horizon.emplace(*posts, at.place,
                              arguments.terrain.horizon(at, arguments.place.eye_height_m));
        days->direct.emplace(add_lit_days(arguments, *days->horizon, result));
    } else {
        add_days(arguments, at, result);
    }
    return {
        .point = {.rows = [=] { return rows_of(days->result, posts != nullptr); },
                  .json = [=] { return json_of(days->result); },
                  .doubt = result.doubt},
        .csv = [=] { return csv_of(days->result); },
        .print =
            [=] { days->result.asked.single ? print_day(days->result) : print_days(days->result); },
        .drawing =
            [=, &arguments] {
                return draw(arguments, days->result, days->direct ? &*days->direct : nullptr);
            }};
}

void run_day(const DayArguments& arguments) {
    run_days(
        arguments,
        {.columns = [](bool terrain) { return day_columns(terrain, terrain); },
         .remarks = {kTwilights},
         .forms = [&](const DaysArguments::Days& asked, const geo::PlaceText& at,
                      const dem::Posts* posts) { return forms_of(arguments, asked, at, posts); }});
}

}  // namespace

void add_sun_day(Verb sun_verb) {
    const auto arguments = std::make_shared<DayArguments>();
    const Verb verb = sun_verb.add_verb(
        "day", "Sunrise, twilights, transit, day length; with a DEM also direct sun");
    arguments->add_to(verb, {"svg", "png", "csv", "json"});
    verb.callback([arguments] { run_day(*arguments); });
}

}  // namespace relevo::cli
