#include "light/raster/clearance.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/parallel_for.h"
#include "light/raster/post_loops.h"
#include "light/raster/shadow_heights.h"

namespace relevo::light {
namespace {

/// Where a DEM would have more tiles than this, the sun may be off by more.
constexpr std::size_t kMostTiles = 4096;
constexpr double kLooser = 4;
constexpr double kLoosest_rad = radians(12);

/// Whose tables are made and uploaded together: those of a tile take up to 5 MB.
constexpr std::size_t kMostDeviceTiles = 32;

struct DividedField {
    std::vector<SunTile> tiles;
    double error_rad = 0;
};

DividedField division_of(const SunField& sun) {
    const Window all = sun.terrain().window();
    for (double tolerance_rad = kSunTolerance_rad;; tolerance_rad *= kLooser) {
        const bool last = tolerance_rad * kLooser > kLoosest_rad;
        try {
            const std::size_t most = last ? static_cast<std::size_t>(-1) : kMostTiles;
            DividedField division{divide(sun, all, all, tolerance_rad, most), 0};
            if (division.tiles.size() > most) continue;
            if (tolerance_rad > kSunTolerance_rad) division.error_rad = tolerance_rad;
            return division;
        } catch (const Error&) {
            if (last) throw;
        }
    }
}

}  // namespace

Clearances::Clearances(const dem::Posts& posts, const ShadowOptions& options)
    : terrain_(posts, {options.refraction, options.air}, true) {}

Clearances::Found Clearances::each(const geo::Geodetic& place, const SunOverDem& sun,
                                   const Use& use) const {
    const SunField field(terrain_, place, sun);
    if (field.is_night()) return {true, 0};
    const DividedField division = division_of(field);
    const Window all = terrain_.window();
    const WindowHeights heights(terrain_.posts(), all);
    const double radius_rad = sun.semidiameter_rad;
    Array2d<float> lower(all.columns, all.rows), middle;
    const auto find = [&](double offset_rad, Array2d<float>& to) {
        each_shadow(field, division.tiles, all, offset_rad, [&](const SweepRun& run) {
            find_clearances(heights.view.at(run.column, run.row), run.found, run.count,
                            &to.at(run.column - all.column, run.row));
        });
    };
    find(-radius_rad, lower);
    if (radius_rad > 0) {
        middle = Array2d<float>(all.columns, all.rows);
        find(0, middle);
    }
    each_shadow(field, division.tiles, all, radius_rad, [&](const SweepRun& run) {
        constexpr int kPart = 512;
        std::array<float, kPart> upper_m;
        for (int done = 0; done < run.count; done += kPart) {
            const int column = run.column + done, count = std::min(run.count - done, kPart);
            find_clearances(heights.view.at(column, run.row), run.found + done, count,
                            upper_m.data());
            float* const lower_m = &lower.at(column - all.column, run.row);
            if (radius_rad > 0)
                straighten(upper_m.data(), &middle.at(column - all.column, run.row), count,
                           lower_m);
            use({run.row, column - all.column, count, upper_m.data(), lower_m});
        }
    });
    return {false, division.error_rad};
}

Clearances::Found Clearances::each_sweep(const geo::Geodetic& place, const SunOverDem& sun,
                                         const UseSweep& use) const {
    const SunField field(terrain_, place, sun);
    if (field.is_night()) return {true, 0};
    const DividedField division = division_of(field);
    std::vector<SunTile> lit;
    for (const SunTile& tile : division.tiles)
        if (!tile.is_night && !common(tile.posts.window, terrain_.window()).is_empty())
            lit.push_back(tile);
    const auto sweep = [&](DeviceSweep::Part part, double offset_rad, SunTerrain::Air air) {
        for (std::size_t done = 0; done < lit.size(); done += kMostDeviceTiles) {
            const std::size_t count = std::min(kMostDeviceTiles, lit.size() - done);
            DeviceSweep found{part, air == SunTerrain::kOfHighest, std::vector<TileSweep>(count)};
            parallel_for(0, static_cast<int>(count), 1, [&](int first, int last) {
                for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last);
                     ++i)
                    found.tiles[i] =
                        tile_sweep(field, lit[done + i], terrain_.window(), offset_rad, air);
            });
            use(found);
        }
    };
    const double radius_rad = sun.semidiameter_rad;
    const auto sweep_disc = [&](SunTerrain::Air air) {
        sweep(DeviceSweep::kUpper, radius_rad, air);
        if (!(radius_rad > 0)) return;
        sweep(DeviceSweep::kMiddle, 0, air);
        sweep(DeviceSweep::kLower, -radius_rad, air);
    };
    sweep_disc(field.first_air());
    if (field.has_two_airs()) sweep_disc(SunTerrain::kOfHighest);
    return {false, division.error_rad};
}

}  // namespace relevo::light
