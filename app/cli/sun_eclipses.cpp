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
#include "sun/eclipse.h"
#include "sun/position_table.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kDefinition =
    "contacts of circular limbs: the moon's radius is 0.2725076 of the Earth's equatorial one for "
    "first and last contact, 0.2722810 for second and third; magnitude: from the sun's limb "
    "nearest "
    "the moon's centre to the moon's far limb, over the sun's diameter; obscuration: fraction of "
    "the "
    "sun's area that is covered, limb darkening not counted; elevations of the sun's centre "
    "without "
    "refraction";

/// An eclipse, and when its sun is seen.
struct SeenEclipse {
    sun::SolarEclipse eclipse;
    std::vector<sun::TimeSpan> up;         ///< over the level horizon
    std::vector<sun::TimeSpan> lit;        ///< over the terrain, where there is a DEM
    std::vector<sun::TimeSpan> not_known;  ///< of lit, for voids of the DEM
    std::optional<sun::EclipseMoment> greatest_seen;
    sun::Date date;  ///< local, of the greatest that is seen, or that only terrain hides
};

struct EclipsesResult {
    geo::Geodetic place;
    DaysArguments::Days asked;
    std::string definition, light_definition, horizon_definition;
    bool terrain = false;
    std::vector<SeenEclipse> eclipses;
    light::Doubt doubt;
};

/// The contacts that an eclipse has, in order.
std::vector<std::pair<const char*, sun::EclipseMoment>> contacts_of(
    const sun::SolarEclipse& eclipse) {
    std::vector<std::pair<const char*, sun::EclipseMoment>> contacts{
        {"first_contact", eclipse.first}};
    if (eclipse.second) contacts.emplace_back("second_contact", *eclipse.second);
    contacts.emplace_back("greatest", eclipse.greatest);
    if (eclipse.third) contacts.emplace_back("third_contact", *eclipse.third);
    contacts.emplace_back("last_contact", eclipse.last);
    return contacts;
}

bool within(const std::vector<sun::TimeSpan>& spans, sun::Instant utc) {
    return std::ranges::any_of(
        spans, [utc](const sun::TimeSpan& span) { return utc >= span.begin && utc <= span.end; });
}

/// "up", "down", "behind terrain" or, in a void of the DEM, "not known".
std::string sun_is(const EclipsesResult& result, const SeenEclipse& seen, sun::Instant utc) {
    if (within(seen.not_known, utc)) return "not known";
    const bool lit = within(result.terrain ? seen.lit : seen.up, utc);
    if (lit) return "up";
    return result.terrain && within(seen.up, utc) ? "behind terrain" : "down";
}

double length_s(const std::vector<sun::TimeSpan>& spans) {
    double sum_s = 0;
    for (const sun::TimeSpan& span : spans)
        sum_s += span.length_s();
    return sum_s;
}

double central_s(const sun::SolarEclipse& eclipse) {
    return eclipse.second && eclipse.third ? eclipse.third->utc - eclipse.second->utc : 0;
}

ordered_json moment_json(const EclipsesResult& result, const SeenEclipse& seen,
                         const sun::EclipseMoment& moment) {
    return {{"utc", utc_json(moment.utc)},
            {"local", sun::to_iso(moment.utc, result.asked.zone)},
            {"azimuth_deg", angle_deg(moment.azimuth_rad)},
            {"elevation_deg", angle_deg(moment.elevation_rad)},
            {"magnitude", moment.magnitude},
            {"obscuration", moment.obscuration},
            {"sun", sun_is(result, seen, moment.utc)}};
}

ordered_json eclipse_json(const EclipsesResult& result, const SeenEclipse& seen) {
    ordered_json json;
    const sun::SolarEclipse& eclipse = seen.eclipse;
    json["date"] = sun::to_string(seen.date);
    json["kind"] = sun::name_of(eclipse.kind);
    json["magnitude"] = eclipse.greatest.magnitude;
    json["obscuration"] = eclipse.greatest.obscuration;
    json["central_s"] = central_s(eclipse);
    for (const auto& [name, moment] : contacts_of(eclipse))
        json[name] = moment_json(result, seen, moment);
    json["greatest_seen"] =
        seen.greatest_seen ? moment_json(result, seen, *seen.greatest_seen) : ordered_json();
    if (result.terrain) json["direct_sun"] = spans_json(seen.lit);
    if (!result.doubt.holes.empty()) {
        json["not_known"] = spans_json(seen.not_known);
        json["not_known_h"] = length_s(seen.not_known) / 3600;
    }
    return json;
}

