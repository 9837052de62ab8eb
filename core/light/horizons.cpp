#include "light/horizons.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "base/wide_loops.h"
#include "light/ground_slope.h"
#include "light/quick_math.h"
#include "light/sky.h"

namespace relevo::light {
namespace {

constexpr double kHorizonTolerance_rad = radians(0.1);  // of a direction
constexpr double kSkyTolerance_rad = radians(0.5);      // directions that are summed up
constexpr int kLeastDirections = 4, kMostDirections = 3600;

/// What all rasters of directions begin with.
struct Ground {
    DemSky dem;
    Sweep sweep;

    Ground(const dem::Posts& posts, double refraction)
        : dem(posts, {.refraction = refraction}), sweep(sweep_over(posts)) {}

    /// Calls `use` with the posts of a part and the tangents of their horizons in a direction.
    void each_horizon(const SunSky& sky, double tolerance_rad, const SweepWindow& part,
                      const Sweep::Use& use) const {
        each_window(divide({sky}, whole(dem.grid()), part, tolerance_rad),
                    [&](const SweepWindow& window) {
                        light::each_horizon(sky, sweep, tile_of(sky, window, part), use);
                    });
    }
};

std::string surroundings(double refraction) {
    return fmt::format(
        "ground of the DEM alone, on the WGS 84 ellipsoid with terrestrial refraction k = {:.4g}{}",
        refraction, kBeyondTheDem);
}

/// Elevations of the horizons of posts next to each other; a hole has no number.
RELEVO_WIDE_LOOPS void find_elevations(const SweepRun& run, float* elevation_rad) {
    for (int i = 0; i < run.count; ++i) {
        const float t = run.found[i], height_m = run.height_m[i];
        const float elevation = std::copysign(quick_atan(std::abs(t)), t);
        elevation_rad[i] = height_m == height_m ? elevation : height_m;
    }
}

/// What a direction adds to the sky-view factors of posts next to each other.
/// @param east, north  the rise of the ground
RELEVO_WIDE_LOOPS void add_sky(const SweepRun& run, const float* east, const float* north,
                               float sin_azimuth, float cos_azimuth, float* sum) {
    for (int i = 0; i < run.count; ++i) {
        // H of the source is the angle between zenith and horizon, t its cotangent.
        const float t = std::max(run.found[i], 0.0F);
        const float sin2 = 1 / (1 + t * t);
        const float rise = east[i] * sin_azimuth + north[i] * cos_azimuth;
        const float width = kHalfPi - quick_atan(t) - t * sin2;
        const float slope = 1 / std::sqrt(1 + east[i] * east[i] + north[i] * north[i]);
        sum[i] += std::max(0.0F, slope * (sin2 - rise * width));
    }
}

/// Makes sums of sky-view factors shares of those of endless planes, of which none sees more.
/// @param most         the sum where all is seen
/// @param east, north  the rise of the ground, in the same order
void relate_to_slopes(const SweepWindow& window, float most, TileValues& east, TileValues& north,
                      TileValues& sum) {
    for (TileValues* const each : {&sum, &east, &north})
        each->turn(false);
    parallel_for(0, window.rows, 16, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            const SweepRun run{false, row, 0, window.columns, nullptr, nullptr};
            const float *const e = east.of(run), *const n = north.of(run);
            float* const share = sum.of(run);
            for (int i = 0; i < run.count; ++i) {
                const float cosine = 1 / std::sqrt(1 + e[i] * e[i] + n[i] * n[i]);
                share[i] = std::min(share[i] * 2 / (1 + cosine), most);
            }
        }
    });
}

}  // namespace

Horizons horizons(const dem::Posts& posts, std::vector<double> azimuth_rad, double refraction,
                  const dem::Window& of) {
    const Ground ground(posts, refraction);
    const SweepWindow part = window_of(of, posts.grid());
    Horizons result;
    result.azimuth_rad = std::move(azimuth_rad);
    TileValues values(part, 0);
    for (const double azimuth : result.azimuth_rad) {
        const SunSky sky(ground.dem, azimuth);
        values.turn_unset(sky.along_columns());
        ground.each_horizon(sky, kHorizonTolerance_rad, part,
                            [&](const SweepRun& run) { find_elevations(run, values.of(run)); });
        values.put(result.elevation_rad.emplace_back(part.columns, part.rows), part);
    }
    if (!result.elevation_rad.empty())
        for (const float elevation : result.elevation_rad.front())
            result.holes += std::isnan(elevation);
    result.definition =
        "elevation of the horizon as seen from the ground; " + surroundings(refraction);
    return result;
}

SkyView sky_view(const dem::Posts& posts, const SkyViewOptions& options) {
    if (options.directions < kLeastDirections || options.directions > kMostDirections)
        bad_input(fmt::format("sky view: {} directions: expected {} to {}", options.directions,
                              kLeastDirections, kMostDirections));
    const Ground ground(posts, options.refraction);
    const SweepWindow part = window_of(options.part, posts.grid());
    SkyView result;
    result.share = Array2d<float>(part.columns, part.rows);
    const PartHeights heights(posts, part);
    TileValues sum(part, 0), east(part, 0), north(part, 0);
    if (!options.level) ground_slope(posts.grid(), heights.view, part, east, north);
    for (int k = 0; k < options.directions; ++k) {
        const double azimuth_rad = 2 * kPi * k / options.directions;
        const SunSky sky(ground.dem, azimuth_rad);
        for (TileValues* const each : {&sum, &east, &north})
            each->turn(sky.along_columns());
        const auto sin_azimuth = static_cast<float>(std::sin(azimuth_rad));
        const auto cos_azimuth = static_cast<float>(std::cos(azimuth_rad));
        ground.each_horizon(sky, kSkyTolerance_rad, part, [&](const SweepRun& run) {
            add_sky(run, east.of(run), north.of(run), sin_azimuth, cos_azimuth, sum.of(run));
        });
        if (options.done) options.done(1.0 / options.directions);
    }
    if (options.of_open_slope)
        relate_to_slopes(part, static_cast<float>(options.directions), east, north, sum);
    sum.put(result.share, part);
    std::int64_t seen = 0;
    for (int row = 0; row < result.share.height(); ++row)
        for (int column = 0; column < result.share.width(); ++column) {
            float& share = result.share.at(column, row);
            const float height_m = heights.at(part.column + column, part.row + row);
            share =
                std::isnan(height_m) ? height_m : share / static_cast<float>(options.directions);
            if (std::isnan(share)) continue;
            result.mean += double{share};
            ++seen;
        }
    result.mean /= static_cast<double>(seen);
    result.holes = static_cast<std::int64_t>(result.share.size()) - seen;
    result.definition = fmt::format(
        "share of a uniform sky's light that falls on {}, of {} directions (Dozier and Frew 1990); "
        "{}",
        options.level ? "a level plane" : "the ground as it is inclined", options.directions,
        surroundings(options.refraction));
    return result;
}

}  // namespace relevo::light
