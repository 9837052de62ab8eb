#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/units.h"
#include "path_integral.h"

namespace relevo::skymaker {
namespace {

using sky::kEarthRadius_m;
using sky::kWavelengths;

constexpr double kTop = kEarthRadius_m + sky::kTopOfAir_m;

/// The value of one wavelength.
std::function<double(const Spectrum&)> at(std::size_t k) {
    return [k](const Spectrum& s) { return s[k]; };
}

void expect_within(const Figure& figure, double value, const std::string& what) {
    EXPECT_NEAR(figure.value, value, 4 * figure.standard_error + 1e-3 * value)
        << what << ", standard error " << figure.standard_error;
    EXPECT_LT(figure.standard_error, 0.02 * value) << what;
}

/// Optical depth by the midpoint rule, from a height along a direction; negative if the Earth is in
/// the way.
double depth_to_space(const sky::Extinction& e, double radius, double sine, std::size_t k) {
    constexpr int kSteps = 1500;
    const double across2 = radius * radius * (1 - sine * sine);
    if (sine < 0 && across2 < kEarthRadius_m * kEarthRadius_m) return -1;
    const double length = -radius * sine + std::sqrt(kTop * kTop - across2);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double d = (i + 0.5) * length / kSteps;
        const double h = std::max(
            0.0, std::sqrt(radius * radius + d * d + 2 * radius * sine * d) - kEarthRadius_m);
        sum += sky::rayleigh_density(h) * e.rayleigh[k] + sky::aerosol_density(h) * e.aerosol[k] +
               sky::ozone_density(h) * e.ozone[k];
    }
    return sum * length / kSteps;
}

/// Light scattered once, of a sun without a disc, by quadrature along the line of sight from sea
/// level.
double single_scattering(const Medium& m, double sun_rad, const Sight& sight, std::size_t k) {
    constexpr int kSteps = 3000;
    const sky::Extinction& e = m.extinction;
    const double sine = std::sin(sight.elevation_rad), sun = std::sin(sun_rad);
    const double cosine = sine * sun + std::cos(sight.elevation_rad) * std::cos(sun_rad) *
                                           std::cos(sight.azimuth_rad);
    const double length = -kEarthRadius_m * sine +
                          std::sqrt(kTop * kTop - std::pow(kEarthRadius_m, 2) * (1 - sine * sine));
    double sum = 0, depth = 0, before = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double next = length * std::pow((i + 1.0) / kSteps, 2);
        const double width = next - before, d = 0.5 * (next + before);
        before = next;
        const double r =
            std::sqrt(kEarthRadius_m * kEarthRadius_m + d * d + 2 * kEarthRadius_m * sine * d);
        const double h = std::max(0.0, r - kEarthRadius_m);
        const double rayleigh = sky::rayleigh_density(h) * e.rayleigh[k];
        const double aerosol = sky::aerosol_density(h) * e.aerosol[k];
        const double taken = rayleigh + aerosol + sky::ozone_density(h) * e.ozone[k];
        const double to_sun = depth_to_space(e, r, (kEarthRadius_m * sun + d * cosine) / r, k);
        if (to_sun >= 0)
            sum += width * std::exp(-depth - 0.5 * width * taken - to_sun) *
                   (rayleigh * sky::rayleigh_phase(cosine) +
                    aerosol * m.aerosol_albedo * sky::aerosol_phase(cosine));
        depth += width * taken;
    }
    return kPi * sum;
}

