#include "light/raster/sun_plan.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"
#include "base/units.h"
#include "sun/position_table.h"

namespace relevo::light {
namespace {

constexpr double kLow_rad = radians(1.5);  // a sun under that is near the horizon

SunOverDem sun_at(const sun::PositionTable& table, sun::Instant utc,
                  const sun::Observer& observer) {
    const glm::dvec3 direction = table.direction(utc, observer);
    return {sun::azimuth_of(direction), sun::elevation_of(direction), 0};
}

/// How far the Earth turns from the middle of a DEM to its corners.
double turn_rad(const SunTerrain& terrain) {
    const geo::Geodetic& middle = terrain.marks()[4];
    const glm::dvec3 up = terrain.frame().up(middle.lat_rad, middle.lon_rad);
    double least = 1;
    for (const geo::Geodetic& mark : terrain.marks())
        if (std::isfinite(mark.lat_rad))
            least = std::min(least, glm::dot(up, terrain.frame().up(mark.lat_rad, mark.lon_rad)));
    return std::acos(std::clamp(least, -1.0, 1.0));
}

}  // namespace

SunPlan::SunPlan(const dem::Posts& posts, const LightPath& path, const Window& window,
                 bool with_discs)
    : terrain_(std::make_unique<const SunTerrain>(
          posts, path, with_discs,
          SunTerrain::Nesting{.around = posts.surroundings(), .site = nullptr})),
      around_(posts.surroundings()
                  ? std::make_unique<const SunTerrain>(
                        *posts.surroundings(), path, with_discs,
                        SunTerrain::Nesting{.around = nullptr, .site = &terrain_->posts()})
                  : nullptr),
      window_(terrain_->window_of(window)) {
    if (around_) window_over(around_->grid(), terrain_->grid(), window_);  // or it throws
}

void SunPlan::divide_all(std::size_t first, const Window& window, double tolerance_rad) {
    parallel_for(static_cast<int>(first), static_cast<int>(suns_.size()), 1,
                 [&](int begin, int end) {
                     for (int i = begin; i < end; ++i) {
                         PlannedSun& sun = suns_[static_cast<std::size_t>(i)];
                         sun.tiles = divide(sun.field, window, window_, tolerance_rad);
                         if (around_) sun.around = sun_around(sun, tolerance_rad);
                     }
                 });
}

PlannedSun SunPlan::planned(SunField field, const Window& window, double tolerance_rad) const {
    PlannedSun sun{0, std::move(field)};
    sun.tiles = divide(sun.field, window, window_, tolerance_rad);
    if (around_) sun.around = sun_around(sun, tolerance_rad);
    return sun;
}

std::shared_ptr<const PlannedSun> SunPlan::sun_around(const PlannedSun& sun,
                                                      double tolerance_rad) const {
    const Window under = window_over(around_->grid(), terrain_->grid(), window_);
    PlannedSun outer{sun.at_s, sun.field.over(*around_), sun.semidiameter_rad};
    outer.tiles = divide(outer.field, under, under, tolerance_rad);
    return std::make_shared<const PlannedSun>(std::move(outer));
}

void SunPlan::add_suns(const geo::Geodetic& place, const std::vector<SunOverDem>& suns) {
    const std::size_t first = suns_.size();
    for (const SunOverDem& sun : suns)
        suns_.push_back({0, SunField(*terrain_, place, sun), sun.semidiameter_rad});
    divide_all(first, terrain_->window(), kSunTolerance_rad);
}

void SunPlan::add_directions(const std::vector<double>& azimuth_rad, double tolerance_rad) {
    const std::size_t first = suns_.size();
    for (const double azimuth : azimuth_rad)
        suns_.push_back({0, SunField(*terrain_, azimuth)});
    divide_all(first, terrain_->window(), tolerance_rad);
}

std::vector<Window> SunPlan::blocks(const SunTerrain& terrain) {
    constexpr double kBlock_m = 200e3;
    const Window all = terrain.window();
    const glm::dvec2& spacing_m = terrain.spacing_m();
    const int columns = std::max(1, static_cast<int>(kBlock_m / spacing_m.x)),
              rows = std::max(1, static_cast<int>(kBlock_m / spacing_m.y));
    std::vector<Window> blocks;
    for (int row = all.row; row < all.end_row(); row += rows)
        for (int column = all.column; column < all.end_column(); column += columns)
            blocks.push_back(common(all, {column, row, columns, rows}));
    return blocks;
}

void SunPlan::add_level_directions(const std::vector<double>& azimuth_rad, double tolerance_rad) {
    for (const Window& block : blocks(*terrain_)) {
        if (common(block, window_).is_empty()) continue;
        const std::size_t first = suns_.size();
        const geo::Geodetic middle = terrain_->grid().place(
            block.column + (block.columns - 1) / 2.0, block.row + (block.rows - 1) / 2.0);
        for (const double azimuth : azimuth_rad)
            suns_.push_back({0, SunField::level(*terrain_, middle, azimuth)});
        divide_all(first, block, tolerance_rad);
    }
}

void SunPlan::add_time(sun::Instant begin, double length_s, double step_s) {
    const geo::Geodetic& middle = terrain_->marks()[4];
    const sun::PositionTable table(begin, begin + length_s);
    const sun::Observer observer(middle);
    const double turn = turn_rad(*terrain_), lowest_rad = terrain_->lowest_sun_rad() - turn;
    const auto is_low = [&](const SunOverDem& sun) {
        return sun.elevation_rad > lowest_rad && sun.elevation_rad < kLow_rad + turn;
    };
    // Every step, and between two of them the parts at either end of which the sun is low.
    std::vector<std::pair<double, SunOverDem>> moments{{0, sun_at(table, begin, observer)}};
    const auto steps = static_cast<int>(std::ceil(length_s / step_s - 1e-9));
    const int parts = finer(step_s);
    for (int k = 1; k <= steps; ++k) {
        const double from_s = (k - 1) * step_s, to_s = std::min(k * step_s, length_s);
        for (int part = 1; part <= parts; ++part) {
            const double at_s = part == parts ? to_s : from_s + (to_s - from_s) * part / parts;
            const auto next = std::pair(at_s, sun_at(table, begin + at_s, observer));
            const double after_s = std::min(at_s + (to_s - from_s) / parts, length_s);
            if (part == parts || is_low(next.second) ||
                is_low(sun_at(table, begin + after_s, observer)) || is_low(moments.back().second))
                moments.push_back(next);
        }
    }
    std::vector<PlannedSun> suns;
    std::vector<bool> night;
    for (const auto& [at_s, sun] : moments) {
        suns.push_back({at_s, SunField(*terrain_, middle, sun)});
        night.push_back(suns.back().field.is_night());
    }
    const std::size_t first = suns_.size();
    for (std::size_t k = 0; k < suns.size(); ++k)
        if (!night[k] || (k > 0 && !night[k - 1]) || (k + 1 < suns.size() && !night[k + 1]))
            suns_.push_back(std::move(suns[k]));
    divide_all(first, terrain_->window(), kSunTolerance_rad);
}

int SunPlan::most_tiles() const {
    std::size_t most = 0;
    for (const PlannedSun& sun : suns_)
        most = std::max(most, sun.tiles.size());
    return static_cast<int>(most);
}

}  // namespace relevo::light
