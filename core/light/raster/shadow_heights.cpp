#include "light/raster/shadow_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/array2d.h"
#include "base/parallel_for.h"
#include "light/raster/ground_beyond.h"
#include "light/raster/post_loops.h"

namespace relevo::light {
namespace {

constexpr int kRun = kLongestRun;
using Figures = std::array<float, kRun>;

/// Calls `use` with parts of a run; figures for which `fill` puts into an array.
template <typename Fill>
void each_part(const SweepRun& run, const Fill& fill, const Sweep::Use& use) {
    Figures figures;
    for (int done = 0; done < run.count; done += kRun) {
        const SweepRun part{run.row, run.column + done, std::min(run.count - done, kRun),
                            run.found + done};
        fill(part, figures.data());
        use({part.row, part.column, part.count, figures.data()});
    }
}

void each_tile(std::span<const SunTile> tiles, const Window& window,
               const std::function<void(const SunTile&, const TilePosts&)>& body) {
    parallel_for(0, static_cast<int>(tiles.size()), 1, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const SunTile& tile = tiles[static_cast<std::size_t>(i)];
            TilePosts posts = tile.posts;
            posts.window = common(posts.window, window);
            if (!posts.window.is_empty()) body(tile, posts);
        }
    });
}

double lowest_tangent(const SweepSun& sun, const Window& w) {
    double lowest = sun.tangent;
    for (const int column : {w.column, w.end_column()})
        for (const int row : {w.row, w.end_row()})
            lowest = std::min(lowest, sun.tangent_at(column, row));
    return lowest;
}

/// The shadow of the Earth around a DEM: of ground that is as high as the DEM's edge, from there
/// on.
class EarthShadow {
  public:
    EarthShadow(const SunTerrain& terrain, const SunTile& tile, const SweepSun& sun)
        : terrain_(terrain), sun_(sun) {
        const double curvature = terrain.curvature(),
                     lowest = lowest_tangent(sun, tile.posts.window);
        // For suns that are higher it is lower than the floor.
        const double highest = std::sqrt(2 * curvature * (terrain.lowest_m() - terrain.floor_m()));
        if (lowest < highest)
            beyond_.emplace(terrain.posts(), tile, (highest - std::min(lowest, 0.0)) / curvature);
    }
    bool matters() const { return beyond_.has_value(); }

    /// Raises shadows to it.
    void add(const SweepRun& run, float* shadow_m) const {
        if (!matters()) return;
        Figures edge_m, edge_at_m;
        beyond_->find(run.row, run.column, run.count, edge_m.data(), edge_at_m.data());
        const auto c = static_cast<float>(terrain_.curvature()),
                   lowest_m = static_cast<float>(terrain_.lowest_m());
        for (int i = 0; i < run.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const auto t = static_cast<float>(sun_.tangent_at(run.column + i, run.row));
            const float level_m = std::max(edge_m[k], lowest_m);
            // A ray has fallen by t * s + c * s * s / 2 since it was over ground s metres off; what
            // it met last is the edge, or where it was level. Suns over the horizon meet nothing:
            // their shadow lies as deep as those of suns as far under it are high.
            const float s = std::max({edge_at_m[k], -t / c, 0.0F});
            const float fallen_m =
                std::max(t * s + c * s * s / 2, t > 0 ? t * t / (2 * c) : -kFar_m);
            shadow_m[i] = std::max(shadow_m[i], level_m - fallen_m);
        }
    }

  private:
    static constexpr float kFar_m = 1e9F;

    const SunTerrain& terrain_;
    SweepSun sun_;
    std::optional<GroundBeyond> beyond_;
};

/// Shadows between those in the air of the lowest post and in that of the highest one, by the
/// posts' own heights.
/// @param shadow_m  in the air of the highest
void mix(const SunTerrain& terrain, const float* height_m, const float* low_m, int count,
         float* shadow_m) {
    const auto bottom_m = static_cast<float>(terrain.lowest_m()),
               part = static_cast<float>(1 / terrain.relief_m());
    for (int i = 0; i < count; ++i)
        shadow_m[i] = low_m[i] + (height_m[i] - bottom_m) * part * (shadow_m[i] - low_m[i]);
}