ordered_json json_of(const EclipsesResult& result) {
    ordered_json json;
    json["place"] = place_json(result.place);
    json["zone"] = result.asked.zone.name();
    add_assumption(json, result.asked.assumption);
    json["definition"] = kDefinition;
    json["sun_definition"] = result.definition;
    if (result.terrain) {
        json["light_definition"] = result.light_definition;
        json["horizon_definition"] = result.horizon_definition;
        if (!result.doubt.holes.empty()) json["hole_sectors"] = sectors_json(result.doubt.holes);
    }
    ordered_json& eclipses = json["eclipses"] = ordered_json::array();
    for (const SeenEclipse& seen : result.eclipses)
        eclipses.push_back(eclipse_json(result, seen));
    return json;
}

constexpr const char* kEclipseColumns =
    "date,kind,magnitude,obscuration,central_s,first_contact,second_contact,greatest,"
    "third_contact,last_contact,first_sun,greatest_sun,last_sun,greatest_elevation_deg,"
    "obscuration_seen";

/// @param holes  what is not known for holes
std::string eclipse_columns(bool holes) {
    return std::string(kEclipseColumns) + (holes ? ",not_known,not_known_h" : "");
}

std::vector<std::string> rows_of(const EclipsesResult& result, bool holes) {
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
            eclipse.greatest.obscuration, central_s(eclipse), time(eclipse.first),
            time(eclipse.second), time(eclipse.greatest), time(eclipse.third), time(eclipse.last),
            sun_is(result, seen, eclipse.first.utc), sun_is(result, seen, eclipse.greatest.utc),
            sun_is(result, seen, eclipse.last.utc), degrees(eclipse.greatest.elevation_rad),
            seen.greatest_seen ? fmt::format("{:.4f}", seen.greatest_seen->obscuration) : ""));
        if (holes)
            rows.back() += fmt::format(",{},{:.4f}", spans_of(seen.not_known, zone),
                                       length_s(seen.not_known) / 3600);
    }
    return rows;
}

/// What the figures mean.
std::vector<std::string> definitions_of(const EclipsesResult& result) {
    std::vector<std::string> definitions{kDefinition, result.definition};
    if (result.terrain) {
        definitions.push_back(result.light_definition);
        definitions.push_back(result.horizon_definition);
    }
    if (!result.doubt.holes.empty())
        definitions.push_back(not_known_text(result.doubt, "direct sun"));
    return definitions;
}

std::string csv_of(const EclipsesResult& result) {
    const bool holes = !result.doubt.holes.empty();
    std::string text = csv_remarks(definitions_of(result)) + eclipse_columns(holes) + "\n";
    for (const std::string& row : rows_of(result, holes))
        text += row + "\n";
    return text;
}

void print_moment(const EclipsesResult& result, const SeenEclipse& seen, std::string name,
                  const sun::EclipseMoment& moment) {
    std::ranges::replace(name, '_', ' ');
    const std::string state = sun_is(result, seen, moment.utc);
    const double azimuth_deg = printed_azimuth_deg(moment.azimuth_rad);
    fmt::print("  {:<18}{}  azimuth {:6.2f} {:<4} elevation {:6.2f}{}\n", name,
               sun::to_iso(moment.utc, result.asked.zone), azimuth_deg, compass_point(azimuth_deg),
               degrees(moment.elevation_rad),
               state == "up"               ? ""
               : state == "down"           ? "  below the horizon"
               : state == "behind terrain" ? "  behind terrain"
                                           : "  not known: a void of the DEM");
}

