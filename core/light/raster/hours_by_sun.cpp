#include "light/raster/hours_by_sun.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "base/units.h"
#include "light/raster/irradiation.h"
#include "light/raster/post_loops.h"
#include "light/raster/shadow_heights.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr float kDark_m = -1;  // the clearance of all posts before the first sun

/// What is known of the posts of a part up to a sun.
class LightSoFar {
  public:
    LightSoFar(const SunPlan& plan, const Window& part, const SunHoursOptions& options,
               SunHours& result)
        : part_(part),
          heights_(plan.terrain().posts(), part),
          clearance_m_(part.columns, part.rows, kDark_m),
          result_(result),
          with_periods_(options.spells) {
        if (options.irradiation) ground_.emplace(plan.terrain(), part, options.irradiation->plane);
    }

    /// The light from the sun before to this one.
    void add(const PlannedSun& sun, double before_s, const SunBeams* beams) {
        const bool is_first = sun.at_s == 0;
        const Step step{static_cast<float>(before_s / kHour_s),
                        static_cast<float>((sun.at_s - before_s) / kHour_s)};
        const auto use = [&](const SweepRun& run) {
            const float* const height_m = heights_.view.at(run.column, run.row);
            const int x = run.column - part_.column, y = run.row - part_.row;
            float* const clearance_m = &clearance_m_.at(x, y);
            if (is_first) return find_clearances(height_m, run.found, run.count, clearance_m);
            if (with_periods_) add_periods(step, run, height_m, clearance_m, x, y);
            if (beams) beams->add(run, height_m, clearance_m, *ground_, &result_.beam_kwh.at(x, y));
            add_light(step, height_m, run.found, run.count, clearance_m, &result_.hours.at(x, y));
        };
        each_shadow(sun, part_, 0, use);
    }

    /// Posts that are lit at the first sun, or at the last one.
    void begin() {
        if (!with_periods_) return;
        each_lit([&](int x, int y) {
            result_.first_h.at(x, y) = 0;
            result_.spells.at(x, y) = 1;
        });
    }
    void end(double at_h) {
        each_lit([&](int x, int y) {
            result_.hours.at(x, y) += static_cast<float>(at_h);
            if (with_periods_) result_.last_h.at(x, y) = static_cast<float>(at_h);
        });
    }

  private:
    /// Where light comes or goes. To be called before add_light().
    void add_periods(const Step& step, const SweepRun& run, const float* height_m,
                     const float* clearance_m, int x, int y) {
        for (int i = 0; i < run.count; ++i) {
            const float before = clearance_m[i], now = height_m[i] - run.found[i];
            if ((before >= 0) == (now >= 0)) continue;
            const float when_h = step.from_h + step.hours * (before / (before - now));
            if (now >= 0) {
                if (std::isnan(result_.first_h.at(x + i, y))) result_.first_h.at(x + i, y) = when_h;
                ++result_.spells.at(x + i, y);
            } else {
                result_.last_h.at(x + i, y) = when_h;
            }
        }
    }

    template <typename Body>
    void each_lit(const Body& body) const {
        for (int y = 0; y < part_.rows; ++y)
            for (int x = 0; x < part_.columns; ++x)
                if (clearance_m_.at(x, y) >= 0) body(x, y);
    }

    Window part_;
    WindowHeights heights_;
    Array2d<float> clearance_m_;
    SunHours& result_;
    bool with_periods_;
    std::optional<InclinedGround> ground_;
};

}  // namespace

std::vector<std::size_t> order_of_suns(std::size_t count, bool mixed) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!mixed || count == 0) return order;
    constexpr double kGolden = 0.618033988749895, kMorning = 0.2;
    std::vector<double> places(count);
    for (std::size_t k = 0; k < count; ++k)
        places[k] = std::fmod(kMorning + kGolden * static_cast<double>(k), 1.0);
    // The rank of each place is its sun: a permutation.
    std::vector<std::size_t> sorted = order;
    std::ranges::sort(sorted, {}, [&](std::size_t k) { return places[k]; });
    for (std::size_t rank = 0; rank < count; ++rank)
        order[sorted[rank]] = rank;
    return order;
}

void add_hours_by_sun(const SunPlan& plan, sun::Instant begin, double length_s, const Window& part,
                      const SunHoursOptions& options, SunHours& result) {
    if (options.spells) {
        result.first_h = result.last_h = Array2d<float>(part.columns, part.rows, kUnknown);
        result.spells = Array2d<float>(part.columns, part.rows, 0);
    }
    LightSoFar light(plan, part, options, result);
    const std::vector<PlannedSun>& suns = plan.suns();
    if (options.done) options.done(0);
    std::optional<sun::PositionTable> table;
    if (options.irradiation) table.emplace(begin, begin + length_s);
    for (const std::size_t k : order_of_suns(suns.size(), options.mixes_suns)) {
        const PlannedSun& sun = suns[k];
        const double before_s = k == 0 ? 0 : suns[k - 1].at_s;
        std::optional<SunBeams> beams;
        if (table && sun.at_s > before_s)
            beams.emplace(plan.terrain(), *table, before_s, sun.at_s, options.irradiation->linke);
        light.add(sun, before_s, beams ? &*beams : nullptr);
        if (sun.at_s == 0) light.begin();
        if (options.done) options.done(1.0 / static_cast<double>(suns.size()));
    }
    light.end(length_s / kHour_s);
}

}  // namespace relevo::light
