#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "sky/atmosphere.h"
#include "sky/columns.h"
#include "sky/path.h"

namespace relevo::sky {
namespace {

const Atmosphere& clean() {
    static const Atmosphere kClean(Air{.angstrom_beta = 0.04});
    return kClean;
}

double sine(double deg) {
    return std::sin(radians(deg));
}

double luminance(const Spectrum& light) {
    const glm::dvec3 c = colour_of(light);
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

TEST(Path, EndsAtTheGroundOrAtTheTopOfTheAir) {
    EXPECT_NEAR(path_of(0, 1).end_m, kTopOfAir_m, 1e-6);
    EXPECT_FALSE(path_of(0, 1).ground);
    EXPECT_NEAR(path_of(2, -1).end_m, 2, 1e-6);
    EXPECT_TRUE(path_of(2, -1).ground);
    // The horizon of 2 m is 5048 m away; from 400 km, straight down, there are 300 km of nothing.
    EXPECT_NEAR(path_of(2, horizon_sine(2) - 1e-12).end_m, 5048, 5);
    EXPECT_NEAR(path_of(400e3, -1).begin_m, 300e3, 1e-3);
    EXPECT_NEAR(path_of(400e3, -1).end_m, 400e3, 1e-3);
    EXPECT_EQ(path_of(400e3, 0).end_m, 0);
    // A ray that grazes 10 km has its lowest point there.
    const double r = (kEarthRadius_m + 10e3) / (kEarthRadius_m + 400e3);
    const double grazing = -std::sqrt(1 - r * r);
    EXPECT_NEAR(height_at(400e3, grazing, path_of(400e3, grazing).lowest_m), 10e3, 0.1);
    EXPECT_FALSE(path_of(400e3, grazing).ground);
}

TEST(Columns, AreTheIntegralsOfTheDensities) {
    std::vector<double> errors;
    for (const double height : {0.0, 150.0, 2300.0, 9000.0, 24000.0}) {
        const double edge = horizon_sine(height);
        for (const double t : {1e-4, 0.003, 0.02, 0.1, 0.5, 1.0}) {
            const double up = edge + (1 - edge) * t;
            const Path path = path_of(height, up);
            constexpr int kSteps = 200000;
            double rayleigh = 0, aerosol = 0, ozone = 0;
            for (int i = 0; i < kSteps; ++i) {
                const double h = height_at(height, up, path.end_m * (i + 0.5) / kSteps);
                rayleigh += rayleigh_density(h) * path.end_m / kSteps;
                aerosol += aerosol_density(h) * path.end_m / kSteps;
                ozone += ozone_density(h) * path.end_m / kSteps;
            }
            const Column found = Columns::shared().towards(height, up);
            errors.push_back(std::abs(found.rayleigh_m / rayleigh - 1));
            // Of what is thin, light knows little.
            errors.push_back(std::abs(found.aerosol_m - aerosol) / std::max(aerosol, 100.0));
            errors.push_back(std::abs(found.ozone_m / ozone - 1));
        }
    }
    const double worst = *std::max_element(errors.begin(), errors.end());
    fmt::print("[ accuracy ] columns of air, worst: {:.2f} %\n", 100 * worst);
    EXPECT_LT(worst, 0.02);
}

/// Light that leaves the air upwards, on a square metre of its top.
double leaving(const Atmosphere& air, double sun_sine) {
    constexpr int kRings = 24, kAround = 12;
    double sum = 0;
    for (int ring = 0; ring < kRings; ++ring) {
        const double down = -(ring + 0.5) / kRings;
        for (int i = 0; i < kAround; ++i)
            sum += luminance(air.radiance({.height_m = kTopOfAir_m,
                                           .sine = down,
                                           .sun_sine = sun_sine,
                                           .azimuth_cos = std::cos((i + 0.5) * kPi / kAround)})) *
                   -down * 2 / (kRings * kAround);
    }
    return sum;
}

TEST(Atmosphere, LosesNoLight) {
    // Without absorption, what comes in leaves at the top or stays in the ground. 60 degrees of
    // sun: the Earth is nearly flat.
    const Air pure{.angstrom_beta = 0, .ozone_du = 0, .ground_albedo = 0.3};
    const Atmosphere air(pure);
    const double sun = sine(60);
    const double ground = luminance(air.sunlight(SunRays(0), std::asin(sun))) * sun +
                          luminance(air.sky_irradiance(0, sun));
    const double out = leaving(air, sun);
    fmt::print("[ sky ] of {:.4f} the ground keeps {:.4f}, {:.4f} leave\n", sun, 0.7 * ground, out);
    EXPECT_NEAR((0.7 * ground + out) / sun, 1, 0.02);
}

TEST(Atmosphere, ShedsAsMuchLightAsClearSkiesDo) {
    // IES clear sky, 800 + 15500 sqrt(sin h) lux (IESNA RP-21); Explanatory Supplement to the
    // Astronomical Almanac (1992), p. 491: 3.4 lux at the end of civil twilight, of the sun 6
    // degrees below the horizon. Twilights differ by a factor of two from day to day. The air here
    // is cleaner than IES's, which tells most under a high sun.
    struct Row {
        double sun_deg, lux, share;
    };
    for (const Row& row : {Row{90, 16300, 0.12}, Row{60, 15225, 0.1}, Row{30, 11760, 0.15},
                           Row{10, 5700 + 1559, 0.15}, Row{0, 800, 0.3}, Row{-6, 3.4, 1.0}}) {
        const double lux = 127500 * luminance(clean().sky_irradiance(0, sine(row.sun_deg)));
        fmt::print("[ sky ] sun {:.0f} degrees high: {:.4g} lux, published {:.4g}\n", row.sun_deg,
                   lux, row.lux);
        EXPECT_NEAR(lux / row.lux, 1, row.share) << row.sun_deg;
    }
}

TEST(Atmosphere, SendsWhatItTakesAway) {
    // Up to a distance: less of what is there, more of the air; at its end all is the whole ray's.
    const Atmosphere::View view{.height_m = 1500, .sine = sine(2), .sun_sine = sine(20)};
    double before = 0, through = 1;
    for (const double distance : {1e3, 1e4, 1e5, 1e6}) {
        const double sent = luminance(clean().scattered_in(view, distance));
        const double passed = luminance(clean().transmittance(1500, view.sine, distance));
        EXPECT_GT(sent, before);
        EXPECT_LT(passed, through);
        before = sent;
        through = passed;
    }
    EXPECT_NEAR(before, luminance(clean().radiance(view)), 1e-9);
    // Koschmieder: after 1 km at the sea extinction is what Air says.
    EXPECT_NEAR(-std::log(luminance(clean().transmittance(0, 0, 1000))),
                1000 * white_extinction({.angstrom_beta = 0.04}),
                0.17 * 1000 * white_extinction({.angstrom_beta = 0.04}));
}

TEST(Atmosphere, HasTheEarthsShadowAndTheBeltOfVenus) {
    // Opposite to a sun 3 degrees below the horizon: reddish some degrees up, dark blue below.
    const auto colour = [](double elevation_deg) {
        return colour_of(clean().radiance(
            {.height_m = 0, .sine = sine(elevation_deg), .sun_sine = sine(-3), .azimuth_cos = -1}));
    };
    const glm::dvec3 shadow = colour(3), belt = colour(13);
    EXPECT_GT(belt.r / belt.b, 1.15 * shadow.r / shadow.b);
    EXPECT_GT(belt.r, 1.3 * shadow.r);
}

TEST(Atmosphere, OzoneMakesTheZenithOfDuskBlue) {
    const Atmosphere none(Air{.ozone_du = 0});
    const Atmosphere::View view{.height_m = 0, .sine = 1, .sun_sine = sine(-4)};
    const glm::dvec3 with = colour_of(clean().radiance(view)),
                     without = colour_of(none.radiance(view));
    EXPECT_GT(with.b / with.r, 1.8 * without.b / without.r);
}

TEST(Atmosphere, LightsSummitsAfterTheValleys) {
    const auto light = [](double height_m, double sun_deg) {
        return clean().sunlight(SunRays(height_m), radians(sun_deg));
    };
    EXPECT_EQ(luminance(light(0, -0.9)), 0);
    EXPECT_GT(luminance(light(4000, -1.5)), 0.001);
    const glm::dvec3 glow = colour_of(light(4000, -1));
    EXPECT_GT(glow.r, 3 * std::max(glow.g, 0.0));
    EXPECT_EQ(luminance(light(4000, -3.2)), 0);
}

TEST(Atmosphere, IsBrighterAndWhiterWhereTheAirIsTurbid) {
    const Atmosphere turbid(Air{.angstrom_beta = 0.2});
    const Atmosphere::View view{
        .height_m = 0, .sine = sine(20), .sun_sine = sine(40), .azimuth_cos = 0.5};
    const glm::dvec3 dusty = colour_of(turbid.radiance(view)),
                     clear = colour_of(clean().radiance(view));
    EXPECT_GT(dusty.g, 1.3 * clear.g);
    EXPECT_LT(dusty.b / dusty.r, 0.9 * clear.b / clear.r);
    const SunRays rays(0);
    EXPECT_LT(luminance(turbid.sunlight(rays, radians(40))),
              0.75 * luminance(clean().sunlight(rays, radians(40))));
}

/// Share of the sky in the light of level ground from 400 to 700 nm.
double share_of_sky(const Atmosphere& air, double height_m, double sun_deg) {
    const SunRays rays(height_m);
    const Spectrum direct = air.sunlight(rays, radians(sun_deg)),
                   diffuse = air.sky_irradiance(height_m, sine(sun_deg));
    double by_sun = 0, by_sky = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
        by_sun += solar_irradiance()[k] * sine(sun_deg) * direct[k];
        by_sky += solar_irradiance()[k] * diffuse[k];
    }
    return by_sky / (by_sun + by_sky);
}

// Shares of all light in clear hours with the sun at 24 to 31 degrees, times 1.23 (ASTM G173) for
// that from 400 to 700 nm: docs/accuracy-sky.md.
TEST(Atmosphere, SharesItsLightAsOnAnAverageClearDay) {
    const Atmosphere average;
    const double denver = share_of_sky(average, 1650, 27.5),
                 of_clean_air = share_of_sky(clean(), 1650, 27.5);
    fmt::print(
        "[ accuracy ] share of the sky, Denver {:.3f}, in clean air {:.3f}; Santiago {:.3f}\n",
        denver, of_clean_air, share_of_sky(average, 474, 27.5));
    EXPECT_NEAR(denver, 1.23 * 0.146, 0.015);
    EXPECT_LT(of_clean_air, 1.23 * 0.146 - 0.015);
    EXPECT_NEAR(share_of_sky(average, 474, 27.5), 1.23 * 0.285, 0.06);
}

}  // namespace
}  // namespace relevo::sky
