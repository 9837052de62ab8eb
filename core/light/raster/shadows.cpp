#include "light/raster/shadows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "dem/surroundings.h"
#include "geo/geodetic.h"
#include "light/point/edge_ground.h"
#include "light/raster/clearance.h"
#include "light/raster/post_loops.h"
#include "light/raster/shadow_heights.h"

namespace relevo::light {
namespace {

/// Of the disc; NaN in holes.
float visible_fraction(const DiscClearance& clearance) {
    if (std::isnan(clearance.upper_m)) return clearance.upper_m;
    if (clearance.lower_m >= 0) return 1;
    if (clearance.upper_m <= 0) return 0;
    return static_cast<float>(share_of_disc(double{height_of_disc(clearance)}));
}

/// The clearance of a part of the disc at every post.
void find_all_clearances(const PlannedSun& sun, const WindowHeights& heights, const Window& part,
                         double offset_rad, Array2d<float>& clearance_m) {
    each_shadow(sun, part, offset_rad, [&](const SweepRun& run) {
        find_clearances(heights.view.at(run.column, run.row), run.found, run.count,
                        &clearance_m.at(run.column - part.column, run.row - part.row));
    });
}

void find_lit(const PlannedSun& sun, const WindowHeights& heights, const Window& part, bool soft,
              Array2d<float>& lit) {
    find_all_clearances(sun, heights, part, 0, lit);
    if (!soft) {
        for (float& clearance_m : lit)
            if (!std::isnan(clearance_m)) clearance_m = clearance_m >= 0 ? 1.0F : 0.0F;
        return;
    }
    Array2d<float> upper(part.columns, part.rows), lower(part.columns, part.rows);
    find_all_clearances(sun, heights, part, sun.semidiameter_rad, upper);
    find_all_clearances(sun, heights, part, -sun.semidiameter_rad, lower);
    for (std::size_t i = 0; i < lit.size(); ++i)
        lit.data()[i] = visible_fraction({upper.data()[i], lit.data()[i], lower.data()[i]});
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

Shadows shadows(const SunPlan& plan, const PlannedSun& sun, const ShadowOptions& options) {
    const Window part = plan.terrain().window_of(options.part);
    const WindowHeights heights(plan.terrain().posts(), part);
    Shadows result;
    result.tiles = static_cast<int>(sun.tiles.size());
    result.lit = Array2d<float>(part.columns, part.rows);
    find_lit(sun, heights, part, options.soft, result.lit);
    if (options.done) options.done(1);
    for (const float share : result.lit) {
        result.holes += std::isnan(share);
        result.lit_posts += share > 0;
        result.shaded_posts += share == 0;
    }
    result.definition = fmt::format(
        "{}, at the height of the ground; ground of {} shades, on the WGS 84 ellipsoid "
        "with terrestrial refraction k = {:.4g}{}",
        options.soft ? "visible fraction of the solar disc over the terrain, cut by a level line"
                     : "1 where the centre of the sun is above the terrain, 0 in shadow",
        dem::ground_text(plan.terrain().given()), options.refraction, kBeyondTheDem);
    return result;
}

Shadows shadows(const dem::Posts& posts, const SunOverDem& sun, const ShadowOptions& options) {
    SunPlan plan(posts, {options.refraction, options.air}, options.part, options.soft);
    plan.add_suns(posts.grid().center(), {sun});
    return shadows(plan, plan.suns().front(), options);
}

}  // namespace relevo::light
