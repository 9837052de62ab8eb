#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "sky/air.h"

namespace relevo::sky {
namespace {

/// Midpoint rule over heights, 10 m apart [m].
double column_m(const std::function<double(double)>& density) {
    double sum = 0;
    for (double h = 5; h < 2 * kTopOfAir_m; h += 10)
        sum += 10 * density(h);
    return sum;
}

double over_sphere(double (*phase)(double)) {
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        sum += phase((2 * i + 1.0) / kSteps - 1) * 4 * kPi / kSteps;
    return sum;
}

TEST(Air, PhaseFunctionsScatterAllLight) {
    EXPECT_NEAR(over_sphere(rayleigh_phase), 1, 1e-6);
    EXPECT_NEAR(over_sphere(aerosol_phase), 1, 1e-5);
    double asymmetry = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double cosine = (2 * i + 1.0) / kSteps - 1;
        asymmetry += cosine * aerosol_phase(cosine) * 4 * kPi / kSteps;
    }
    EXPECT_NEAR(asymmetry, kAerosolAsymmetry, 1e-4);
}

TEST(Air, OpticalDepthsAreThoseOfItsParameters) {
    const Air air{.angstrom_beta = 0.2, .angstrom_alpha = 1.1, .ozone_du = 350};
    const Extinction e = extinction(air);
    for (int i = 0; i < kWavelengths; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double um = wavelength_um(i);
        const double aerosol = 0.2 * std::pow(um, -1.1);
        EXPECT_NEAR(e.aerosol[k] * column_m(aerosol_density), aerosol, 2e-5 * aerosol);
        EXPECT_NEAR(aerosol_depth(air, um), aerosol, 1e-12);
        // 1 Dobson unit is 10 um of pure gas at 0 degrees C and 1 atm, Loschmidt's 2.687e25 / m3.
        const double ozone = 350 * 1e-5 * 2.687e25 * ozone_cross_section()[k];
        EXPECT_NEAR(e.ozone[k] * column_m(ozone_density), ozone, 1e-4 * ozone);
        // Hansen and Travis 1974: 0.0973 at 550 nm.
        const double rayleigh = e.rayleigh[k] * column_m(rayleigh_density);
        EXPECT_NEAR(rayleigh, 0.0973 * std::pow(um / 0.55, -4.08), 0.02 * rayleigh);
    }
}

/// U.S. Standard Atmosphere, 1976, table 1: 1.2250 kg/m3 at sea level.
TEST(Air, HasTheDensitiesOfTheStandardAtmosphere) {
    struct Row {
        double km, kg_m3;
    };
    for (const Row& row : {Row{0, 1.2250}, Row{5, 0.73643}, Row{10, 0.41351}, Row{20, 0.088910},
                           Row{30, 0.018410}, Row{40, 3.9957e-3}, Row{50, 1.0269e-3},
                           Row{60, 3.0968e-4}, Row{70, 8.2829e-5}, Row{80, 1.8458e-5}})
        EXPECT_NEAR(1.2250 * rayleigh_density(1e3 * row.km) / row.kg_m3, 1, 2e-3) << row.km;
    EXPECT_NEAR(column_m(rayleigh_density), kRayleighColumn_m, 10);
    EXPECT_LT(rayleigh_density(200000), 1e-8);
}

TEST(Air, LittleOfItsColumnIsAboveTheTop) {
    EXPECT_LT(rayleigh_density(kTopOfAir_m), 1e-6);
    EXPECT_EQ(ozone_density(kTopOfAir_m), 0);
}

TEST(Spectrum, TheSunItselfIsWhite) {
    Spectrum one{};
    one.fill(1);
    const glm::dvec3 white = colour_of(one);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(white[c], 1, 1e-12);
}

TEST(Spectrum, ColoursHaveTheTristimulusValuesOfTheirLight) {
    Spectrum one{}, blue{};
    one.fill(1);
    EXPECT_NEAR(xyz_of(one).y, 1, 1e-12);
    // The sun outside the atmosphere, a light of about 5900 K.
    EXPECT_NEAR(chromaticity(xyz_of(one)).x, 0.204, 0.003);
    EXPECT_NEAR(chromaticity(xyz_of(one)).y, 0.472, 0.003);
    for (int i = 0; i < kWavelengths; ++i)
        blue[static_cast<std::size_t>(i)] = 0.01 * std::pow(wavelength_um(i), -4);
    const glm::dvec3 direct = xyz_of(blue), by_colour = xyz_of_colour(colour_of(blue));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(by_colour[c], direct[c], 1e-12);
    EXPECT_LT(chromaticity(direct).y, 0.44);
    // D65 by its definition.
    EXPECT_NEAR(chromaticity({0.95047, 1, 1.08883}).x, 0.1978, 1e-4);
    EXPECT_NEAR(chromaticity({0.95047, 1, 1.08883}).y, 0.4683, 1e-4);
}

TEST(Spectrum, WavelengthsGoFrom400To700Nanometres) {
    EXPECT_DOUBLE_EQ(wavelength_um(0), 0.4);
    EXPECT_DOUBLE_EQ(wavelength_um(kWavelengths - 1), 0.7);
}

}  // namespace
}  // namespace relevo::sky
