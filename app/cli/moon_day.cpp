#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "cli/day_parts.h"
#include "cli/day_verb.h"
#include "cli/sun.h"
#include "sun/moon_events.h"

namespace relevo::cli {
namespace {

using report::all_day_of;
using report::MoonDays;
using sun::EventKind;

std::string row_of(const MoonDays& result, std::size_t i, bool holes) {
    const sun::Zone& zone = result.asked.zone;
    const sun::MoonDay& day = result.days[i];
    const char* all_day = all_day_of(day);
    std::string text = sun::to_string(day.date) + "," + (all_day ? all_day : "");
    for (const EventKind kind : result.words.kinds) {
        std::string times;
        for (const sun::Event& event : day.events)
            if (event.kind == kind)
                times += (times.empty() ? "" : ";") + sun::to_iso(event.utc, zone);
        text += "," + times;
    }
    text += fmt::format(",{:.4f},{:.4f},{},{}", day.moon_up_s / 3600, day.illuminated_fraction,
                        sun::phase_name(day.phase_longitude_rad),
                        day.phases.empty() ? "" : sun::to_iso(day.phases.front().utc, zone));
    return text + light_columns(result, i, holes);
}

std::vector<std::string> rows_of(const MoonDays& result, bool holes) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < result.days.size(); ++i)
        rows.push_back(row_of(result, i, holes));
    return rows;
}

std::string csv_of(const MoonDays& result) {
    return table_of(result, rows_of(result, result.has_holes()));
}

void print_day(const MoonDays& result) {
    const sun::MoonDay& day = result.days.front();
    const sun::Zone& zone = result.asked.zone;
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

void print_days(const MoonDays& result) {
    const sun::Zone& zone = result.asked.zone;
    const bool lit = !result.light.empty();
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

void print_text(const MoonDays& result) {
    print_head(result);
    result.asked.single ? print_day(result) : print_days(result);
    print_definitions(result);
}

void run(const DayArguments& arguments) {
    run_days(arguments, report::kMoonWords,
             [&](const report::Days& asked, const geo::PlaceText& at, const dem::Posts* posts) {
                 return forms_of(report::moon_days(arguments.view(), asked, at, posts),
                                 posts != nullptr, rows_of, csv_of, print_text);
             });
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
