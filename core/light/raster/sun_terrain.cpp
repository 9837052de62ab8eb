#include "light/raster/sun_terrain.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "geo/ellipsoid.h"

namespace relevo::light {
namespace {

constexpr double kAirTolerance_rad = radians(0.02);  // five seconds of the sun's way

/// A DEM that goes round the Earth, with some columns more on either side.
std::optional<dem::Posts> unrolled(const dem::Posts& posts, int columns) {
    if (columns == 0) return std::nullopt;
    return dem::Posts::unrolled(posts, -columns, posts.grid().columns() + 2 * columns);
}

Sweep sweep_over(const dem::Posts& posts) {
    const int columns = posts.grid().columns(), rows = posts.grid().rows();
    if (!posts.in_memory())
        return Sweep(
            [&posts](const Window& window, std::vector<float>& buffer) -> Sweep::Heights {
                const dem::Posts::View view = posts.view(window, buffer);
                return {view.at(window.column, window.row), view.stride};
            },
            columns, rows, posts.lowest_m(), posts.highest_m());
    std::vector<float> unused;
    const dem::Posts::View all = posts.view({0, 0, columns, rows}, unused);
    return Sweep(all.first_m, columns, rows, all.stride);
}

std::array<geo::Geodetic, 9> marks_of(const dem::Grid& grid) {
    std::array<geo::Geodetic, 9> marks;
    for (int i = 0; i < 9; ++i)
        marks[static_cast<std::size_t>(i)] =
            grid.place((grid.columns() - 1) * (i % 3) / 2.0, (grid.rows() - 1) * (i / 3) / 2.0);
    return marks;
}

float floor_under(float lowest_m, double relief_m, double curvature, bool with_discs) {
    // Rays of the disc's upper and lower limb part by its width with each metre, and meet ground no
    // farther off than that which sees the smooth Earth's horizon from both sides.
    constexpr double kDisc_rad = 0.0095;
    const double farthest_m = 2 * std::sqrt(2 * relief_m / curvature);
    const double under_m = 50 + relief_m / 4 + (with_discs ? kDisc_rad * farthest_m : 0);
    return static_cast<float>(lowest_m - under_m);
}

double checked(double refraction) {
    if (refraction >= -1 && refraction <= 0.9) return refraction;
    bad_input(
        fmt::format("horizon: refraction {:.10g}: impossible, expected -1 to 0.9 of the "
                    "Earth's curvature; 0.13 is the mean",
                    refraction));
}

}  // namespace

SunTerrain::SunTerrain(const dem::Posts& posts, const LightPath& path, bool with_discs)
    : given_(posts),
      before_(posts.grid().columns_round().value_or(0) / 2),
      unrolled_(unrolled(posts, before_)),
      posts_(unrolled_ ? *unrolled_ : posts),
      sweep_(sweep_over(posts_)),
      spacing_m_(posts.grid().post_spacing_m()),
      marks_(marks_of(posts.grid())),
      frame_(posts.grid().center()),
      curvature_((1 - checked(path.refraction)) / geo::kEquatorialRadius_m),
      relief_m_(double{posts.highest_m()} - posts.lowest_m()),
      floor_m_(floor_under(posts.lowest_m(), relief_m_, curvature_, with_discs)) {
    if (!path.air) return;
    for (const float height_m : {posts.lowest_m(), posts.highest_m()}) {
        geo::Geodetic place = grid().center();
        place.height_m = height_m;
        airs_.push_back(path.air(place));
    }
}

double SunTerrain::horizon_reach_m() const {
    // Both at the highest post see each other no farther than this, and any others less far.
    return 2.05 * std::sqrt(2 * relief_m_ / curvature_);
}

double SunTerrain::lowest_sun_rad() const {
    return -std::sqrt(2 * curvature_ * relief_m_) - radians(0.7);
}

double SunTerrain::apparent_rad(double elevation_rad, Air air) const {
    if (airs_.empty()) return elevation_rad;
    if (air != kMean) return airs_[air].apparent_rad(elevation_rad);
    return (airs_[0].apparent_rad(elevation_rad) + airs_[1].apparent_rad(elevation_rad)) / 2;
}

bool SunTerrain::airs_differ(double elevation_rad) const {
    return std::abs(apparent_rad(elevation_rad, kOfHighest) -
                    apparent_rad(elevation_rad, kOfLowest)) > 2 * kAirTolerance_rad;
}

WindowHeights::WindowHeights(const dem::Posts& posts, const Window& window) {
    const Window around{window.column - 1, window.row - 1, window.columns + 2, window.rows + 2};
    view = posts.view(common(around, {0, 0, posts.grid().columns(), posts.grid().rows()}), buffer);
}

}  // namespace relevo::light
