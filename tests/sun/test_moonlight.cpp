#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/daylight.h"
#include "sun/moonlight.h"
#include "sun/tables.h"

namespace relevo::sun::test_moonlight {
namespace {

double lux(const glm::dvec3& irradiance) {
    return kSolarIlluminance_lux * dot(irradiance, glm::dvec3(0.2126, 0.7152, 0.0722));
}

MoonPosition moon_at(double phase_angle_deg) {
    MoonPosition moon;
    moon.phase_angle_rad = radians(phase_angle_deg);
    moon.illuminated_fraction = (1 + std::cos(moon.phase_angle_rad)) / 2;
    moon.distance_au = 384400000 / 149597870700.0;
    moon.semidiameter_rad = semidiameter_rad(moon.distance_au, Body::Moon);
    return moon;
}

TEST(Moonlight, IsThatOfTheTables) {
    // A quarter of a lux at full moon; at the quarters a tenth of that (Allen; Krisciunas and
    // Schaefer 1991).
    const double full = lux(moonlight(moon_at(0))), half = lux(moonlight(moon_at(90)));
    EXPECT_NEAR(full, 0.31, 0.03);
    EXPECT_NEAR(full / half, 11, 1.5);
    MoonPosition near = moon_at(0);
    near.distance_au *= 0.93;
    EXPECT_NEAR(lux(moonlight(near)) / full, 1 / (0.93 * 0.93), 1e-9);
    // Redder than sunlight.
    EXPECT_GT(moonlight(near).r, 1.2 * moonlight(near).b);
}

TEST(Moonlight, OfTheDiscIsItsRadianceOverIt) {
    // The disc of the shader, lit by the law of Lommel and Seeliger, integrated.
    for (const double phase_deg : {0.0, 40.0, 90.0, 130.0}) {
        const MoonPosition moon = moon_at(phase_deg);
        const glm::dvec3 to_sun(std::sin(moon.phase_angle_rad), 0, std::cos(moon.phase_angle_rad));
        constexpr int kSteps = 800;
        double sum = 0;
        for (int j = 0; j < kSteps; ++j)
            for (int i = 0; i < kSteps; ++i) {
                const double x = (2 * i + 1.0) / kSteps - 1, y = (2 * j + 1.0) / kSteps - 1;
                if (x * x + y * y >= 1) continue;
                const glm::dvec3 normal(x, y, std::sqrt(1 - x * x - y * y));
                const double sun = std::max(0.0, dot(normal, to_sun));
                sum += 2 * sun / (sun + normal.z);
            }
        const double side = 2 * std::sin(moon.semidiameter_rad) / kSteps;
        const double shed = moon_radiance(moon).g * sum * side * side / kPi;
        EXPECT_NEAR(shed / moonlight(moon).g, 1, 0.01) << phase_deg;
    }
    // Dark as asphalt.
    EXPECT_NEAR(moon_radiance(moon_at(0)).g, 0.12, 0.02);
}

TEST(Moonlight, OfTheSkyIsThatOfADaysSky) {
    const glm::dvec3 light = moonlight(moon_at(0));
    EXPECT_NEAR(lux(moonlit_sky_irradiance(radians(45), light)), 0.033, 0.006);
    EXPECT_EQ(moonlit_sky_irradiance(radians(-1), light), glm::dvec3(0));
}

TEST(Eclipse, LeavesTheSkySomeLux) {
    EXPECT_EQ(eclipsed_sky(1), 1);
    EXPECT_NEAR(eclipsed_sky(0.5), 0.5, 2e-4);
    EXPECT_NEAR(eclipsed_sky(0) * sky_illuminance_lux(radians(45)), 4, 1);
}

TEST(NaturalExposure, OfMoonlightAndEclipsesLeavesThemDarker) {
    // To the bit without either.
    for (const double h_deg : {60.0, 5.0, -3.0, -30.0})
        EXPECT_EQ(natural_exposure(radians(h_deg)), natural_exposure(radians(h_deg), 1, 0));
    // White ground under a full moon is brighter than under stars and darker than at noon.
    const double night = radians(-30);
    const double stars = 0.002 * natural_exposure(night);
    const double moonlit = 0.222 * natural_exposure(night, 1, 0.22);
    EXPECT_GT(moonlit, 5 * stars);
    EXPECT_LT(moonlit, 10 * stars);
    EXPECT_LT(moonlit, 0.2 * kSolarIlluminance_lux);
    // Nine tenths of the sun covered: half as bright.
    const double noon = radians(45);
    const double share = 0.1 * natural_exposure(noon, 0.1) / natural_exposure(noon);
    EXPECT_GT(share, 0.4);
    EXPECT_LT(share, 0.7);
}

}  // namespace
}  // namespace relevo::sun::test_moonlight
