#include "report/eclipses.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "report/days.h"
#include "report/doubts.h"
#include "report/json_parts.h"
#include "sun/position_table.h"

namespace relevo::report {
namespace {

using nlohmann::ordered_json;

ordered_json moment_json(const Eclipses& result, const SeenEclipse& seen,
                         const sun::EclipseMoment& moment) {
    return {{"utc", utc_json<ordered_json>(moment.utc)},
            {"local", sun::to_iso(moment.utc, result.asked.zone)},
            {"azimuth_deg", angle_deg(moment.azimuth_rad)},
            {"elevation_deg", angle_deg(moment.elevation_rad)},
            {"magnitude", moment.magnitude},
            {"obscuration", moment.obscuration},
            {"sun", result.sun_is(seen, moment.utc)}};
}

ordered_json eclipse_json(const Eclipses& result, const SeenEclipse& seen) {
    ordered_json json;
    const sun::SolarEclipse& eclipse = seen.eclipse;
    json["date"] = sun::to_string(seen.date);
    json["kind"] = sun::name_of(eclipse.kind);
    json["magnitude"] = eclipse.greatest.magnitude;
    json["obscuration"] = eclipse.greatest.obscuration;
    json["central_s"] = seen.central_s();
    for (const auto& [name, moment] : contacts_of(eclipse))
        json[name] = moment_json(result, seen, moment);
    json["greatest_seen"] =
        seen.greatest_seen ? moment_json(result, seen, *seen.greatest_seen) : ordered_json();
    if (result.terrain) json["direct_sun"] = spans_json<ordered_json>(seen.lit);
    if (!result.doubt.holes.empty()) {
        json["not_known"] = spans_json<ordered_json>(seen.not_known);
        json["not_known_h"] = seen.not_known_s() / 3600;
    }
    return json;
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
Eclipses result_of(const View& view, const Days& asked, const geo::Geodetic& place,
                   const light::DirectLight* direct) {
    Eclipses result;
    result.place = place;
    result.asked = asked;
    result.terrain = direct != nullptr;
    const sun::RiseRule rule = view.rule(place);
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
                                       view.highest_m);
    }
    return result;
}

}  // namespace

const char* const kEclipseDefinition =
    "contacts of circular limbs: the moon's radius is 0.2725076 of the Earth's equatorial one for "
    "first and last contact, 0.2722810 for second and third; magnitude: from the sun's limb "
    "nearest "
    "the moon's centre to the moon's far limb, over the sun's diameter; obscuration: fraction of "
    "the "
    "sun's area that is covered, limb darkening not counted; elevations of the sun's centre "
    "without "
    "refraction";

double SeenEclipse::not_known_s() const {
    double sum_s = 0;
    for (const sun::TimeSpan& span : not_known)
        sum_s += span.length_s();
    return sum_s;
}

double SeenEclipse::central_s() const {
    return eclipse.second && eclipse.third ? eclipse.third->utc - eclipse.second->utc : 0;
}

std::string Eclipses::sun_is(const SeenEclipse& seen, sun::Instant utc) const {
    if (within(seen.not_known, utc)) return "not known";
    if (within(terrain ? seen.lit : seen.up, utc)) return "up";
    return terrain && within(seen.up, utc) ? "behind terrain" : "down";
}

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

Eclipses eclipses(const View& view, const Days& asked, const geo::PlaceText& at,
                  const dem::Posts* posts) {
    if (!posts) {
        check_has_ground(at);
        return result_of(view, asked, at.place, nullptr);
    }
    const light::TerrainHorizon horizon(*posts, at.place, view.horizon(at));
    const light::DirectLight direct(horizon, view.light(horizon.place()));
    return result_of(view, asked, horizon.place(), &direct);
}

std::string json_of(const Eclipses& result) {
    auto json = json_of_shape<ordered_json>("sun-eclipses");
    json["place"] = place_json<ordered_json>(result.place);
    json["zone"] = result.asked.zone.name();
    add_assumption(json, result.asked.assumption);
    json["definition"] = kEclipseDefinition;
    json["sun_definition"] = result.definition;
    if (result.terrain) {
        json["light_definition"] = result.light_definition;
        json["horizon_definition"] = result.horizon_definition;
        if (!result.doubt.holes.empty())
            json["hole_sectors"] = sectors_json<ordered_json>(result.doubt.holes);
    }
    ordered_json& eclipses = json["eclipses"] = ordered_json::array();
    for (const SeenEclipse& seen : result.eclipses)
        eclipses.push_back(eclipse_json(result, seen));
    return json.dump();
}

}  // namespace relevo::report
