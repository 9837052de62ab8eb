#include "light/point/carpet.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::light {
namespace {

using sun::Instant;

Light light_at(const LightDay& day, const sun::Day& level, Instant utc) {
    for (const LitInterval& interval : day.lit)
        if (interval.begin.utc <= utc && utc < interval.end.utc) return Light::Lit;
    for (const sun::TimeSpan& up : level.sun_up)
        if (up.begin <= utc && utc < up.end) return Light::Shaded;
    // Civil twilight: dawn or dusk comes next, or it lasts all day or all of what is left of it.
    bool above = level.civil == sun::Crossing::AboveAllDay;
    bool known = level.civil != sun::Crossing::Crosses;
    for (const sun::Event& event : level.events) {
        const bool dawn = event.kind == sun::EventKind::CivilDawn;
        if (!dawn && event.kind != sun::EventKind::CivilDusk) continue;
        if (event.utc > utc) {
            if (!known) above = !dawn;
            break;
        }
        above = dawn;
        known = true;
    }
    return above ? Light::Twilight : Light::Night;
}

}  // namespace

std::string_view name_of(Light light) {
    switch (light) {
        case Light::Night:
            return "night";
        case Light::Twilight:
            return "twilight";
        case Light::Shaded:
            return "shaded";
        case Light::Lit:
            return "lit";
    }
    return {};
}

Carpet carpet(const DirectLight& light, int year, const sun::Zone& zone, int step_s) {
    constexpr int kDay_s = 86400;
    if (step_s < 1 || kDay_s % step_s != 0)
        bad_input(fmt::format(
            "carpet: step {} s: does not divide a day, expected a divisor of 86400 s, such as 600",
            step_s));
    if (year < sun::kFirstYear || year > sun::kLastYear)
        bad_input(fmt::format("carpet: year {}: the sun is computed for the years {} to {}", year,
                              sun::kFirstYear, sun::kLastYear));
    Carpet carpet;
    carpet.year = year;
    carpet.zone = zone;
    carpet.step_s = step_s;
    carpet.days = light.days({year, 1, 1}, {year, 12, 31}, zone);
    sun::DayOptions level;
    level.rule = sun::RiseRule::seen(light.limb(), light.refraction());
    const std::vector<sun::Day> level_days =
        sun::day_events({year, 1, 1}, {year, 12, 31}, zone, light.horizon().place(), level);
    carpet.month_lit_s.assign(12, 0);
    carpet.definition = light.definition();
    const int columns = kDay_s / step_s;
    carpet.light = Array2d<Light>(columns, static_cast<int>(carpet.days.size()));
    for (int row = 0; row < carpet.light.height(); ++row) {
        const LightDay& day = carpet.days[static_cast<std::size_t>(row)];
        carpet.lit_s += day.lit_s;
        carpet.not_known_s += day.not_known_s;
        const sun::Day& level_day = level_days[static_cast<std::size_t>(row)];
        carpet.level_s += level_day.day_length_s;
        carpet.day_level_s.push_back(level_day.day_length_s);
        carpet.month_lit_s[static_cast<std::size_t>(day.date.month - 1)] += day.lit_s;
        for (int column = 0; column < columns; ++column) {
            const int half_seconds = (2 * column + 1) * step_s;
            const int s = half_seconds / 2;
            const sun::CivilTime wall{day.date, s / 3600, s / 60 % 60, s % 60,
                                      half_seconds % 2 * 500'000};
            carpet.light.at(column, row) = light_at(day, level_day, zone.resolve(wall).utc);
        }
    }
    return carpet;
}

}  // namespace relevo::light
