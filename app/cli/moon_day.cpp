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

using nlohmann::ordered_json;
using sun::EventKind;

constexpr EventKind kMoonKinds[] = {EventKind::Moonrise, EventKind::Transit, EventKind::Moonset,
                                    EventKind::LowerTransit};
constexpr const char* kPhases =
    "phases: the moon's apparent geocentric ecliptic longitude is 0, 90, 180 or 270 degrees more "
    "than the sun's; illuminated fraction: at the middle of the local day";

constexpr DayResult::Words kMoonWords{
    "direct_moonlight", "phase_definition", kPhases,
    "date,all_day",     kMoonKinds,         ",moon_up_h,illuminated_fraction,phase,phase_time"};

struct MoonDayResult : DayResult {
    std::vector<sun::MoonDay> days{};
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
    return json;
}

ordered_json json_of(const MoonDayResult& result) {
    return json_of(result, result.days.size(), [&](std::size_t i) { return day_json(result, i); });
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
    return text + light_columns(result, i, holes);
}

void print_day(const MoonDayResult& result) {
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

void print_days(const MoonDayResult& result) {
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

void print_text(const MoonDayResult& result) {
    print_head(result);
    result.asked.single ? print_day(result) : print_days(result);
    print_definitions(result);
}

void run(const DayArguments& arguments) {
    const auto forms = [&](const DaysArguments::Days& asked, const geo::PlaceText& at,
                           const dem::Posts* posts) {
        const auto result = std::make_shared<MoonDayResult>(DayResult{kMoonWords, asked});
        const std::optional<double>& eye_height_m = arguments.place.eye_height_m;
        std::optional<light::TerrainHorizon> horizon;
        if (posts) horizon.emplace(*posts, at.place, arguments.terrain.horizon(at, eye_height_m));
        if (find_light(arguments, at, horizon ? &*horizon : nullptr, *result))
            result->light_definition += "; at any phase, and by day too";
        result->days = sun::moon_days(asked.first, asked.last, asked.zone, result->place,
                                      arguments.light.rule(result->place, eye_height_m));
        return forms_of(std::shared_ptr<const MoonDayResult>(result), posts != nullptr);
    };
    run_days(arguments, kMoonWords, forms);
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
