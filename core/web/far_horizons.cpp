#include "web/far_horizons.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "light/point/horizon.h"
#include "output/exported_ground.h"

namespace relevo::web {
namespace {

/// Posts of a grid around a part of it.
dem::Window window_around(const dem::Grid& all, const dem::Grid& part) {
    glm::dvec2 low(kInfinity), high(-kInfinity);
    for (const double row : {0.0, part.rows() - 1.0})
        for (const double column : {0.0, part.columns() - 1.0}) {
            const glm::dvec2 post = all.post(part.place(column, row));
            low = glm::min(low, post);
            high = glm::max(high, post);
        }
    const glm::dvec2 reach = GroundAround::kReach_m / all.post_spacing_m();
    const glm::dvec2 last(all.columns() - 1, all.rows() - 1);
    const glm::ivec2 first(glm::clamp(glm::floor(low - reach), glm::dvec2(0), last));
    const glm::ivec2 end(glm::clamp(glm::ceil(high + reach), glm::dvec2(0), last));
    return {first.x, first.y, end.x - first.x + 1, end.y - first.y + 1};
}

std::uint8_t step_of(double distance_m) {
    constexpr double kLast = 255;
    if (std::isnan(distance_m)) return static_cast<std::uint8_t>(kLast);
    const double step =
        std::log(distance_m / FarHorizons::kNearest_m) / std::log(FarHorizons::kStep);
    return static_cast<std::uint8_t>(std::lround(std::clamp(step, 0.0, kLast)));
}

}  // namespace

GroundAround::GroundAround(dem::Heightfield field)
    : field_(std::move(field)), posts_(std::make_shared<const dem::Posts>(field_)) {}

std::unique_ptr<const GroundAround> GroundAround::of(std::span<const std::string> paths,
                                                     const dem::LoadOptions& options,
                                                     const dem::Grid& part) {
    if (options.crop.empty()) return nullptr;
    dem::LoadOptions whole = options;
    whole.crop.clear();
    const dem::Source source = dem::Source::open(paths, whole);
    const dem::Window window = window_around(source.grid(), part);
    const double posts = double{1} * window.columns * window.rows;
    const double share = std::min(1.0, std::sqrt(kMostPosts / posts));
    const int columns = std::max(2, static_cast<int>(window.columns * share));
    const int rows = std::max(2, static_cast<int>(window.rows * share));
    dem::Heightfield field{source.read(window, columns, rows),
                           source.grid().part(window, columns, rows), source.description(), 1};
    field.about.statistics = dem::statistics(field.height_m);
    return std::unique_ptr<const GroundAround>(new GroundAround(std::move(field)));
}

FarHorizons GroundAround::horizons(const dem::Heightfield& ground) const {
    constexpr int kNodes = FarHorizons::kNodes;
    dem::Heightfield low = output::stretched(ground, {kNodes, kNodes});
    const std::vector<float> eyes_m(low.height_m.begin(), low.height_m.end());
    // Ground that hides nothing; its outline is the ground's.
    const float lowest_m = dem::statistics(ground.height_m).min_m;
    std::ranges::fill(low.height_m, lowest_m);
    low.about.statistics = dem::statistics(low.height_m);
    const dem::Posts posts = dem::Posts(low).in(posts_);
    FarHorizons far;
    for (int i = 0; i < kNodes * kNodes; ++i) {
        const float eye_m = eyes_m[static_cast<std::size_t>(i)];
        const light::TerrainHorizon horizon(
            posts, low.grid.place(i % kNodes, i / kNodes),
            {.eye_height_m = std::isnan(eye_m) ? lowest_m : eye_m, .eye_above_ground = false});
        for (const light::HorizonPoint& point : horizon.profile(FarHorizons::kAzimuths)) {
            far.hundredths.push_back(
                static_cast<std::int16_t>(std::lround(100 * degrees(point.elevation_rad))));
            far.steps.push_back(step_of(point.distance_m));
        }
    }
    return far;
}

}  // namespace relevo::web
