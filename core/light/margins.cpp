#include "light/margins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "base/wide_loops.h"

namespace relevo::light {
namespace {

/// A DEM in more windows than this is looked at with a sun that is off by more.
constexpr std::size_t kMostWindows = 4096;
constexpr double kLooser = 4;
constexpr double kLoosest_rad = radians(12);

struct Division {
    std::vector<SweepWindow> windows;
    double error_rad = 0;
};

Division division_of(const SunSky& sky, const dem::Grid& grid) {
    for (double tolerance_rad = kSunTolerance_rad;; tolerance_rad *= kLooser) {
        const bool last = tolerance_rad * kLooser > kLoosest_rad;
        try {
            Division division{divide({sky}, whole(grid), whole(grid), tolerance_rad), 0};
            if (division.windows.size() > kMostWindows && !last) continue;
            if (tolerance_rad > kSunTolerance_rad) division.error_rad = tolerance_rad;
            return division;
        } catch (const Error&) {
            if (last) throw;
        }
    }
}

ShadowOptions of_discs(ShadowOptions options) {
    options.soft = true;
    return options;
}

/// A figure for each post of a window, in the order in which sweeps come to them, not set yet.
class Kept {
  public:
    Kept(const SweepWindow& window, bool along_columns)
        : line_(along_columns ? window.column : window.row),
          first_(along_columns ? window.row : window.column),
          length_(along_columns ? window.rows : window.columns),
          values_(std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(window.columns) *
                                                          static_cast<std::size_t>(window.rows))) {}

    float* of(const SweepRun& run) {
        return values_.get() + std::ptrdiff_t{run.line - line_} * length_ + (run.first - first_);
    }

  private:
    int line_, first_, length_;
    std::unique_ptr<float[]> values_;
};

/// Lower limbs' margins such that the line between them and the upper limb's passes 0 where the
/// horizon cuts the disc.
/// @param lower_m  is changed
RELEVO_WIDE_LOOPS void straighten(const float* upper_m, const float* middle_m, int count,
                                  float* lower_m) {
    for (int i = 0; i < count; ++i) {
        const float u = upper_m[i], l = lower_m[i], m = middle_m[i];
        const float straight = u - u / height_of_disc(u, m, l);
        lower_m[i] = u > 0 && l < 0 ? straight : l;
    }
}

/// The margins of the disc's lower limb and its centre are found first and kept; with the upper
/// limb's they are handed on.
void margins_of_tile(const SunSky& sky, const Sweep& sweep, const SunTile& tile, double radius_rad,
                     const Margins::Use& use) {
    const bool along_columns = tile.path.along_columns();
    Kept lower(tile.window, along_columns), middle(tile.window, along_columns);
    TileValues scratch(sky.levels() > 1 ? tile.window : SweepWindow{}, 0);
    scratch.turn(along_columns);
    const auto keep = [&](double offset_rad, Kept& kept) {
        each_edge(sky, sweep, tile, offset_rad, scratch,
                  [&](const SweepRun& run) { find_margins(run, kept.of(run)); });
    };
    keep(-radius_rad, lower);
    if (radius_rad > 0) keep(0, middle);
    each_edge(sky, sweep, tile, radius_rad, scratch, [&](const SweepRun& run) {
        constexpr int kPart = 512;
        std::array<float, kPart> upper_m;
        float* const lower_m = lower.of(run);
        for (int done = 0; done < run.count; done += kPart) {
            const int count = std::min(run.count - done, kPart);
            find_margins({run.along_column, run.line, run.first + done, count, run.height_m + done,
                          run.found + done},
                         upper_m.data());
            if (radius_rad > 0)
                straighten(upper_m.data(), middle.of(run) + done, count, lower_m + done);
            use({run.along_column, run.line, run.first + done, count, upper_m.data(),
                 lower_m + done});
        }
    });
}

}  // namespace

RELEVO_WIDE_LOOPS void find_margins(const SweepRun& run, float* margin_m) {
    for (int i = 0; i < run.count; ++i)
        margin_m[i] = run.height_m[i] - run.found[i];
}

Margins::Margins(const dem::Posts& posts, const ShadowOptions& options)
    : dem_(posts, of_discs(options)), sweep_(sweep_over(posts)) {}

Margins::Found Margins::each(const geo::Geodetic& place, const SunOverDem& sun,
                             const std::function<void(bool)>& turn, const Use& use) const {
    const SunSky sky(dem_, place, sun);
    turn(sky.along_columns());
    if (sky.is_night()) return {true, 0};
    const Division division = division_of(sky, dem_.grid());
    each_window(division.windows, [&](const SweepWindow& window) {
        margins_of_tile(sky, sweep_, tile_of(sky, window, window), sun.semidiameter_rad, use);
    });
    return {false, division.error_rad};
}

}  // namespace relevo::light
