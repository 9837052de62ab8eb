#include "light/raster/horizons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "dem/surroundings.h"
#include "light/point/edge_ground.h"
#include "light/raster/ground_slope.h"
#include "light/raster/post_loops.h"
#include "light/raster/shadow_heights.h"

namespace relevo::light {
namespace {

constexpr double kHorizonTolerance_rad = radians(0.1);  // of a direction
constexpr double kSkyTolerance_rad = radians(0.5);      // directions that are summed up
constexpr int kLeastDirections = 4, kMostDirections = 3600;

std::string surroundings(const dem::Posts& posts, double refraction) {
    return fmt::format(
        "ground of {}, on the WGS 84 ellipsoid with terrestrial refraction k = {:.4g}{}",
        dem::ground_text(posts), refraction, kBeyondTheDem);
}

/// Adds up what each direction gives to the sky view of the ground.
void add_directions(const SunPlan& plan, const SkyViewOptions& options, const Window& part,
                    const GroundSlope& slope, Array2d<float>& sum) {
    for (const PlannedSun& direction : plan.suns()) {
        const glm::vec3 towards(direction.field.direction());
        each_horizon(direction, part, [&](const SunTile&, const SweepRun& run) {
            const int x = run.column - part.column, y = run.row - part.row;
            std::array<float, kLongestRun> raised;
            if (options.plane) raised = raised_over_planes(run, slope, {x, y}, towards);
            add_sky(options.plane ? raised.data() : run.found, &slope.x.at(x, y), &slope.y.at(x, y),
                    &slope.z.at(x, y), run.count, towards, &sum.at(x, y));
        });
        if (options.done) options.done(1.0 / static_cast<double>(plan.suns().size()));
    }
}

}  // namespace

void add_horizon_directions(SunPlan& plan, const std::vector<double>& azimuth_rad) {
    plan.add_directions(azimuth_rad, kHorizonTolerance_rad);
}

Array2d<float> horizon_elevations(const SunPlan& plan, const PlannedSun& direction,
                                  const Window& of) {
    const Window part = plan.terrain().window_of(of);
    const WindowHeights heights(plan.terrain().posts(), part);
    Array2d<float> elevation_rad(part.columns, part.rows);
    each_horizon(direction, part, [&](const SunTile&, const SweepRun& run) {
        find_elevations(run.found, heights.view.at(run.column, run.row), run.count,
                        &elevation_rad.at(run.column - part.column, run.row - part.row));
    });
    return elevation_rad;
}

std::string horizons_definition(const dem::Posts& posts, double refraction) {
    return "elevation of the horizon as seen from the ground; " + surroundings(posts, refraction);
}

Horizons horizons(const dem::Posts& posts, std::vector<double> azimuth_rad, double refraction,
                  const Window& of) {
    SunPlan plan(posts, {refraction, {}}, of);
    add_horizon_directions(plan, azimuth_rad);
    Horizons result;
    result.azimuth_rad = std::move(azimuth_rad);
    for (const PlannedSun& direction : plan.suns())
        result.elevation_rad.push_back(horizon_elevations(plan, direction, of));
    if (!result.elevation_rad.empty())
        for (const float elevation : result.elevation_rad.front())
            result.holes += std::isnan(elevation);
    result.definition = horizons_definition(posts, refraction);
    return result;
}

void add_sky_view_directions(SunPlan& plan, int directions) {
    if (directions < kLeastDirections || directions > kMostDirections)
        bad_input(fmt::format("sky view: {} directions: expected {} to {}", directions,
                              kLeastDirections, kMostDirections));
    std::vector<double> azimuth_rad;
    for (int k = 0; k < directions; ++k)
        azimuth_rad.push_back(2 * kPi * k / directions);
    plan.add_level_directions(azimuth_rad, kSkyTolerance_rad);
}

SkyView sky_view(const dem::Posts& posts, const SkyViewOptions& options) {
    SunPlan plan(posts, {options.refraction, {}}, options.part);
    add_sky_view_directions(plan, options.directions);
    return sky_view(plan, options);
}

SkyView sky_view(const SunPlan& plan, const SkyViewOptions& options) {
    const Window part = plan.terrain().window_of(options.part);
    const WindowHeights heights(plan.terrain().posts(), part);
    GroundSlope slope = options.level   ? GroundSlope(part)
                        : options.plane ? GroundSlope(plan.terrain(), part, *options.plane)
                                        : GroundSlope(plan.terrain(), heights, part);
    SkyView result;
    result.share = Array2d<float>(part.columns, part.rows, 0);
    add_directions(plan, options, part, slope, result.share);
    std::int64_t seen = 0;
    for (int y = 0; y < part.rows; ++y)
        for (int x = 0; x < part.columns; ++x) {
            float& share = result.share.at(x, y);
            const float height_m = heights.at(part.column + x, part.row + y);
            if (std::isnan(height_m)) {
                share = height_m;
                continue;
            }
            share = std::min(1.0F, share / static_cast<float>(options.directions));
            // An endless plane sees half of one and the cosine of its slope.
            if (options.of_open_slope)
                share = std::min(1.0F, share * 2 / (1 + cosine_of(slope.at(x, y))));
            result.mean += double{share};
            ++seen;
        }
    result.mean /= static_cast<double>(seen);
    result.holes = static_cast<std::int64_t>(result.share.size()) - seen;
    result.definition = fmt::format(
        "share of a uniform sky's light that falls on {}, of {} directions (Dozier and Frew 1990); "
        "{}",
        options.level ? "a level plane" : "the ground as it is inclined", options.directions,
        surroundings(plan.terrain().given(), options.refraction));
    return result;
}

}  // namespace relevo::light