void print_text(const EclipsesResult& result) {
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
            fmt::print(", {} {}", hours_text(central_s(eclipse)), sun::name_of(eclipse.kind));
        fmt::print("\n");
        for (const auto& [name, moment] : contacts_of(eclipse))
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

/// When the sun is up over a level horizon while an eclipse lasts.
std::vector<sun::TimeSpan> up_during(const sun::SolarEclipse& eclipse, const geo::Geodetic& place,
                                     const sun::RiseRule& rule) {
    // A day's events need a stretch of hours to be found in.
    const sun::TimeSpan around{eclipse.first.utc - 3600, eclipse.last.utc + 3600};
    const sun::PositionTable table(around.begin, around.end);
    return sun::day_events(table, around, sun::Observer(place), {rule}).sun_up;
}

/// The light of an eclipse over the terrain, as light::doubt_of() takes that of a day.
light::LightDay light_of(const sun::SolarEclipse& eclipse, const light::DirectLight& direct) {
    light::LightDay day;
    day.span = eclipse.span();
    day.lit = direct.lit_within(day.span);
    for (const light::LitInterval& interval : day.lit)
        day.not_known_s += interval.not_known_s();
    return day;
}

/// @param direct  null without a DEM
EclipsesResult result_of(const DayArguments& arguments, const DaysArguments::Days& asked,
                         const geo::Geodetic& place, const light::DirectLight* direct) {
    EclipsesResult result;
    result.place = place;
    result.asked = asked;
    result.terrain = direct != nullptr;
    const sun::RiseRule rule = arguments.light.rule(place, arguments.place.eye_height_m);
    result.definition = rule.description();
    std::vector<light::LightDay> light;
    const std::vector<sun::LocalDay> days = sun::local_days(asked.first, asked.last, asked.zone);
    if (days.empty()) return result;
    const sun::Instant begin = days.front().span.begin, end = days.back().span.end;
    for (const sun::SolarEclipse& eclipse : sun::solar_eclipses(begin, end, place)) {
        SeenEclipse seen{eclipse, up_during(eclipse, place, rule), {}, {}, {}, {}};
        const light::LightDay of_terrain = direct ? light_of(eclipse, *direct) : light::LightDay();
        for (const light::LitInterval& interval : of_terrain.lit)
            seen.lit.push_back({interval.begin.utc, interval.end.utc});
        seen.not_known = not_known_of(of_terrain.lit);
        const auto over_level = sun::greatest_within(eclipse, seen.up, place);
        seen.greatest_seen = direct ? sun::greatest_within(eclipse, seen.lit, place) : over_level;
        const auto& greatest = seen.greatest_seen ? seen.greatest_seen : over_level;
        // One that lasts over midnight is listed for one of the two days.
        if (!greatest || greatest->utc < begin || greatest->utc >= end) continue;
        seen.date = asked.zone.local(greatest->utc).wall.date;
        if (direct) light.push_back(of_terrain);
        result.eclipses.push_back(std::move(seen));
    }
    if (direct) {
        result.light_definition = direct->definition();
        result.horizon_definition = direct->horizon().description();
        result.doubt = light::doubt_of(*direct, light, direct->horizon().profile(kDoubtDirections),
                                       arguments.terrain.highest_m);
    }
    return result;
}

EclipsesResult eclipses_at(const DayArguments& arguments, const DaysArguments::Days& asked,
                           const geo::PlaceText& at, const dem::Posts* posts) {
    const std::optional<double>& eye_height_m = arguments.place.eye_height_m;
    if (!posts) {
        check_has_ground(at);
        return result_of(arguments, asked, at.place, nullptr);
    }
    const light::TerrainHorizon horizon(*posts, at.place,
                                        arguments.terrain.horizon(at, eye_height_m));
    const light::DirectLight direct(horizon, arguments.light.light(horizon.place(), eye_height_m));
    return result_of(arguments, asked, horizon.place(), &direct);
}

void run_eclipses(const DayArguments& arguments) {
    const auto forms = [&](const DaysArguments::Days& asked, const geo::PlaceText& at,
                           const dem::Posts* posts) {
        return forms_of(
            std::make_shared<const EclipsesResult>(eclipses_at(arguments, asked, at, posts)),
            posts != nullptr);
    };
    run_days(arguments, {.columns = eclipse_columns, .remarks = {kDefinition}, .forms = forms});
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