/// Posts that see no sun: a shadow that is over all of them.
void each_night(const Window& window, const Sweep::Use& use) {
    Figures shadow_m;
    shadow_m.fill(1e9F);
    for (int row = window.row; row < window.end_row(); ++row)
        for (int column = window.column; column < window.end_column(); column += kRun)
            use({row, column, std::min(kRun, window.end_column() - column), shadow_m.data()});
}

void each_shadow_of_two_airs(const SunField& field, const SunTile& tile, const TilePosts& posts,
                             double offset_rad, const Sweep::Use& use) {
    const SunTerrain& terrain = field.terrain();
    const Window& w = posts.window;
    const SweepSun low = field.sun(tile, SunTerrain::kOfLowest, offset_rad),
                   high = field.sun(tile, SunTerrain::kOfHighest, offset_rad);
    const EarthShadow low_earth(terrain, tile, low), high_earth(terrain, tile, high);
    Array2d<float> low_m(w.columns, w.rows);
    terrain.sweep().each_shadow(low, posts, terrain.floor_m(), [&](const SweepRun& run) {
        each_part(
            run,
            [&](const SweepRun& part, float* shadow_m) {
                std::copy_n(part.found, part.count, shadow_m);
                low_earth.add(part, shadow_m);
            },
            [&](const SweepRun& part) {
                std::copy_n(part.found, part.count,
                            &low_m.at(part.column - w.column, part.row - w.row));
            });
    });
    const WindowHeights heights(terrain.posts(), w);
    terrain.sweep().each_shadow(high, posts, terrain.floor_m(), [&](const SweepRun& run) {
        each_part(
            run,
            [&](const SweepRun& part, float* shadow_m) {
                std::copy_n(part.found, part.count, shadow_m);
                high_earth.add(part, shadow_m);
                mix(terrain, heights.view.at(part.column, part.row),
                    &low_m.at(part.column - w.column, part.row - w.row), part.count, shadow_m);
            },
            use);
    });
}

}  // namespace

void each_shadow(const SunField& field, std::span<const SunTile> tiles, const Window& window,
                 double offset_rad, const Sweep::Use& use) {
    const SunTerrain& terrain = field.terrain();
    each_tile(tiles, window, [&](const SunTile& tile, const TilePosts& posts) {
        if (tile.is_night) return each_night(posts.window, use);
        if (field.has_two_airs())
            return each_shadow_of_two_airs(field, tile, posts, offset_rad, use);
        const SweepSun sun = field.sun(tile, SunTerrain::kMean, offset_rad);
        const EarthShadow earth(terrain, tile, sun);
        if (!earth.matters())
            return terrain.sweep().each_shadow(sun, posts, terrain.floor_m(), use);
        terrain.sweep().each_shadow(sun, posts, terrain.floor_m(), [&](const SweepRun& run) {
            each_part(
                run,
                [&](const SweepRun& part, float* shadow_m) {
                    std::copy_n(part.found, part.count, shadow_m);
                    earth.add(part, shadow_m);
                },
                use);
        });
    });
}

void each_horizon(const SunField& direction, std::span<const SunTile> tiles, const Window& window,
                  const std::function<void(const SunTile&, const SweepRun&)>& use) {
    const SunTerrain& terrain = direction.terrain();
    const auto curvature = static_cast<float>(terrain.curvature());
    const auto lowest_m = static_cast<float>(terrain.lowest_m());
    each_tile(tiles, window, [&](const SunTile& tile, const TilePosts& posts) {
        const GroundBeyond beyond(terrain.posts(), tile, terrain.horizon_reach_m());
        const WindowHeights heights(terrain.posts(), posts.window);
        // No lower than that of the ground beyond the edge, as tangent_beyond() has it, nor than
        // the dip of a smooth Earth as high as the lowest post.
        const auto fill = [&](const SweepRun& run, float* tangent) {
            Figures height_m, distance_m;
            beyond.find(run.row, run.column, run.count, height_m.data(), distance_m.data());
            raise_to_dip(run.found, heights.view.at(run.column, run.row), height_m.data(),
                         distance_m.data(), run.count, curvature, lowest_m, tangent);
        };
        terrain.sweep().each_horizon(tile.ray, terrain.curvature(), terrain.horizon_reach_m(),
                                     posts, [&](const SweepRun& run) {
                                         each_part(run, fill,
                                                   [&](const SweepRun& part) { use(tile, part); });
                                     });
    });
}

}  // namespace relevo::light
