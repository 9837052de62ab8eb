#include "light/raster/shadow_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "base/array2d.h"
#include "base/parallel_for.h"
#include "light/raster/outer_horizon.h"
#include "light/raster/post_loops.h"

namespace relevo::light {
namespace {

constexpr int kRun = kLongestRun;
using Figures = std::array<float, kRun>;

/// Calls `body` with parts of a run that are no longer than kRun.
template <typename Body>
void each_part(const SweepRun& run, const Body& body) {
    for (int done = 0; done < run.count; done += kRun)
        body(SweepRun{run.row, run.column + done, std::min(run.count - done, kRun),
                      run.found + done});
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
        if (lowest < highest && !terrain.is_nested())
            beyond_.emplace(terrain.posts(), tile, (highest - std::min(lowest, 0.0)) / curvature);
    }
    bool matters() const { return beyond_.has_value(); }

    /// The shadows of a run, raised to it.
    void raise(const SweepRun& run, float* shadow_m) const {
        if (!matters()) {
            std::copy_n(run.found, run.count, shadow_m);
            return;
        }
        Figures edge_m, edge_at_m;
        beyond_->find(run.row, run.column, run.count, edge_m.data(), edge_at_m.data());
        // Counted from the reference, so that a post has the same bits in every run.
        const glm::dvec2& at = sun_.ray.reference;
        raise_to_earth(run.found, edge_m.data(), edge_at_m.data(), run.count,
                       {.base = static_cast<float>(sun_.tangent_at(at.x, run.row)),
                        .a_post = static_cast<float>(sun_.tangent_per_post.x),
                        .from = run.column - static_cast<int>(at.x),
                        .curvature = static_cast<float>(terrain_.curvature()),
                        .lowest_m = static_cast<float>(terrain_.lowest_m())},
                       shadow_m);
    }

    /// Of rows of a window of the grid, and of rows of a sweep's sheet.
    TileSweep::Earth tables(const Window& window, const ShadowTables& sweep) const {
        const glm::dvec2& at = sun_.ray.reference;
        TileSweep::Earth to;
        to.edge_height_m = beyond_->edge_heights_m();
        to.edge_distance_m = beyond_->edge_distances_m();
        const int first = sun_.ray.along_columns ? window.column : window.row,
                  end = first + (sun_.ray.along_columns ? window.columns : window.rows);
        for (int row = 0; row < std::ssize(sweep.rows) - 1; ++row) {
            const int k = sweep.orientation.grid_index(sweep.first_row + row);
            to.rows.push_back(k >= first && k < end ? beyond_->sweep_row(k)
                                                    : GroundBeyond::SweepRow{0, 0});
        }
        to.first_row = window.row;
        for (int row = window.row; row < window.end_row(); ++row)
            to.base.push_back(static_cast<float>(sun_.tangent_at(at.x, row)));
        to.reference_column = static_cast<int>(at.x);
        to.a_post = static_cast<float>(sun_.tangent_per_post.x);
        to.curvature = static_cast<float>(terrain_.curvature());
        to.lowest_m = static_cast<float>(terrain_.lowest_m());
        return to;
    }

