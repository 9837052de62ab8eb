#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "cli/day_parts.h"
#include "cli/day_verb.h"
#include "cli/sun.h"
#include "geo/format.h"
#include "report/eclipses.h"

namespace relevo::cli {
namespace {

using report::Eclipses;
using report::SeenEclipse;
using report::within;

constexpr const char* kEclipseColumns =
    "date,kind,magnitude,obscuration,central_s,first_contact,second_contact,greatest,"
    "third_contact,last_contact,first_sun,greatest_sun,last_sun,greatest_elevation_deg,"
    "obscuration_seen";

/// @param holes  what is not known for holes
std::string eclipse_columns(bool holes) {
    return std::string(kEclipseColumns) + (holes ? ",not_known,not_known_h" : "");
}

std::vector<std::string> rows_of(const Eclipses& result, bool holes) {
    std::vector<std::string> rows;
    const sun::Zone& zone = result.asked.zone;
    for (const SeenEclipse& seen : result.eclipses) {
        const sun::SolarEclipse& eclipse = seen.eclipse;
        const auto time = [&](const std::optional<sun::EclipseMoment>& moment) {
            return moment ? sun::to_iso(moment->utc, zone) : "";
        };
        rows.push_back(fmt::format(
            "{},{},{:.4f},{:.4f},{:.1f},{},{},{},{},{},{},{},{},{:.4f},{}",
            sun::to_string(seen.date), sun::name_of(eclipse.kind), eclipse.greatest.magnitude,
            eclipse.greatest.obscuration, seen.central_s(), time(eclipse.first),
            time(eclipse.second), time(eclipse.greatest), time(eclipse.third), time(eclipse.last),
            result.sun_is(seen, eclipse.first.utc), result.sun_is(seen, eclipse.greatest.utc),
            result.sun_is(seen, eclipse.last.utc), degrees(eclipse.greatest.elevation_rad),
            seen.greatest_seen ? fmt::format("{:.4f}", seen.greatest_seen->obscuration) : ""));
        if (holes)
            rows.back() += fmt::format(",{},{:.4f}", spans_of(seen.not_known, zone),
                                       seen.not_known_s() / 3600);
    }
    return rows;
}

/// What the figures mean.
std::vector<std::string> definitions_of(const Eclipses& result) {
    std::vector<std::string> definitions{report::kEclipseDefinition, result.definition};
    if (result.terrain) {
        definitions.push_back(result.light_definition);
        definitions.push_back(result.horizon_definition);
    }
    if (!result.doubt.holes.empty())
        definitions.push_back(not_known_text(result.doubt, "direct sun"));
    return definitions;
}

std::string csv_of(const Eclipses& result) {
    const bool holes = !result.doubt.holes.empty();
    std::string text = csv_remarks(definitions_of(result)) + eclipse_columns(holes) + "\n";
    for (const std::string& row : rows_of(result, holes))
        text += row + "\n";
    return text;
}

void print_moment(const Eclipses& result, const SeenEclipse& seen, std::string name,
                  const sun::EclipseMoment& moment) {
    std::ranges::replace(name, '_', ' ');
    const std::string state = result.sun_is(seen, moment.utc);
    const double azimuth_deg = printed_azimuth_deg(moment.azimuth_rad);
    fmt::print("  {:<18}{}  azimuth {:6.2f} {:<4} elevation {:6.2f}{}\n", name,
               sun::to_iso(moment.utc, result.asked.zone), azimuth_deg, compass_point(azimuth_deg),
               degrees(moment.elevation_rad),
               state == "up"               ? ""
               : state == "down"           ? "  below the horizon"
               : state == "behind terrain" ? "  behind terrain"
                                           : "  not known: a void of the DEM");
}

void print_text(const Eclipses& result) {
    fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(result.place),
               result.place.height_m);
    fmt::print("dates               {} to {}, {}\n", sun::to_string(result.asked.first),
               sun::to_string(result.asked.last), result.asked.zone.name());
    if (result.eclipses.empty()) fmt::print("\nno eclipse of the sun is seen there then\n");
    for (const SeenEclipse& seen : result.eclipses) {
        const sun::SolarEclipse& eclipse = seen.eclipse;
        fmt::print("\n{}  {}, magnitude {:.3f}, {:.1f} % of the disc covered",
                   sun::to_string(seen.date), sun::name_of(eclipse.kind),
                   eclipse.greatest.magnitude, 100 * eclipse.greatest.obscuration);
        if (eclipse.second)
            fmt::print(", {} {}", hours_text(seen.central_s()), sun::name_of(eclipse.kind));
        fmt::print("\n");
        for (const auto& [name, moment] : report::contacts_of(eclipse))
            print_moment(result, seen, name, moment);
        if (!seen.greatest_seen)
            fmt::print("  not seen          the sun stays behind terrain\n");
        else if (seen.greatest_seen->utc != eclipse.greatest.utc)
            fmt::print("  most that is seen {}  {:.1f} % of the disc covered{}\n",
                       sun::to_iso(seen.greatest_seen->utc, result.asked.zone),
                       100 * seen.greatest_seen->obscuration,
                       within(seen.not_known, seen.greatest_seen->utc)
                           ? "  not known: a void of the DEM"
                           : "");
        if (!seen.not_known.empty())
            fmt::print("  not known         {}: a void of the DEM\n",
                       spans_text(seen.not_known, result.asked.zone));
    }
    fmt::print("\n");
    for (const std::string& definition : definitions_of(result))
        fmt::print("{}\n", definition);
}

void run_eclipses(const DayArguments& arguments) {
    const auto forms = [&](const report::Days& asked, const geo::PlaceText& at,
                           const dem::Posts* posts) {
        return forms_of(
            std::make_shared<const Eclipses>(report::eclipses(arguments.view(), asked, at, posts)),
            posts != nullptr, rows_of, csv_of, print_text);
    };
    run_days(arguments,
             {.columns = eclipse_columns, .remarks = {report::kEclipseDefinition}, .forms = forms});
}

}  // namespace

void add_sun_eclipses(Verb sun_verb) {
    const auto arguments = std::make_shared<DayArguments>();
    const Verb verb = sun_verb.add_verb(
        "eclipses",
        "Eclipses of the sun seen from a place: contacts, magnitude; with a DEM also "
        "whether terrain hides them");
    arguments->add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_eclipses(*arguments); });
}

}  // namespace relevo::cli