TEST(PathIntegral, FirstOrderIsTheQuadratureAlongTheLineOfSight) {
    Medium medium = medium_of({.angstrom_beta = 0.04});
    medium.ground_albedo = 0;
    for (const double sun_deg : {60.0, 5.0, -3.0, -7.0}) {
        const PathIntegral integral(medium, radians(sun_deg), 0);
        for (const Sight& sight : {Sight{0, radians(4), radians(20)},
                                   Sight{0, radians(30), radians(120)}, Sight{0, radians(90), 0}}) {
            const Batches batches = integral.radiance(sight, {.paths = 200, .orders = 1});
            for (const std::size_t k : {std::size_t{1}, std::size_t{12}})
                expect_within(figure(batches, at(k)),
                              single_scattering(medium, radians(sun_deg), sight, k),
                              fmt::format("sun {} elevation {:.0f} wavelength {}", sun_deg,
                                          degrees(sight.elevation_rad), k));
        }
    }
}

/// An atmosphere that absorbs nothing, over white ground, with light from everywhere: what the eye
/// sees is as bright as space, wherever it looks.
TEST(PathIntegral, LosesNoLightWhereNothingAbsorbs) {
    Medium medium = medium_of({.angstrom_beta = 0.1, .ozone_du = 0, .ground_albedo = 1});
    medium.aerosol_albedo = 1;
    double sum = 0, weights = 0;
    for (const double sun_deg : {40.0, 4.0}) {  // says where directions are drawn, no more
        const PathIntegral integral(medium, radians(sun_deg), kPi);
        for (const Sight& sight :
             {Sight{0, radians(3), 1}, Sight{0, radians(70), 0}, Sight{3000, radians(-5), 2},
              Sight{11000, radians(1), 1}, Sight{400000, radians(-19.8), 1},
              Sight{400000, radians(-70), 1}}) {
            const Batches batches = integral.radiance(sight, {.paths = 200});
            const Spectrum through = integral.transmittance(sight);
            for (const std::size_t k : {std::size_t{0}, std::size_t{8}, std::size_t{15}}) {
                const Figure scattered = figure(batches, at(k));
                const double whole = 4 * scattered.value + through[k];
                const double error = 4 * scattered.standard_error;
                EXPECT_NEAR(whole, 1, 4 * error + 1e-3) << sun_deg << " " << sight.height_m << " "
                                                        << degrees(sight.elevation_rad) << " " << k;
                EXPECT_LT(error, 0.1);
                sum += whole / (error * error);
                weights += 1 / (error * error);
            }
        }
    }
    fmt::print("[ accuracy ] light that comes out again: {:.4f} +- {:.4f} of all\n", sum / weights,
               1 / std::sqrt(weights));
    EXPECT_NEAR(sum / weights, 1, 0.012);
}

/// Chandrasekhar's H for isotropic scattering, by iteration of its integral equation.
double h_function(double albedo, double cosine) {
    constexpr std::size_t kSteps = 400;
    std::array<double, kSteps> h{};
    h.fill(1);
    const auto value = [&](double mu) {
        double sum = 0;
        for (std::size_t i = 0; i < kSteps; ++i) {
            const double m = (static_cast<double>(i) + 0.5) / kSteps;
            sum += m * h[i] / (mu + m) / kSteps;
        }
        return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
    };
    for (int round = 0; round < 60; ++round) {
        std::array<double, kSteps> better{};
        for (std::size_t i = 0; i < kSteps; ++i)
            better[i] = 0.5 * (h[i] + value((static_cast<double>(i) + 0.5) / kSteps));
        h = better;
    }
    return value(cosine);
}

