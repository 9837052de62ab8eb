#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "hillaire.h"
#include "path_integral.h"
#include "support/sky_truth.h"

namespace relevo::skymaker {
namespace {

double luminance_of(const sky::Spectrum& share) {
    return sky::xyz_of(share).y;
}

Batches recompute(const test::SkyRow& row, const sky::Air& air) {
    const PathIntegral integral(medium_of(air), radians(row.sun_deg));
    return integral.radiance({row.height_m, radians(row.elevation_deg), radians(row.azimuth_deg)},
                             {.paths = row.sun_deg < -4 ? 1500 : 300, .seed = 77});
}

/// The table and the program that made it: every 41st row again, with fewer other paths.
TEST(SkyTruth, RowsAreThoseThatThePathIntegralGives) {
    const std::vector<test::SkyRow> rows = test::sky_truth();
    ASSERT_GT(rows.size(), 500u);
    double squares = 0;
    int count = 0;
    for (std::size_t i = 5; i < rows.size(); i += 41) {
        const test::SkyRow& row = rows[i];
        const Batches batches = recompute(row, row.parameters());
        const Figure y = figure(batches, luminance_of);
        const double error = std::hypot(y.standard_error, row.error * row.luminance);
        const std::string what = fmt::format("row {}: {} air, {} m, sun {}, elevation {}", i,
                                             row.air, row.height_m, row.sun_deg, row.elevation_deg);
        EXPECT_NEAR(y.value, row.luminance, 4.5 * error) << what;
        EXPECT_LT(y.standard_error, 0.15 * y.value) << what;
        EXPECT_LT(glm::distance(sky::chromaticity(sky::xyz_of(mean(batches))), row.uv), 0.02)
            << what;
        squares += std::pow((y.value - row.luminance) / error, 2);
        ++count;
    }
    // Errors are as large as they are said to be, neither more nor less.
    fmt::print("[ accuracy ] {} rows again: differences of {:.2f} standard errors, mean square\n",
               count, std::sqrt(squares / count));
    EXPECT_LT(std::sqrt(squares / count), 1.8);
    EXPECT_GT(std::sqrt(squares / count), 0.4);
}

/// At dusk most of the blue is the ozone's: E. O. Hulburt, Explanation of the Brightness and Color
/// of the Sky, Particularly the Twilight Sky, J. Opt. Soc. Am. 43, 1953.
TEST(SkyTruth, WithoutOzoneItWouldBeAnother) {
    for (const test::SkyRow& row : test::sky_truth()) {
        if (row.air != "clean" || row.height_m != 0 || row.sun_deg != -4 ||
            row.elevation_deg != 80 || row.azimuth_deg != 100)
            continue;
        const auto uv = [](const Batches& batches) {
            return sky::chromaticity(sky::xyz_of(mean(batches)));
        };
        EXPECT_LT(glm::distance(uv(recompute(row, row.parameters())), row.uv), 0.01);
        const glm::dvec2 without = uv(recompute(row, {.ozone_du = 0}));
        EXPECT_GT(glm::distance(without, row.uv), 0.03);
        EXPECT_GT(without.y, row.uv.y);  // yellower
    }
}

TEST(SkyTruth, LevelIrradianceIsThatOfItsDirections) {
    const std::vector<test::SkyRow> levels = test::sky_truth("sky_truth_level.csv");
    ASSERT_GE(levels.size(), 20u);
    for (const test::SkyRow& row : levels) {
        if (row.height_m != 0 || (row.sun_deg != 30 && row.sun_deg != -2)) continue;
        const PathIntegral integral(medium_of(row.parameters()), radians(row.sun_deg));
        const Figure y = figure(integral.irradiance(0, {.paths = 400, .seed = 78}), luminance_of);
        EXPECT_NEAR(y.value, row.luminance,
                    4.5 * std::hypot(y.standard_error, row.error * row.luminance))
            << row.air << " " << row.sun_deg;
    }
}

/// S. Hillaire's model, whose orders from the second on are isotropic: how far it is from the truth
/// says what another model has to do better.
TEST(HillaireSky, IsAsFarFromTheTruthAsIsotropicHigherOrdersAre) {
    std::vector<test::SkyRow> rows;
    for (const test::SkyRow& row : test::sky_truth())
        if (row.air == "clean" && row.height_m == 0) rows.push_back(row);
    const HillaireSky air(rows.front().parameters());
    const auto model = [&](const test::SkyRow& row) {
        return air.radiance(std::sin(radians(row.elevation_deg)), std::sin(radians(row.sun_deg)),
                            std::cos(radians(row.azimuth_deg)));
    };
    for (const test::SkyScore& score : test::score_sky(rows, model)) {
        EXPECT_LT(score.mean_error, 0.4) << score.sun_deg;
        EXPECT_LT(score.mean_uv, 0.03) << score.sun_deg;
    }
}

}  // namespace
}  // namespace relevo::skymaker
