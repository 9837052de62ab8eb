// A fine DEM in a wider and coarser one.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "light/hills.h"
#include "light/point/horizon.h"
#include "light/raster/shadows.h"

namespace relevo::light {
namespace {

/// The hills, so wide that their shadows cross the border of a site in their middle.
TEST(Nested, ASiteIsLitAsInAWideFineDem) {
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills(middle);
    const std::string utm = "EPSG:32632";
    const dem::Heightfield site = sampled(turned("site", utm, middle, 30, 0, 121), hills),
                           coarse = sampled(turned("around", utm, middle, 90, 20, 201), hills),
                           fine = sampled(turned("all", utm, middle, 30, 0, 601), hills);
    const dem::Posts posts(site), around(coarse), whole(fine);
    const auto lit = [](const dem::Posts& of, const dem::Posts* wider, const SunOverDem& sun,
                        const Window& part) {
        SunPlan plan(of, {}, part, false, wider);
        plan.add_suns(of.grid().center(), {sun});
        ShadowOptions options;
        options.part = part;
        return shadows(plan, plan.suns().front(), options).lit;
    };
    const Window inner{240, 240, 121, 121};
    int alone_differ = 0, most = 0;
    for (const double azimuth_deg : {20.0, 95.0, 170.0, 250.0, 310.0})
        for (const double elevation_deg : {-0.3, 3.0, 8.0, 20.0}) {
            const SunOverDem sun{radians(azimuth_deg), radians(elevation_deg), 0};
            const Array2d<float> expected = lit(whole, nullptr, sun, inner),
                                 nested = lit(posts, &around, sun, {}),
                                 alone = lit(posts, nullptr, sun, {});
            int differ = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                differ += nested.data()[i] != expected.data()[i];
                alone_differ += alone.data()[i] != expected.data()[i];
            }
            most = std::max(most, differ);
        }
    fmt::print(
        "[ accuracy ] a site in a coarser DEM: of 14,641 posts at most {} lit otherwise than in a "
        "wide fine one, of 20 suns; without the wider DEM {} of all\n",
        most, alone_differ);
    EXPECT_LE(most, 150);
    EXPECT_GT(alone_differ, 20'000);
}

TEST(Nested, AHorizonGoesOnOverTheWiderDem) {
    const geo::Geodetic middle = place_at(46.5, 9.3);
    const Hills hills(middle);
    const std::string utm = "EPSG:32632";
    const dem::Heightfield site = sampled(turned("site", utm, middle, 30, 0, 121), hills),
                           coarse = sampled(turned("around", utm, middle, 90, 20, 201), hills),
                           fine = sampled(turned("all", utm, middle, 30, 0, 601), hills);
    const dem::Posts around(coarse);
    HorizonOptions options;
    options.around = &around;
    const TerrainHorizon nested(site, middle, options), whole(fine, middle), alone(site, middle);
    double worst = 0, worst_alone = 0;
    for (int azimuth_deg = 0; azimuth_deg < 360; ++azimuth_deg) {
        const HorizonPoint found = nested.at(radians(azimuth_deg)),
                           expected = whole.at(radians(azimuth_deg));
        worst = std::max(worst, std::abs(found.elevation_rad - expected.elevation_rad));
        worst_alone = std::max(worst_alone, std::abs(alone.elevation_rad(radians(azimuth_deg)) -
                                                     expected.elevation_rad));
        EXPECT_NEAR(found.distance_m, expected.distance_m, 150) << azimuth_deg;
        EXPECT_GT(found.reach_m, 8000) << azimuth_deg;
    }
    fmt::print(
        "[ accuracy ] horizons of a site in a coarser DEM: within {:.4f} degrees, without "
        "it {:.2f}\n",
        degrees(worst), degrees(worst_alone));
    EXPECT_LE(degrees(worst), 0.03);
    EXPECT_GE(degrees(worst_alone), 5);
}

}  // namespace
}  // namespace relevo::light