/// S. Chandrasekhar, Radiative Transfer, 1950, section 34: light that comes back from a deep
/// plane-parallel medium that scatters alike in all directions.
TEST(PathIntegral, AllOrdersTogetherAreChandrasekharsForADeepIsotropicMedium) {
    Medium medium;
    medium.extinction.aerosol.fill(12 / sky::kAerosolScaleHeight_m);
    medium.aerosol_asymmetry = 0;
    for (const double albedo : {0.5, 0.8}) {
        medium.aerosol_albedo = albedo;
        for (const double sun_deg : {80.0, 30.0}) {
            const PathIntegral integral(medium, radians(sun_deg), 0);
            const double mu0 = std::sin(radians(sun_deg));
            for (const double down_deg : {90.0, 50.0}) {
                const double mu = std::sin(radians(down_deg));
                const Sight sight{sky::kTopOfAir_m, radians(-down_deg), radians(90)};
                // The eye's horizon is not that of the air it sees.
                const double miss = (kTop / kEarthRadius_m) * std::cos(radians(down_deg));
                const double there = std::sqrt(1 - miss * miss);
                const double bend = std::acos(there) - std::acos(mu);
                const double sun_there = mu0 * std::cos(bend);  // seen across
                const double expected = albedo / 4 * sun_there / (there + sun_there) *
                                        h_function(albedo, there) * h_function(albedo, sun_there);
                expect_within(figure(integral.radiance(sight, {.paths = 200}), at(7)), expected,
                              fmt::format("albedo {} sun {} down {}", albedo, sun_deg, down_deg));
            }
        }
    }
}

TEST(PathIntegral, WithoutAirTheSkyIsBlackAndTheGroundAsLit) {
    Medium medium;
    medium.ground_albedo = 0.3;
    const PathIntegral integral(medium, radians(30.0), 0);
    EXPECT_EQ(mean(integral.radiance({0, radians(20), 0}, {.paths = 4}))[3], 0);
    EXPECT_NEAR(mean(integral.radiance({2000, radians(-90), 0}, {.paths = 4}))[3],
                0.3 * std::sin(radians(30.0)), 1e-6);
    EXPECT_EQ(integral.transmittance({0, radians(20), 0})[0], 1);
    EXPECT_EQ(integral.transmittance({2000, radians(-20), 0})[0], 0);
    EXPECT_EQ(mean(integral.radiance({500000, radians(10), 0}, {.paths = 4}))[3], 0);
}

TEST(PathIntegral, EyesAboveTheAirSeeWhatEyesAtItsTopSee) {
    const PathIntegral integral(medium_of({.angstrom_beta = 0.04}), radians(20.0));
    const Figure top =
        figure(integral.radiance({sky::kTopOfAir_m, radians(-90), 0}, {.paths = 200}), at(4));
    const Figure orbit =
        figure(integral.radiance({400000, radians(-90), 0}, {.paths = 200, .seed = 2}), at(4));
    EXPECT_NEAR(top.value, orbit.value, 4 * std::hypot(top.standard_error, orbit.standard_error));
}

/// The irradiance is the cosine-weighted mean of radiances.
TEST(PathIntegral, IrradianceIsTheIntegralOfRadiance) {
    const PathIntegral integral(medium_of({.angstrom_beta = 0.04}), radians(8.0));
    double sum = 0, squares = 0;
    constexpr int kUp = 10, kAround = 12;
    for (int i = 0; i < kUp; ++i)
        for (int j = 0; j < kAround; ++j) {
            const double sine = std::sqrt((i + 0.5) / kUp);
            const Sight sight{0, std::asin(sine), kPi * (j + 0.5) / kAround};
            const Figure f = figure(integral.radiance(sight, {.batches = 8, .paths = 40}), at(6));
            sum += f.value / (kUp * kAround);
            squares += std::pow(f.standard_error / (kUp * kAround), 2);
        }
    const Figure whole = figure(integral.irradiance(0, {.paths = 400}), at(6));
    EXPECT_NEAR(whole.value, sum,
                4 * std::hypot(whole.standard_error, std::sqrt(squares)) + 0.01 * sum);
}

TEST(PathIntegral, GivesTheSameNumbersAgain) {
    const PathIntegral integral(medium_of({.angstrom_beta = 0.04}), radians(-4.0));
    const Sight sight{0, radians(10), 0};
    EXPECT_EQ(integral.radiance(sight, {.batches = 4, .paths = 20}),
              integral.radiance(sight, {.batches = 4, .paths = 20}));
}

}  // namespace
}  // namespace relevo::skymaker
