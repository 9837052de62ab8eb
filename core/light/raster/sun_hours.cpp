#include "light/raster/sun_hours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "dem/surroundings.h"
#include "light/point/edge_ground.h"
#include "light/raster/hours_by_horizon.h"
#include "light/raster/hours_by_sun.h"
#include "light/raster/irradiation.h"
#include "light/raster/level_hours.h"

namespace relevo::light {
namespace {

void check(sun::Instant begin, sun::Instant end, const SunHoursOptions& options) {
    if (!(end > begin))
        bad_input(fmt::format("sun hours: from {} to {}: expected an end after the beginning",
                              sun::to_iso(begin), sun::to_iso(end)));
    if (!(options.step_s >= 1 && options.step_s <= kHour_s))
        bad_input(
            fmt::format("sun hours: step {:.10g} s: expected 1 s to an hour", options.step_s));
    if (options.spells && end - begin > SunHoursOptions::kMostDays * kDay_s)
        bad_input(
            fmt::format("sun hours: {:.1f} days: first and last light are known of {} days at most",
                        (end - begin) / kDay_s, SunHoursOptions::kMostDays));
    sun::check_year(begin);
    sun::check_year(end);
}

/// Holes, and the mean of the others.
void sum_up(const WindowHeights& heights, const Window& part, SunHours& result) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    std::int64_t posts = 0;
    for (int y = 0; y < part.rows; ++y)
        for (int x = 0; x < part.columns; ++x) {
            float& hours = result.hours.at(x, y);
            if (std::isnan(heights.at(part.column + x, part.row + y))) {
                hours = kNaN;
                if (!result.spells.empty()) result.spells.at(x, y) = kNaN;
                ++result.holes;
                continue;
            }
            hours = std::max(hours, 0.0F);  // sums of comings and goings end near 0
            result.mean_hours += double{hours};
            ++posts;
        }
    result.mean_hours /= static_cast<double>(posts);
}

}  // namespace

struct SunHoursPlan::Impl {
    SunHoursOptions options;
    sun::Instant begin;
    double length_s;
    bool few;
    SunPlan plan;
    std::optional<HorizonHours> horizons;
    std::optional<SkyLight> sky;
    LevelHours level;

    Impl(const dem::Posts& posts, sun::Instant from, sun::Instant end, const SunHoursOptions& of)
        : options(of),
          begin(from),
          length_s(end - from),
          few(length_s <= SunHoursOptions::kMostDays * kDay_s),
          plan(posts, {of.refraction, of.air}, of.part) {
        if (few)
            plan.add_time(begin, length_s, options.step_s);
        else
            horizons.emplace(plan, begin, length_s, options);
        if (options.irradiation) sky.emplace(plan.terrain(), begin, length_s, options);
        level = level_hours(plan.terrain(), begin, length_s);
    }

    std::string definition() const {
        const double finer_s = options.step_s / SunPlan::finer(options.step_s);
        return fmt::format(
            "hours that the centre of the sun stands over the terrain, at the height of the "
            "ground, {}; ground of {} shades, on the WGS 84 ellipsoid with terrestrial "
            "refraction k = {:.4g}{}; no clouds",
            few ? fmt::format("from suns {:.10g} s apart, {:.10g} s near the horizon",
                              options.step_s, finer_s)
                : "from horizons in directions 2 degrees apart",
            dem::ground_text(plan.terrain().given()), options.refraction, kBeyondTheDem);
    }
};

SunHoursPlan::SunHoursPlan(const dem::Posts& posts, sun::Instant begin, sun::Instant end,
                           const SunHoursOptions& options) {
    check(begin, end, options);
    impl_ = std::make_unique<Impl>(posts, begin, end, options);
}

SunHoursPlan::~SunHoursPlan() = default;

SunHours SunHoursPlan::part(const Window& asked) const {
    const Impl& impl = *impl_;
    const SunTerrain& terrain = impl.plan.terrain();
    const Window given = asked.is_empty() ? impl.options.part : asked;
    const Window part = terrain.window_of(given);
    SunHours result;
    result.hours = Array2d<float>(part.columns, part.rows, 0);
    if (impl.options.irradiation)
        for (Array2d<float>* const each :
             {&result.beam_kwh, &result.diffuse_kwh, &result.reflected_kwh})
            *each = Array2d<float>(part.columns, part.rows);
    if (impl.few)
        add_hours_by_sun(impl.plan, impl.begin, impl.length_s, part, impl.options, result);
    else
        impl.horizons->add(part, result);
    result.tiles = impl.few ? impl.plan.most_tiles() : impl.horizons->most_tiles();
    sum_up(WindowHeights(terrain.posts(), part), part, result);
    if (impl.sky) impl.sky->add(given, result);
    result.level_hours = impl.level.middle;
    result.most_level_hours = impl.level.most;
    result.definition = impl.definition();
    return result;
}

SunHours sun_hours(const dem::Posts& posts, sun::Instant begin, sun::Instant end,
                   const SunHoursOptions& options) {
    return SunHoursPlan(posts, begin, end, options).part();
}

}  // namespace relevo::light
