#include "light/shadows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "base/wide_loops.h"
#include "light/margins.h"
#include "light/sky.h"
#include "light/sweep.h"

namespace relevo::light {
namespace {

/// Of the disc; NaN in holes.
float share_of_sun(float upper_m, float middle_m, float lower_m) {
    if (std::isnan(upper_m)) return upper_m;
    if (lower_m >= 0) return 1;
    if (upper_m <= 0) return 0;
    return static_cast<float>(share_of_disc(double{height_of_disc(upper_m, middle_m, lower_m)}));
}

/// 1 where the ground is as high as the edge of the shadow, 0 where it is lower.
RELEVO_WIDE_LOOPS void find_lit(const SweepRun& run, float* lit) {
    for (int i = 0; i < run.count; ++i) {
        const float height_m = run.height_m[i], is_lit = height_m >= run.found[i] ? 1.0F : 0.0F;
        lit[i] = height_m == height_m ? is_lit : height_m;
    }
}

RELEVO_WIDE_LOOPS void count_posts(std::span<const float> lit, Shadows& result) {
    std::int64_t holes = 0, lit_posts = 0, shaded_posts = 0;
    for (const float share : lit) {
        holes += share != share;
        lit_posts += share > 0;
        shaded_posts += share == 0;
    }
    result.holes = holes, result.lit_posts = lit_posts, result.shaded_posts = shaded_posts;
}

/// @param of  what `lit` has the posts of
void light_tile(const SunSky& sky, const Sweep& sweep, const SunTile& tile, double radius_rad,
                Array2d<float>& lit, const SweepWindow& of) {
    const bool soft = radius_rad > 0;
    const SweepWindow kept = soft ? tile.part : SweepWindow{};
    TileValues values(tile.part, 0), upper(kept, 0), middle(kept, 0),
        scratch(sky.levels() > 1 ? tile.part : SweepWindow{}, 0);
    for (TileValues* const each : {&values, &upper, &middle, &scratch})
        each->turn(tile.path.along_columns());
    const auto each_run = [&](double offset_rad, TileValues& to, const auto& figure) {
        each_edge(sky, sweep, tile, offset_rad, scratch,
                  [&](const SweepRun& run) { figure(run, to.of(run)); });
    };
    if (!soft) {
        each_run(0, values, find_lit);
    } else {
        each_run(radius_rad, upper, find_margins);
        each_run(0, middle, find_margins);
        each_edge(sky, sweep, tile, -radius_rad, scratch, [&](const SweepRun& run) {
            const float *const upper_m = upper.of(run), *const middle_m = middle.of(run);
            float* const out = values.of(run);
            for (int i = 0; i < run.count; ++i)
                out[i] = share_of_sun(upper_m[i], middle_m[i], run.height_m[i] - run.found[i]);
        });
    }
    values.put(lit, of);
}

}  // namespace

double share_of_disc(double height) {
    if (height <= 0) return 0;
    if (height >= 1) return 1;
    const double below = 1 - 2 * height;  // of the centre under the line, in radii
    return (std::acos(below) - below * std::sqrt(1 - below * below)) / kPi;
}

double true_azimuth_rad(const dem::Grid& grid, double azimuth_rad) {
    const geo::Geodetic center = grid.center();
    const glm::dvec2 on_map = grid.crs().from_geodetic(center);
    const double step = grid.crs().is_geographic() ? 1e-5 : 1 / grid.crs().unit_si();
    glm::dvec2 way(std::sin(azimuth_rad), std::cos(azimuth_rad));
    if (grid.crs().is_geographic()) way.x /= std::cos(center.lat_rad);
    const glm::dvec2 to = on_map + step * way;
    return geo::geodesic(center, grid.crs().to_geodetic(to.x, to.y)).azimuth_rad;
}

Shadows shadows(const dem::Posts& posts, const SunOverDem& sun, const ShadowOptions& options) {
    const dem::Grid& grid = posts.grid();
    const DemSky dem(posts, options);
    const SunSky sky(dem, sun);
    const SweepWindow part = window_of(options.part, grid);
    Shadows result;
    result.lit = Array2d<float>(part.columns, part.rows);
    if (sky.is_night()) {
        const PartHeights heights(posts, part);
        for (int row = 0; row < part.rows; ++row)
            for (int column = 0; column < part.columns; ++column) {
                const float h = heights.at(part.column + column, part.row + row);
                result.lit.at(column, row) = std::isnan(h) ? h : 0;
            }
    } else {
        const Sweep sweep = sweep_over(posts);
        const std::vector<SweepWindow> windows = divide({sky}, whole(grid), part);
        each_window(windows, [&](const SweepWindow& window) {
            light_tile(sky, sweep, tile_of(sky, window, part),
                       options.soft ? sun.semidiameter_rad : 0, result.lit, part);
        });
        result.tiles = static_cast<int>(windows.size());
    }
    if (options.done) options.done(1);
    count_posts({result.lit.data(), result.lit.size()}, result);
    result.definition = fmt::format(
        "{}, at the height of the ground; ground of the DEM alone shades, on the WGS 84 ellipsoid "
        "with terrestrial refraction k = {:.4g}{}",
        options.soft ? "visible fraction of the solar disc over the terrain, cut by a level line"
                     : "1 where the centre of the sun is above the terrain, 0 in shadow",
        options.refraction, kBeyondTheDem);
    return result;
}

}  // namespace relevo::light
