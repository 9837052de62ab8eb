#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "sky/eye_tables.h"
#include "sky/night.h"
#include "sky/path.h"
#include "sky/shipped.h"

namespace relevo::sky::test_eye_tables {
namespace {

const Atmosphere& average() {
    static const Atmosphere kAverage;
    return kAverage;
}

double luminance(const glm::dvec3& c) {
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

/// As a sampler reads a table of two dimensions, 0 and 1 at the outer texels' centres.
glm::dvec3 read(const glm::vec4* table, int columns, int rows, double u, double v) {
    const double x = u * (columns - 1), y = v * (rows - 1);
    const int i = std::min(static_cast<int>(x), columns - 2);
    const int j = std::min(static_cast<int>(y), rows - 2);
    const auto at = [&](int c, int r) { return glm::dvec3(table[r * columns + c]); };
    return glm::mix(glm::mix(at(i, j), at(i + 1, j), x - i),
                    glm::mix(at(i, j + 1), at(i + 1, j + 1), x - i), y - j);
}

/// The inverse of EyeLayout::sine_above() and sine_below().
double row_of(const EyeLayout& layout, double sine, bool above) {
    const double x = above ? (sine - layout.horizon) / (1 - layout.horizon)
                           : (layout.horizon - sine) / (1 + layout.horizon);
    const double band = above ? layout.above_band : layout.below_band;
    return 0.2 * x + 0.8 * std::sqrt(x * (1 + band) / (x + band));
}

TEST(EyeLayout, CoversAllElevations) {
    for (const double height : {0.0, 2.0, 300.0, 3e3, 11e3, 40e3, 400e3}) {
        const EyeLayout layout(height);
        EXPECT_NEAR(layout.sine_above(0), layout.horizon, 1e-12);
        EXPECT_NEAR(layout.sine_above(1), 1, 1e-12);
        EXPECT_NEAR(layout.sine_below(0), layout.horizon, 1e-12);
        EXPECT_NEAR(layout.sine_below(1), -1, 1e-12);
        EXPECT_NEAR(layout.sine_between(0.5), layout.horizon, 1e-12);
        for (const double v : {0.1, 0.5, 0.9}) {
            EXPECT_NEAR(row_of(layout, layout.sine_above(v), true), v, 1e-9);
            EXPECT_NEAR(row_of(layout, layout.sine_below(v), false), v, 1e-9);
        }
    }
}

TEST(EyeTables, BetweenTheirTexelsAreTheAtmospheresRadiance) {
    // Between texels, from the sea to orbit, of suns from noon to dusk.
    for (const double height : {2.0, 300.0, 3e3, 11e3, 40e3, 400e3}) {
        for (const double sun_deg : {40.0, 5.0, 0.0, -4.0, -8.0}) {
            const double sun = std::sin(radians(sun_deg));
            const EyeTables tables = eye_tables(average(), height, sun);
            std::vector<double> errors;
            double brightest = 0;
            std::vector<double> of_brightest;
            for (double v = 0.03; v < 0.995; v += 0.061) {
                for (double u = 0.05; u < 1; u += 0.15) {
                    const double sine = tables.layout.sine_above(v);
                    const double azimuth_cos = EyeLayout::azimuth_cos(u);
                    const glm::dvec3 night = night_radiance(
                        height, sine, colour_of(average().transmittance(height, sine, 1e9)).g);
                    const double expected = luminance(
                        colour_of(average().radiance({height, sine, sun, azimuth_cos})) + night);
                    const double phase = aerosol_phase(ray_sun_cosine(sine, {sun, azimuth_cos}));
                    constexpr int kLayer =
                        EyeLayout::kAzimuths * (EyeLayout::kAbove + EyeLayout::kBelow);
                    const auto layer = [&](int l) {
                        return read(tables.sky.data() + l * kLayer, EyeLayout::kAzimuths,
                                    EyeLayout::kAbove, u, v);
                    };
                    const double found = luminance(layer(0) + phase * layer(1));
                    if (expected < 1e-7) continue;
                    errors.push_back(std::abs(found / expected - 1));
                    brightest = std::max(brightest, expected);
                    of_brightest.push_back(std::abs(found - expected));
                }
            }
            ASSERT_FALSE(errors.empty());
            double mean = 0;
            for (const double e : errors)
                mean += e / static_cast<double>(errors.size());
            const double worst = *std::max_element(errors.begin(), errors.end());
            fmt::print(
                "[ accuracy ] sky from {:.0f} m, sun {:.0f}: mean {:.2f} %, worst {:.1f} %\n",
                height, sun_deg, 100 * mean, 100 * worst);
            // From orbit, few rows are in the thin upper air.
            EXPECT_LT(mean, height > 100e3 ? 0.07 : 0.01) << height << " " << sun_deg;
            EXPECT_LT(*std::max_element(of_brightest.begin(), of_brightest.end()),
                      0.02 * brightest);
        }
    }
}

TEST(EyeTables, AirBetweenScattersAndPassesWhatTheAtmosphereDoes) {
    for (const double height : {2.0, 3e3, 11e3, 60e3, 400e3}) {
        for (const double sun_deg : {40.0, 5.0, -4.0}) {
            const double sun = std::sin(radians(sun_deg));
            const EyeTables tables = eye_tables(average(), height, sun);
            std::vector<double> errors, passed;
            // On texels, between distances.
            for (const int row : {2, 12, 20, 23, 26}) {
                for (const int column : {3, 12, 20}) {
                    for (double w = 0.1; w < 0.9; w += 0.083) {
                        const double sine =
                            tables.layout.sine_between(row / (EyeLayout::kBetweenElevations - 1.0));
                        const double way = tables.layout.distance_m(w, sine);
                        const double u = column / (EyeLayout::kBetweenAzimuths - 1.0);
                        const Path path = path_of(height, sine);
                        const double distance = path.begin_m + way;
                        if (path.ground && distance > path.end_m) continue;
                        if (height_at(height, sine, distance) > 9e3 && height > 9e3) continue;
                        constexpr int kSlice =
                            EyeLayout::kBetweenAzimuths * EyeLayout::kBetweenElevations;
                        const double z = w * (EyeLayout::kDistances - 1);
                        const int slice = static_cast<int>(z);
                        const auto at = [&](int s) {
                            const auto texel = static_cast<std::size_t>(
                                s * kSlice + row * EyeLayout::kBetweenAzimuths + column);
                            const glm::dvec4 once(
                                tables.between[tables.between.size() / 2 + texel]);
                            return glm::dvec4(tables.between[texel]) +
                                   glm::dvec4(once.x, once.y, once.z, 0);
                        };
                        const glm::dvec4 air = glm::mix(at(slice), at(slice + 1), z - slice);
                        const glm::dvec3 through =
                            glm::exp(-air.a * way * glm::dvec3(tables.colour));
                        const glm::dvec3 scattered = glm::dvec3(air) * (1.0 - through);
                        const double expected = luminance(colour_of(average().scattered_in(
                            {height, sine, sun, EyeLayout::azimuth_cos(u)}, distance)));
                        errors.push_back(std::abs(luminance(scattered) / expected - 1));
                        passed.push_back(
                            std::abs(through.g -
                                     colour_of(average().transmittance(height, sine, distance)).g));
                    }
                }
            }
            const double worst = *std::max_element(errors.begin(), errors.end());
            const double lost = *std::max_element(passed.begin(), passed.end());
            fmt::print(
                "[ accuracy ] air between, from {:.0f} m, sun {:.0f}: scattered {:.1f} %, "
                "passed {:.3f}\n",
                height, sun_deg, 100 * worst, lost);
            EXPECT_LT(worst, height < 20e3 ? 0.012 : 0.04) << height << " " << sun_deg;
            EXPECT_LT(lost, 0.005) << height << " " << sun_deg;
        }
    }
}

TEST(EyeTables, AreMadeForHeightsAndSunsNearby) {
    // As far from those that tables are made for as can be; rows count from the true horizon.
    double worst = 0;
    for (const double made_for : {2.0, 300.0, 3e3, 11e3, 40e3}) {
        const double nearest = nearest_eye_height_m(made_for),
                     height = nearest + 0.00249 * (nearest + 100);
        EXPECT_EQ(nearest_eye_height_m(height), nearest);
        EXPECT_EQ(nearest_eye_height_m(nearest), nearest);
        const EyeLayout layout(nearest), here(height);
        for (const double sun_deg : {40.0, 5.0, 0.0, -4.0, -8.0}) {
            const double near_sun = nearest_sun_sine(std::sin(radians(sun_deg))),
                         sun = near_sun + 0.499e-4;
            EXPECT_EQ(nearest_sun_sine(sun), near_sun);
            for (const double v : {0.03, 0.1, 0.3, 0.6, 1.0}) {
                for (const double azimuth_cos : {-1.0, 0.3, 0.99}) {
                    const double near_sine = layout.sine_above(v),
                                 away = (near_sine - layout.horizon) / (1 - layout.horizon),
                                 sine = here.horizon + away * (1 - here.horizon);
                    const auto light = [&](double h, double s, double of_sun) {
                        return luminance(
                            colour_of(average().radiance({h, s, of_sun, azimuth_cos})));
                    };
                    const double found = light(nearest, near_sine, near_sun);
                    worst = std::max(worst, std::abs(found / light(height, sine, sun) - 1));
                }
            }
        }
    }
    fmt::print("[ accuracy ] tables for nearby heights and suns, worst: {:.2f} %\n", 100 * worst);
    EXPECT_LT(worst, 0.015);
}

TEST(EyeTables, HaveTheHorizonsTwoSidesInTheirRows) {
    // The last row of air before space, the first of air before the ground.
    for (const double height : {2.0, 3000.0, 400e3}) {
        const double sun = std::sin(radians(20.0));
        const EyeTables tables = eye_tables(average(), height, sun);
        constexpr std::size_t kRow = EyeLayout::kAzimuths;
        for (const auto& [row, aside] :
             {std::pair{std::size_t{0}, 1e-9}, std::pair{std::size_t{EyeLayout::kAbove}, -1e-9}}) {
            for (std::size_t i = 0; i < kRow; i += 13) {
                const double azimuth_cos = EyeLayout::azimuth_cos(i / (kRow - 1.0));
                const double sine = tables.layout.horizon + aside;
                const Sun at{sun, azimuth_cos};
                const Brought expected = average().brought(height, sine, std::span(&at, 1)).front();
                Spectrum air{};
                std::copy(expected.air.begin(), expected.air.end(), air.begin());
                EXPECT_NEAR(
                    luminance(tables.sky[row * kRow + i]) / (kPi * luminance(colour_of(air))), 1,
                    0.02)
                    << height << " " << aside;
            }
        }
    }
}

/// Luminance of the tables in units of that of the night on level ground.
double night_seen(const EyeTables& tables, std::size_t row) {
    constexpr std::size_t kRow = EyeLayout::kAzimuths,
                          kLayer = kRow * (EyeLayout::kAbove + EyeLayout::kBelow);
    constexpr double kAlbedo = 0.13;
    return (luminance(tables.sky[row * kRow]) +
            kAlbedo * luminance(tables.sky[2 * kLayer + row * kRow])) /
           luminance(night_irradiance());
}

TEST(EyeTables, FromOrbitTheEarthAtNightIsBrighterThanSpace) {
    const EyeTables tables = eye_tables(average(), 400e3, -1);
    constexpr std::size_t kZenith = EyeLayout::kAbove - 1,
                          kNadir = EyeLayout::kAbove + EyeLayout::kBelow - 1;
    double limb = 0;
    for (std::size_t row = 0; row < EyeLayout::kAbove; ++row)
        limb = std::max(limb, night_seen(tables, row));
    fmt::print("[ sky ] night from 400 km: zenith {:.2f}, nadir {:.2f}, limb {:.1f}\n",
               night_seen(tables, kZenith), night_seen(tables, kNadir), limb);
    EXPECT_GT(night_seen(tables, kNadir), 2 * night_seen(tables, kZenith));
    EXPECT_GT(limb, 5 * night_seen(tables, kNadir));  // airglow, seen edgewise
}

TEST(Night, ShedsTwoThousandthsOfALux) {
    double lux = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
        const double sine = (i + 0.5) / kSteps;
        const glm::dvec3 through = colour_of(average().transmittance(0, sine, 1e9));
        lux += 127500 * 2 * sine / kSteps * luminance(night_radiance(0, sine, through.g));
    }
    fmt::print("[ sky ] moonless night: {:.5f} lux\n", lux);
    EXPECT_NEAR(lux, 0.002, 0.0002);
    EXPECT_NEAR(127500 * luminance(night_irradiance()), 0.002, 1e-4);
}

TEST(Shipped, TheDefaultAtmosphereIsTheOneThatIsComputed) {
    const auto shipped = atmosphere_of(Air{});
    EXPECT_EQ(shipped, atmosphere_of(Air{}));
    const Diffuse &found = shipped->diffuse().at(7, 50), &expected = average().diffuse().at(7, 50);
    for (std::size_t k = 0; k < kWavelengths; ++k)
        EXPECT_EQ(found.moments[0][k], expected.moments[0][k]);
    EXPECT_NE(atmosphere_of(Air{.angstrom_beta = 0.1}), shipped);
}

TEST(Shipped, KeepsTheAirsThatWereAskedForLast) {
    const auto of = [](double albedo) { return atmosphere_of(Air{.ground_albedo = albedo}); };
    const auto shipped = atmosphere_of(Air{}), first = of(0.3);
    for (const double albedo : {0.4, 0.5, 0.6})
        of(albedo);
    EXPECT_EQ(of(0.3), first);
    of(0.7);
    EXPECT_EQ(of(0.3), first);
    EXPECT_EQ(atmosphere_of(Air{}), shipped);
}

TEST(Night, KeepsItsBlueDownToTheHorizon) {
    for (const double height : {2.0, 1000.0, 3000.0})
        for (double v = 0; v < 1; v += 0.02) {
            const double sine = EyeLayout(height).sine_above(v) + 1e-6;
            const glm::dvec3 light = night_radiance(
                height, sine, colour_of(average().transmittance(height, sine, 1e9)).g);
            EXPECT_GT(light.b, 0.6 * light.g) << height << " " << sine;
            EXPECT_GT(light.r, 0.5 * light.g) << height << " " << sine;
        }
}

}  // namespace
}  // namespace relevo::sky::test_eye_tables
