#include "light/raster/outer_horizon.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/parallel_for.h"
#include "light/raster/ground_beyond.h"
#include "light/raster/post_loops.h"

namespace relevo::light {
namespace {

constexpr int kSuns = 128;   // of which shadows are found
constexpr float kNone = -1;  // the tangent of no horizon

/// The widest that ground beyond a site can stand over the horizon of its posts: as high as the
/// relief, right behind the site's edge.
double steepest(const SunTerrain& site, const Window& window) {
    const Window all = site.whole_grid();
    const double beside = std::min({(window.column - all.column) * site.spacing_m().x,
                                    (all.end_column() - window.end_column()) * site.spacing_m().x,
                                    (window.row - all.row) * site.spacing_m().y,
                                    (all.end_row() - window.end_row()) * site.spacing_m().y});
    return site.relief_m() / std::max(beside, site.widest_spacing_m());
}

/// A sun over a tile's reference: as seen from other posts it is the higher the farther they are
/// towards it.
SweepSun sun_of(const SunTerrain& terrain, const SunTile& tile, double tangent) {
    const glm::dvec2 &first = tile.ray.first, &spacing_m = terrain.spacing_m();
    const glm::dvec2 along = first * spacing_m * spacing_m;
    return {tile.ray, tangent, along * (terrain.curvature() / glm::dot(along, first))};
}

}  // namespace

OtherGrid::OtherGrid(const dem::Grid& from, const dem::Grid& to)
    : from_(from), to_(to), middle_(to.post(from.center())) {
    is_linear_ = from.crs().text() == to.crs().text() && !to.columns_per_turn();
    if (!is_linear_) return;
    const auto there = [&](double column, double row) {
        return to.affine().inverse(from.affine()(column, row));
    };
    origin_ = there(0, 0);
    const double columns = from.columns(), rows = from.rows();
    a_column_ = (there(columns, 0) - origin_) / columns;
    a_row_ = (there(0, rows) - origin_) / rows;
}

glm::dvec2 OtherGrid::post(double column, double row) const {
    if (is_linear_) return origin_ + a_column_ * column + a_row_ * row;
    return to_.post(from_.place(column, row), middle_);
}

OuterHorizon::OuterHorizon(const PlannedSun& around, const SunTerrain& site, const Window& window)
    : other_(site.grid(), around.field.terrain().grid()),
      window_(window_over(around.field.terrain().grid(), site.grid(), window)),
      tangents_(static_cast<std::size_t>(window_.columns) * static_cast<std::size_t>(window_.rows) *
                    kHeights,
                kNone) {
    find_heights(site, window);
    const double highest = highest_tangent(around, steepest(site, window)),
                 lowest = -1.05 * std::sqrt(2 * site.curvature() * site.relief_m());
    std::vector<double> tangents;
    for (int k = 0; k < kSuns; ++k) {
        // Denser where horizons are low, as those of far ground are.
        const double share = double(k) / (kSuns - 1);
        tangents.push_back(lowest + (highest - lowest) * share * (0.5 + 0.5 * share));
    }
    parallel_for(0, static_cast<int>(around.tiles.size()), 1, [&](int first, int last) {
        for (int i = first; i < last; ++i)
            add_tile(around, around.tiles[static_cast<std::size_t>(i)], tangents);
    });
    for (const float tangent : tangents_)
        highest_ = std::max(highest_, tangent);
}

void OuterHorizon::find_heights(const SunTerrain& site, const Window& window) {
    const WindowHeights heights(site.posts(), window);
    float lowest_m = std::numeric_limits<float>::infinity(), highest_m = -lowest_m;
    for (int row = window.row; row < window.end_row(); ++row)
        for (int column = window.column; column < window.end_column(); ++column) {
            const float height_m = heights.at(column, row);
            lowest_m = std::min(lowest_m, height_m);  // a hole, NaN, changes nothing
            highest_m = std::max(highest_m, height_m);
        }
    if (!(lowest_m <= highest_m)) lowest_m = highest_m = 0;
    lowest_m_ = lowest_m;
    step_m_ = std::max(0.01F, (highest_m - lowest_m) / (kHeights - 1));
}

double OuterHorizon::highest_tangent(const PlannedSun& around, double steepest) const {
    constexpr double kStep = 0.75, kLeast = 1e-3;
    double tangent = steepest;
    while (tangent > kLeast && !is_shaded(around, kStep * tangent))
        tangent *= kStep;
    return tangent;
}

bool OuterHorizon::is_shaded(const PlannedSun& around, double tangent) const {
    std::atomic<bool> is = false;
    for (const SunTile& tile : around.tiles) {
        TilePosts posts = tile.posts;
        posts.window = common(posts.window, window_);
        if (posts.window.is_empty()) continue;
        const SunTerrain& terrain = around.field.terrain();
        terrain.sweep().each_shadow(sun_of(terrain, tile, tangent), posts, floor_m(),
                                    [&](const SweepRun& run) {
                                        for (int i = 0; i < run.count; ++i)
                                            if (run.found[i] >= lowest_m_) is = true;
                                    });
    }
    return is;
}

void OuterHorizon::add_tile(const PlannedSun& around, const SunTile& tile,
                            const std::vector<double>& tangents) {
    const SunTerrain& terrain = around.field.terrain();
    TilePosts posts = tile.posts;
    posts.window = common(posts.window, window_);
    if (posts.window.is_empty()) return;
    const Window& part = posts.window;
    const std::size_t each = tangents.size();
    std::vector<float> shadows_m(
        static_cast<std::size_t>(part.columns) * static_cast<std::size_t>(part.rows) * each,
        -std::numeric_limits<float>::infinity());
    for (std::size_t k = 0; k < each; ++k)
        terrain.sweep().each_shadow(
            sun_of(terrain, tile, tangents[k]), posts, floor_m(), [&](const SweepRun& run) {
                float* to = &shadows_m[(static_cast<std::size_t>(run.row - part.row) *
                                            static_cast<std::size_t>(part.columns) +
                                        static_cast<std::size_t>(run.column - part.column)) *
                                           each +
                                       k];
                for (int i = 0; i < run.count; ++i, to += each)
                    *to = run.found[i];
            });
    keep_horizons(terrain, tile, part, tangents, shadows_m);
}

void OuterHorizon::keep_horizons(const SunTerrain& terrain, const SunTile& tile, const Window& part,
                                 const std::vector<double>& tangents,
                                 const std::vector<float>& shadows_m) {
    const GroundBeyond beyond(terrain.posts(), tile, terrain.horizon_reach_m());
    const std::size_t each = tangents.size();
    std::array<float, kHeights> eye_m, edge_m, edge_at_m, found;
    for (int k = 0; k < kHeights; ++k)
        eye_m[static_cast<std::size_t>(k)] = lowest_m_ + step_m_ * static_cast<float>(k);
    const float* shadow_m = shadows_m.data();
    for (int row = part.row; row < part.end_row(); ++row)
        for (int column = part.column; column < part.end_column(); ++column, shadow_m += each) {
            if (std::isinf(*shadow_m)) continue;  // another tile's
            const double lift = sun_of(terrain, tile, 0).tangent_at(column, row);
            std::size_t sun = each - 1;  // the higher an eye, the lower the sun that it sees shaded
            for (std::size_t k = 0; k < kHeights; ++k) {
                while (sun > 0 && shadow_m[sun] < eye_m[k])
                    --sun;
                found[k] = kNone;
                if (shadow_m[sun] < eye_m[k]) continue;
                double tangent = tangents[sun];
                if (sun + 1 < each) {
                    const float over = shadow_m[sun], under = shadow_m[sun + 1];
                    tangent += (tangents[sun + 1] - tangents[sun]) *
                               double((over - eye_m[k]) / (over - under));
                }
                found[k] = static_cast<float>(tangent + lift);
            }
            beyond.find(row, column, 1, edge_m.data(), edge_at_m.data());
            edge_m.fill(edge_m.front());
            edge_at_m.fill(edge_at_m.front());
            raise_to_dip(found.data(), eye_m.data(), edge_m.data(), edge_at_m.data(), kHeights,
                         static_cast<float>(terrain.curvature()),
                         static_cast<float>(terrain.lowest_m()), horizons_at(column, row));
        }
}

void OuterHorizon::raise(int row, int column, int count, const float* height_m,
                         float* tangent) const {
    const glm::dvec2 corner(window_.column, window_.row);
    const glm::dvec2 first = other_.post(column, row) - corner,
                     last = other_.post(column + count, row) - corner;
    const float a_metre = 1 / step_m_;
    for (int i = 0; i < count; ++i) {
        if (!(tangent[i] < highest_)) continue;  // holes, too
        const glm::dvec2 post = first + (last - first) * (double(i) / count);
        const int x = std::clamp(static_cast<int>(post.x), 0, window_.columns - 2),
                  y = std::clamp(static_cast<int>(post.y), 0, window_.rows - 2);
        const float u = static_cast<float>(post.x) - static_cast<float>(x),
                    v = static_cast<float>(post.y) - static_cast<float>(y);
        const float level =
            std::clamp((height_m[i] - lowest_m_) * a_metre, 0.0F, kHeights - 1.001F);
        const auto entry = static_cast<std::size_t>(level);
        const float part = level - static_cast<float>(entry);
        const auto at = [&](int dx, int dy) {
            const float* const of = &tangents_[(static_cast<std::size_t>(y + dy) *
                                                    static_cast<std::size_t>(window_.columns) +
                                                static_cast<std::size_t>(x + dx)) *
                                                   kHeights +
                                               entry];
            return of[0] + part * (of[1] - of[0]);
        };
        const float upper = at(0, 0) + u * (at(1, 0) - at(0, 0)),
                    lower = at(0, 1) + u * (at(1, 1) - at(0, 1));
        tangent[i] = std::max(tangent[i], upper + v * (lower - upper));
    }
}

}  // namespace relevo::light