  private:
    const SunTerrain& terrain_;
    SweepSun sun_;
    std::optional<GroundBeyond> beyond_;
};

/// Posts that see no sun: a shadow that is over all of them.
void each_night(const Window& window, const Sweep::Use& use) {
    Figures shadow_m;
    shadow_m.fill(1e9F);
    for (int row = window.row; row < window.end_row(); ++row)
        for (int column = window.column; column < window.end_column(); column += kRun)
            use({row, column, std::min(kRun, window.end_column() - column), shadow_m.data()});
}

/// @param low_m  room for a figure of each post of `w`, in which each tile has posts of its own
void each_shadow_of_two_airs(const SunField& field, const SunTile& tile, const TilePosts& posts,
                             double offset_rad, const Window& w, float* low_m,
                             const Sweep::Use& use) {
    const SunTerrain& terrain = field.terrain();
    const SweepSun low = field.sun(tile, SunTerrain::kOfLowest, offset_rad),
                   high = field.sun(tile, SunTerrain::kOfHighest, offset_rad);
    const auto low_of = [&](const SweepRun& run) {
        return low_m + std::ptrdiff_t{run.row - w.row} * w.columns + (run.column - w.column);
    };
    const EarthShadow low_earth(terrain, tile, low), high_earth(terrain, tile, high);
    terrain.sweep().each_shadow(low, posts, terrain.floor_m(), [&](const SweepRun& run) {
        each_part(run, [&](const SweepRun& part) { low_earth.raise(part, low_of(part)); });
    });
    const WindowHeights heights(terrain.posts(), posts.window);
    const auto bottom_m = static_cast<float>(terrain.lowest_m()),
               a_metre = static_cast<float>(1 / terrain.relief_m());
    terrain.sweep().each_shadow(high, posts, terrain.floor_m(), [&](const SweepRun& run) {
        each_part(run, [&](const SweepRun& part) {
            Figures shadow_m;
            high_earth.raise(part, shadow_m.data());
            mix_by_height(heights.view.at(part.column, part.row), bottom_m, a_metre, low_of(part),
                          part.count, shadow_m.data());
            use({part.row, part.column, part.count, shadow_m.data()});
        });
    });
}

/// The shadow of a wider DEM's ground over the posts of a site: between its own posts linear.
class OuterShadow {
  public:
    OuterShadow(const PlannedSun& around, const dem::Grid& site, const Window& window,
                double offset_rad)
        : other_(site, around.field.terrain().grid()),
          window_(window_over(around.field.terrain().grid(), site, window)),
          shadow_m_(window_.columns, window_.rows, kNone_m) {
        // Where no ground shades, floors of the two are not the same.
        const float floor_m = around.field.terrain().floor_m();
        each_shadow(around.field, around.tiles, window_, offset_rad, [&](const SweepRun& run) {
            float* const to = &shadow_m_.at(run.column - window_.column, run.row - window_.row);
            for (int i = 0; i < run.count; ++i)
                to[i] = run.found[i] > floor_m ? run.found[i] : kNone_m;
        });
    }

    /// @param shadow_m  gets the shadows of a run, raised to it
    void raise(const SweepRun& run, float* shadow_m) const {
        // Where posts are on the other grid is linear over a piece of a row.
        constexpr int kPiece = 64;
        for (int from = 0; from < run.count; from += kPiece) {
            const int count = std::min(kPiece, run.count - from);
            const auto other = [&](int i) {
                return other_.post(run.column + i, run.row) -
                       glm::dvec2(window_.column, window_.row);
            };
            const glm::dvec2 first = other(from), last = other(from + count);
            for (int i = 0; i < count; ++i)
                shadow_m[from + i] =
                    std::max(run.found[from + i], at(glm::mix(first, last, double(i) / count)));
        }
    }

  private:
    static constexpr float kNone_m = -1e9F;

    float at(const glm::dvec2& post) const {
        const int column = std::clamp(static_cast<int>(post.x), 0, window_.columns - 2),
                  row = std::clamp(static_cast<int>(post.y), 0, window_.rows - 2);
        const float u = static_cast<float>(post.x) - static_cast<float>(column),
                    v = static_cast<float>(post.y) - static_cast<float>(row);
        const auto between = [&](int r) {
            return std::lerp(shadow_m_.at(column, r), shadow_m_.at(column + 1, r), u);
        };
        return std::lerp(between(row), between(row + 1), v);
    }

    OtherGrid other_;
    Window window_;  // of the wider DEM
    Array2d<float> shadow_m_;
};

}  // namespace

void each_shadow(const SunField& field, std::span<const SunTile> tiles, const Window& window,
                 double offset_rad, const Sweep::Use& use) {
    const SunTerrain& terrain = field.terrain();
    std::unique_ptr<float[]> low_m;
    if (field.has_two_airs())
        low_m = std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(window.columns) *
                                                        static_cast<std::size_t>(window.rows));
    each_tile(tiles, window, [&](const SunTile& tile, const TilePosts& posts) {
        if (tile.is_night) return each_night(posts.window, use);
        if (field.has_two_airs())
            return each_shadow_of_two_airs(field, tile, posts, offset_rad, window, low_m.get(),
                                           use);
        const SweepSun sun = field.sun(tile, SunTerrain::kMean, offset_rad);
        const EarthShadow earth(terrain, tile, sun);
        if (!earth.matters())
            return terrain.sweep().each_shadow(sun, posts, terrain.floor_m(), use);
        terrain.sweep().each_shadow(sun, posts, terrain.floor_m(), [&](const SweepRun& run) {
            each_part(run, [&](const SweepRun& part) {
                Figures shadow_m;
                earth.raise(part, shadow_m.data());
                use({part.row, part.column, part.count, shadow_m.data()});
            });
        });
    });
}

