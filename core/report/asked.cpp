#include "report/asked.h"

#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "light/point/refraction_at.h"
#include "sun/position.h"

namespace relevo::report {
namespace {

sun::Limb limb_of(const std::optional<std::string>& text, sun::Limb otherwise) {
    if (!text) return otherwise;
    return *text == "upper"   ? sun::Limb::Upper
           : *text == "lower" ? sun::Limb::Lower
                              : sun::Limb::Center;
}

}  // namespace

Days DaysText::parse(const geo::Geodetic& place, const ChooseZone& choose) const {
    const int ways = !date.empty() + (!from.empty() || !to.empty()) + year.has_value();
    if (ways == 0)
        bad_usage("--date: missing; pass --date 2026-06-21, --from and --to, or --year 2026");
    if (ways > 1) bad_usage("--date, --from with --to, and --year exclude each other; use one");
    if (from.empty() != to.empty())
        bad_usage(from.empty() ? "--to needs --from" : "--from needs --to");
    Days days;
    if (year) {
        if (*year < sun::kFirstYear || *year > sun::kLastYear)
            bad_input(fmt::format("--year: {}: sun and moon are computed for the years {} to {}",
                                  *year, sun::kFirstYear, sun::kLastYear));
        days.first = {*year, 1, 1};
        days.last = {*year, 12, 31};
    } else if (!date.empty()) {
        days.first = days.last = sun::parse_date(date);
        days.single = true;
    } else {
        days.first = sun::parse_date(from);
        days.last = sun::parse_date(to);
        if (days.last < days.first)
            bad_input(
                fmt::format("--from {} --to {}: ends before it begins, expected the earlier "
                            "day first",
                            from, to));
    }
    sun::ChosenZone chosen = choose(zone, place);
    days.zone = std::move(chosen.zone);
    days.assumption = std::move(chosen.assumption);
    if (days.single) days.zone.day(days.first);  // says so where the zone skipped it
    return days;
}

sun::Refraction View::air(const geo::Geodetic& place) const {
    return light::refraction_at(refraction.value_or("standard"), place);
}

sun::RiseRule View::rule(const geo::Geodetic& place) const {
    if (!limb && !refraction && !eye_height_m && !dip_deg) return sun::RiseRule::almanac(body);
    if (dip_deg && eye_height_m) bad_usage("--dip and --eye-height exclude each other; use one");
    const sun::Limb part = limb_of(limb, sun::Limb::Upper);
    if (dip_deg) return sun::RiseRule::seen_over_dip(part, air(place), radians(*dip_deg), body);
    return sun::RiseRule::seen(part, air(place), eye_height_m.value_or(0), body);
}

light::LightOptions View::light(const geo::Geodetic& place) const {
    light::LightOptions options;
    options.body = body;
    options.limb = limb_of(limb, sun::Limb::Center);
    options.refraction = air(place);
    options.flat.rule = rule(place);
    return options;
}

light::HorizonOptions View::horizon(const geo::PlaceText& at) const {
    if (at.has_height && eye_height_m)
        bad_usage("--eye-height and a height in --at exclude each other; use one");
    light::HorizonOptions options;
    options.refraction = terrestrial_refraction;
    options.eye_height_m = at.has_height ? at.place.height_m : eye_height_m.value_or(0);
    options.eye_above_ground = at.above_ground || !at.has_height;
    return options;
}

void check_has_ground(const geo::PlaceText& at) {
    if (at.above_ground)
        bad_usage("--at: a height above the ground needs a DEM; give one above sea level");
}

}  // namespace relevo::report
