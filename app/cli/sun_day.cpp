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
#include "sun/position.h"
#include "sun/seasons.h"

namespace relevo::cli {
namespace {

using report::polar_of;
using report::SunDays;
using sun::EventKind;

std::string row_of(const SunDays& result, std::size_t i, bool holes) {
    const sun::Zone& zone = result.asked.zone;
    const sun::Day& day = result.days[i];
    const char* polar = polar_of(day);
    std::string text = sun::to_string(day.date) + "," + (polar ? polar : "");
    for (const EventKind kind : result.words.kinds) {
        std::string times;
        for (const sun::Instant utc : day.all(kind))
            times += (times.empty() ? "" : ";") + sun::to_iso(utc, zone);
        text += "," + times;
    }
    text += fmt::format(",{:.4f},{},{}", day.day_length_s / 3600, spans_of(day.golden_hour, zone),
                        spans_of(day.blue_hour, zone));
    return text + light_columns(result, i, holes);
}

std::vector<std::string> rows_of(const SunDays& result, bool holes) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < result.days.size(); ++i)
        rows.push_back(row_of(result, i, holes));
    return rows;
}

std::string csv_of(const SunDays& result) {
    return table_of(result, rows_of(result, result.has_holes()));
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

void print_day(const SunDays& result) {
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

void print_days(const SunDays& result) {
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

void print_text(const SunDays& result) {
    result.asked.single ? print_day(result) : print_days(result);
}

chart::Drawing draw(const DayArguments& arguments, const SunDays& result) {
    chart::SunPathDiagram diagram;
    diagram.place = result.place;
    diagram.place_name = arguments.place.name;
    diagram.zone = result.asked.zone;
    diagram.year = result.asked.first.year;
    diagram.refraction = arguments.light.refraction.at(result.place);
    if (result.asked.single) diagram.day = result.days.front();
    if (result.direct) {
        diagram.terrain = &result.direct->skyline();
        diagram.terrain_definition = result.horizon_definition;
        diagram.holes = result.direct->holes();
        if (result.asked.single) diagram.light = result.light.front();
        diagram.light_definition = result.light_definition;
    }
    return diagram.draw();
}

void run_day(const DayArguments& arguments) {
    run_days(arguments, report::kSunWords,
             [&](const report::Days& asked, const geo::PlaceText& at, const dem::Posts* posts) {
                 const auto result = report::sun_days(arguments.view(), asked, at, posts);
                 DayForms forms = forms_of(result, posts != nullptr, rows_of, csv_of, print_text);
                 forms.drawing = [=, &arguments] { return draw(arguments, *result); };
                 return forms;
             });
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