TileSweep tile_sweep(const SunField& field, const SunTile& tile, const Window& window,
                     double offset_rad, SunTerrain::Air air) {
    const SunTerrain& terrain = field.terrain();
    TilePosts posts = tile.posts;
    posts.window = common(posts.window, window);
    const SweepSun sun = field.sun(tile, air, offset_rad);
    TileSweep found{terrain.sweep().shadow_tables(sun, posts, terrain.floor_m()), {}};
    if (const EarthShadow earth(terrain, tile, sun); earth.matters())
        found.earth = earth.tables(posts.window, found.tables);
    return found;
}

void each_shadow(const PlannedSun& sun, const Window& window, double offset_rad,
                 const Sweep::Use& use) {
    if (!sun.around) return each_shadow(sun.field, sun.tiles, window, offset_rad, use);
    const OuterShadow outer(*sun.around, sun.field.terrain().grid(), window, offset_rad);
    each_shadow(sun.field, sun.tiles, window, offset_rad, [&](const SweepRun& run) {
        each_part(run, [&](const SweepRun& part) {
            Figures shadow_m;
            outer.raise(part, shadow_m.data());
            use({part.row, part.column, part.count, shadow_m.data()});
        });
    });
}

void each_horizon(const SunField& direction, std::span<const SunTile> tiles, const Window& window,
                  const std::function<void(const SunTile&, const SweepRun&)>& use) {
    const SunTerrain& terrain = direction.terrain();
    const auto curvature = static_cast<float>(terrain.curvature());
    const auto lowest_m = static_cast<float>(terrain.lowest_m());
    each_tile(tiles, window, [&](const SunTile& tile, const TilePosts& posts) {
        std::optional<GroundBeyond> beyond;
        if (!terrain.is_nested()) beyond.emplace(terrain.posts(), tile, terrain.horizon_reach_m());
        const WindowHeights heights(terrain.posts(), posts.window);
        // No lower than that of the ground beyond the edge, as tangent_beyond() has it, nor than
        // the dip of a smooth Earth as high as the lowest post.
        const auto fill = [&](const SweepRun& run, float* tangent) {
            Figures height_m, distance_m;
            height_m.fill(-std::numeric_limits<float>::infinity());
            distance_m.fill(-std::numeric_limits<float>::infinity());
            if (beyond)
                beyond->find(run.row, run.column, run.count, height_m.data(), distance_m.data());
            raise_to_dip(run.found, heights.view.at(run.column, run.row), height_m.data(),
                         distance_m.data(), run.count, curvature, lowest_m, tangent);
        };
        terrain.sweep().each_horizon(
            tile.ray, terrain.curvature(), terrain.horizon_reach_m(), posts,
            [&](const SweepRun& run) {
                each_part(run, [&](const SweepRun& part) {
                    Figures tangent;
                    fill(part, tangent.data());
                    use(tile, {part.row, part.column, part.count, tangent.data()});
                });
            });
    });
}

void each_horizon(const PlannedSun& direction, const Window& window,
                  const std::function<void(const SunTile&, const SweepRun&)>& use) {
    if (!direction.around) return each_horizon(direction.field, direction.tiles, window, use);
    const SunTerrain& terrain = direction.field.terrain();
    const OuterHorizon outer(*direction.around, terrain, window);
    const WindowHeights heights(terrain.posts(), window);
    each_horizon(direction.field, direction.tiles, window,
                 [&](const SunTile& tile, const SweepRun& run) {
                     Figures tangent;
                     std::copy_n(run.found, run.count, tangent.data());
                     outer.raise(run.row, run.column, run.count,
                                 heights.view.at(run.column, run.row), tangent.data());
                     use(tile, {run.row, run.column, run.count, tangent.data()});
                 });
}

}  // namespace relevo::light
