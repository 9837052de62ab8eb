#include "light/raster/sun_terrain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "base/array2d.h"
#include "base/error.h"
#include "base/units.h"
#include "dem/surroundings.h"
#include "geo/ellipsoid.h"
#include "light/point/edge_ground.h"

namespace relevo::light {
namespace {

constexpr double kAirTolerance_rad = radians(0.02);  // five seconds of the sun's way

/// The larger grid: a DEM with a rim, or one that goes round the Earth and some columns more.
/// @param rimmed  null: no rim
std::optional<dem::Posts> larger(const dem::Posts& posts, const glm::ivec2& before,
                                 const dem::Heightfield* rimmed) {
    if (rimmed) return dem::Posts(*rimmed);
    if (before.x == 0) return std::nullopt;
    return dem::Posts::unrolled(posts, -before.x, posts.grid().columns() + 2 * before.x);
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

/// The posts of a wider DEM whose ground is left to a site: those on it, where it has heights, but
/// for the ones next to its edge, so that ground between a post on it and one beside it is kept.
Array2d<std::uint8_t> hidden_posts(const dem::Posts& site, const dem::Grid& wider,
                                   const Window& box) {
    Array2d<std::uint8_t> on_site(box.columns, box.rows, 0), hidden = on_site;
    const dem::Grid& grid = site.grid();
    for (int y = 0; y < box.rows; ++y)
        for (int x = 0; x < box.columns; ++x) {
            const glm::dvec2 post = grid.post(wider.place(box.column + x, box.row + y));
            if (!is_on(grid, post)) continue;
            const int column = static_cast<int>(std::lround(post.x)),
                      row = static_cast<int>(std::lround(post.y));
            on_site.at(x, y) =
                !std::isnan(site.thinned_m(column, row)) || !site.is_outside(column, row);
        }
    for (int y = 1; y < box.rows - 1; ++y)
        for (int x = 1; x < box.columns - 1; ++x)
            hidden.at(x, y) = on_site.at(x - 1, y) != 0 && on_site.at(x + 1, y) != 0 &&
                              on_site.at(x, y - 1) != 0 && on_site.at(x, y + 1) != 0;
    return hidden;
}

/// Where a window of a grid lies on another one, its middle as it is nearest.
struct Box {
    glm::dvec2 low, high;

    /// Its posts and those around it, as far as the grid goes.
    Window window(const dem::Grid& grid) const {
        // Sides of a window are bent between the samples.
        const glm::ivec2 first = glm::ivec2(low) - 2, last = glm::ivec2(high) + 3;
        return common({first.x, first.y, last.x - first.x + 1, last.y - first.y + 1},
                      {0, 0, grid.columns(), grid.rows()});
    }
};

Box box_over(const dem::Grid& grid, const dem::Grid& of, const Window& window) {
    constexpr int kSteps = 16;
    const glm::dvec2 middle = grid.post(of.center());
    Box box{middle, middle};
    for (int i = 0; i <= kSteps; ++i)
        for (int k = 0; k <= kSteps; ++k) {
            const glm::dvec2 post =
                grid.post(of.place(window.column + double(window.columns - 1) * i / kSteps,
                                   window.row + double(window.rows - 1) * k / kSteps),
                          middle);
            if (i == 0 && k == 0) box = {post, post};
            box = {glm::min(box.low, post), glm::max(box.high, post)};
        }
    return box;
}

/// Of the ground around a site: its own posts are holes here.
Sweep sweep_around(const dem::Posts& site, const dem::Posts& posts) {
    const dem::Grid& grid = posts.grid();
    // A rim may go on beyond the wider DEM.
    const Window box =
        box_over(grid, site.grid(), {0, 0, site.grid().columns(), site.grid().rows()}).window(grid);
    const auto hidden =
        std::make_shared<const Array2d<std::uint8_t>>(hidden_posts(site, grid, box));
    const auto read = [&posts, box, hidden](const Window& window, std::vector<float>& buffer) {
        std::vector<float> unused;
        const dem::Posts::View view = posts.view(window, unused);
        buffer.resize(static_cast<std::size_t>(window.columns) *
                      static_cast<std::size_t>(window.rows));
        float* to = buffer.data();
        for (int row = window.row; row < window.end_row(); ++row, to += window.columns)
            std::copy_n(view.at(window.column, row), window.columns, to);
        const Window both = common(window, box);
        for (int row = both.row; row < both.end_row(); ++row)
            for (int column = both.column; column < both.end_column(); ++column)
                if (hidden->at(column - box.column, row - box.row) != 0)
                    buffer[static_cast<std::size_t>(row - window.row) *
                               static_cast<std::size_t>(window.columns) +
                           static_cast<std::size_t>(column - window.column)] =
                        std::numeric_limits<float>::quiet_NaN();
        return Sweep::Heights{buffer.data(), window.columns};
    };
    return Sweep(read, grid.columns(), grid.rows(), posts.lowest_m(), posts.highest_m());
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

double curvature_of(double refraction) {
    return (1 - checked(refraction)) / geo::kEquatorialRadius_m;
}

double relief_of(const dem::Posts& posts) {
    return double{posts.highest_m()} - posts.lowest_m();
}

double reach_of_horizon_m(double relief_m, double curvature) {
    // Both at the highest post see each other no farther than this, and any others less far.
    return 2.05 * std::sqrt(2 * relief_m / curvature);
}

}  // namespace

double shade_reach_m(double relief_m, double curvature, double apparent_rad) {
    const double t = std::tan(std::min(apparent_rad, radians(89.9)));
    return (std::sqrt(t * t + 2 * curvature * relief_m) - t) / curvature;
}

Window window_over(const dem::Grid& grid, const dem::Grid& of, const Window& window) {
    const Box box = box_over(grid, of, window);
    if (!is_on(grid, box.low) || !is_on(grid, box.high))
        bad_input("sun: the wider DEM does not contain all of the DEM in it");
    return box.window(grid);
}

SunTerrain::SunTerrain(const dem::Posts& posts, const LightPath& path, bool with_discs,
                       const Nesting& nesting)
    : given_(posts),
      before_(nesting.around && posts.rim() > 0
                  ? glm::ivec2(posts.rim())
                  : glm::ivec2(posts.grid().columns_per_turn().value_or(0) / 2, 0)),
      rimmed_(before_.y > 0 ? std::make_unique<const dem::Heightfield>(dem::rimmed(posts))
                            : nullptr),
      larger_(larger(posts, before_, rimmed_.get())),
      posts_(larger_ ? *larger_ : posts),
      is_nested_(nesting.around != nullptr),
      sweep_(nesting.site ? sweep_around(*nesting.site, posts_) : sweep_over(posts_)),
      spacing_m_(posts.grid().post_spacing_m()),
      marks_(marks_of(posts.grid())),
      frame_(posts.grid().center()),
      curvature_(curvature_of(path.refraction)),
      lowest_m_(posts.lowest_m()),
      relief_m_(relief_of(posts)) {
    if (const dem::Posts* const other = nesting.other()) {
        lowest_m_ = std::min(posts.lowest_m(), other->lowest_m());
        relief_m_ = std::max(posts.highest_m(), other->highest_m()) - lowest_m_;
    }
    floor_m_ = floor_under(static_cast<float>(lowest_m_), relief_m_, curvature_, with_discs);
    if (!path.air) return;
    for (const double height_m : {lowest_m_, lowest_m_ + relief_m_}) {
        geo::Geodetic place = grid().center();
        place.height_m = height_m;
        airs_.push_back(path.air(place));
    }
}

double shade_reach_m(const dem::Posts& posts, double refraction, double apparent_rad) {
    return shade_reach_m(relief_of(posts), curvature_of(refraction), apparent_rad);
}

double horizon_reach_m(const dem::Posts& posts, double refraction) {
    return reach_of_horizon_m(relief_of(posts), curvature_of(refraction));
}

double SunTerrain::horizon_reach_m() const {
    return reach_of_horizon_m(relief_m_, curvature_);
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
