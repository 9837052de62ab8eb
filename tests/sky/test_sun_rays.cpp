#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "sky/sun_rays.h"

namespace relevo::sky {
namespace {

/// G. G. Bennett, The Calculation of Astronomical Refraction in Marine Navigation, J. Navigation 35
/// (1982), 255: of the apparent elevation, at 1010 hPa and 10 degrees C.
double bennett_arcmin(double apparent_deg) {
    return 1 / std::tan(radians(apparent_deg + 7.31 / (apparent_deg + 4.4)));
}

TEST(SunRays, AreBentAsBennettsFormulaSays) {
    const SunRays rays(0);
    const double colder = 1013.25 / 1010 * 283.15 / 288.15;  // of 15 degrees C
    double worst = 0;
    for (const double deg : {0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0}) {
        const double expected = colder * bennett_arcmin(deg);
        const double found = 60 * degrees(rays.refraction_rad(radians(deg - expected / 60)));
        fmt::print("[ sky ] refraction at {} degrees: {:.2f} arcmin, Bennett {:.2f}\n", deg, found,
                   expected);
        worst = std::max(worst, std::abs(found - expected));
    }
    EXPECT_LT(worst, 1);
    EXPECT_NEAR(degrees(rays.horizon_rad()), -34.0 / 60, 0.03);
}

TEST(SunRays, PassAsMuchAirAsKastenAndYoungSay) {
    // F. Kasten and A. T. Young, Applied Optics 28 (1989), 4735: by the apparent elevation.
    const SunRays rays(0);
    double worst = 0;
    for (const double deg : {0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 90.0}) {
        const double expected =
            1 / (std::sin(radians(deg)) + 0.50572 * std::pow(deg + 6.07995, -1.6364));
        double elevation = radians(deg);
        for (int i = 0; i < 20; ++i)
            elevation = radians(deg) - rays.refraction_rad(elevation);
        const double found =
            rays.towards(std::max(elevation, rays.horizon_rad()))->rayleigh_m / kRayleighColumn_m;
        fmt::print("[ sky ] air mass at {} degrees: {:.3f}, Kasten and Young {:.3f}\n", deg, found,
                   expected);
        worst = std::max(worst, std::abs(found / expected - 1));
    }
    fmt::print("[ accuracy ] air mass from the horizon to the zenith, worst: {:.2f} %\n",
               100 * worst);
    EXPECT_LT(worst, 0.02);
}

TEST(SunRays, FromASummitComeFromBelowTheLevel) {
    // The dip of the sea horizon from a height, in arcminutes: 1.75 sqrt(h / m) (The American
    // Practical Navigator, 2002, table 14 has 0.97 sqrt(h / ft)).
    const SunRays rays(4478);
    const double apparent = rays.horizon_rad() + rays.refraction_rad(rays.horizon_rad());
    EXPECT_NEAR(60 * degrees(apparent), -1.75 * std::sqrt(4478), 3);
    EXPECT_FALSE(rays.towards(rays.horizon_rad() - 1e-6));
    // From the horizon on, light has passed nearly the air before and behind it.
    const double there = rays.towards(rays.horizon_rad())->rayleigh_m / kRayleighColumn_m;
    EXPECT_GT(there, 38 * 1.5);
    EXPECT_LT(there, 38 * 2);
}

TEST(SunRays, AreStraightWithoutRefraction) {
    for (const double height : {0.0, 2000.0, 8000.0}) {
        const SunRays rays(height, false);
        EXPECT_EQ(rays.refraction_rad(0), 0);
        for (const double above_deg : {0.05, 0.7, 4.0, 60.0}) {
            const double elevation = rays.horizon_rad() + radians(above_deg);
            const Column expected = Columns::shared().towards(height, std::sin(elevation));
            EXPECT_NEAR(rays.towards(elevation)->rayleigh_m, expected.rayleigh_m,
                        0.03 * expected.rayleigh_m + 1)
                << height << " " << above_deg;
        }
    }
}

TEST(SunRays, PassTheWholeLimbOnTheirWayToOrbit) {
    // A ray with its lowest point at 20 km passes what two level rays from there pass. Between the
    // elevations of the rays that are kept it is linear.
    const SunRays from_orbit(400e3, false), level(20e3, false);
    const double elevation = -std::acos((kEarthRadius_m + 20e3) / (kEarthRadius_m + 400e3));
    EXPECT_NEAR(from_orbit.towards(elevation)->rayleigh_m / level.towards(0)->rayleigh_m, 2, 0.3);
    EXPECT_EQ(from_orbit.towards(0)->rayleigh_m, 0);
}

}  // namespace
}  // namespace relevo::sky
