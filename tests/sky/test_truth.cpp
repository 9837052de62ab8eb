#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "sky/atmosphere.h"
#include "support/sky_truth.h"

namespace relevo::sky {
namespace {

/// Atmospheres are slow to make.
const Atmosphere& atmosphere(const Air& air) {
    static std::map<double, Atmosphere> made;
    const auto found = made.find(air.angstrom_beta);
    return found != made.end() ? found->second
                               : made.emplace(air.angstrom_beta, Atmosphere(air)).first->second;
}

TEST(Atmosphere, IsThePathIntegralsSky) {
    // The limits of a sky that is to be told from the true one by nobody: the luminance of 30
    // directions, and their colours.
    const auto scores = test::score_sky(test::sky_truth(), [](const test::SkyRow& row) {
        return atmosphere(row.parameters())
            .radiance({.height_m = row.height_m,
                       .sine = std::sin(radians(row.elevation_deg)),
                       .sun_sine = std::sin(radians(row.sun_deg)),
                       .azimuth_cos = std::cos(radians(row.azimuth_deg))});
    });
    ASSERT_GT(scores.size(), 10u);
    for (const test::SkyScore& score : scores) {
        SCOPED_TRACE(score.air + " air, " + std::to_string(score.height_m) + " m, sun " +
                     std::to_string(score.sun_deg));
        const double limit = score.sun_deg >= 5 ? 0.05 : score.sun_deg >= -2 ? 0.15 : 0.5;
        EXPECT_LT(score.mean_error, limit);
        EXPECT_LT(score.mean_uv, 0.012);
        EXPECT_LT(score.worst_uv, 0.02);
    }
}

TEST(Atmosphere, ShedsThePathIntegralsLightOnLevelGround) {
    double sum = 0, worst = 0;
    const std::vector<test::SkyRow> rows = test::sky_truth("sky_truth_level.csv");
    for (const test::SkyRow& row : rows) {
        const glm::dvec3 xyz =
            xyz_of(atmosphere(row.parameters())
                       .sky_irradiance(row.height_m, std::sin(radians(row.sun_deg))));
        const double error = xyz.y / row.luminance - 1;
        fmt::print(
            "[ sky ] {} air, {:.0f} m, sun {:.0f}: irradiance {:+.1f} % (+- {:.1f}), u'v' {:.4f}\n",
            row.air, row.height_m, row.sun_deg, 100 * error, 100 * row.error,
            glm::distance(chromaticity(xyz), row.uv));
        sum += std::abs(error) / static_cast<double>(rows.size());
        worst = std::max(worst, std::abs(error));
        EXPECT_LT(glm::distance(chromaticity(xyz), row.uv), 0.01);
    }
    fmt::print("[ accuracy ] light of the sky on level ground: mean {:.1f} %, worst {:.1f} %\n",
               100 * sum, 100 * worst);
    EXPECT_LT(sum, 0.05);
    EXPECT_LT(worst, 0.15);
}

}  // namespace
}  // namespace relevo::sky
