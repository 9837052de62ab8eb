#include <array>
#include <cmath>

#include "base/units.h"
#include "light/plane/transposition.h"
#include "support/support.h"

namespace relevo::light::test_transposition {
namespace {

Plane plane_deg(double tilt_deg, double azimuth_deg) {
    return {radians(tilt_deg), radians(azimuth_deg)};
}

/// Cosine between the plane's normal and a direction.
double cosine_of(const Plane& plane, double azimuth_rad, double elevation_rad) {
    const glm::dvec3 n = plane.normal();
    const double level = std::cos(elevation_rad);
    return n.x * level * std::sin(azimuth_rad) + n.y * level * std::cos(azimuth_rad) +
           n.z * std::sin(elevation_rad);
}

TEST(Transposition, PlanesFaceTheirAzimuth) {
    const glm::dvec3 east = plane_deg(90, 90).normal(), south = plane_deg(90, 180).normal();
    EXPECT_NEAR(east.x, 1, 1e-15);
    EXPECT_NEAR(south.y, -1, 1e-15);
    EXPECT_NEAR(plane_deg(0, 77).normal().z, 1, 1e-15);
    EXPECT_NEAR(plane_deg(30, 90).normal().z, std::cos(radians(30)), 1e-15);
}

/// Computed by pvlib 0.16.1, irradiance.haydavies and irradiance.perez, with 1400 W/m2 above the
/// air: a clear day, low suns, a sun behind the plane, a level plane under a low sun.
struct Example {
    double tilt_deg, azimuth_deg, dhi, dni, zenith_deg, sun_azimuth_deg, hay_davies, perez;
};
constexpr std::array<Example, 6> kExamples{{
    {90, 180, 100, 700, 60, 170, 110.286853195, 136.162883998},
    {30, 90, 200, 50, 75, 120, 197.667098276, 278.798468864},
    {90, 0, 120, 800, 30, 180, 25.714285714, 47.260975410},
    {45, 270, 80, 20, 88, 290, 89.862882509, 377.497833494},
    {60, 200, 60, 900, 50, 190, 74.561495283, 79.868283617},
    {0, 0, 50, 300, 87, 100, 50.000000000, 47.777559138},
}};

TEST(Transposition, ModelsOfTheSkyAreThoseOfPvlib) {
    std::vector<double> off;
    for (const Example& e : kExamples) {
        const Plane plane = plane_deg(e.tilt_deg, e.azimuth_deg);
        const SkySun sun{radians(e.zenith_deg), std::cos(radians(e.zenith_deg)),
                         cosine_of(plane, radians(e.sun_azimuth_deg), radians(90 - e.zenith_deg)),
                         1400};
        const auto diffuse = [&](SkyModel model) {
            const SkyFactors f = sky_factors(model, plane, sun, e.dni, e.dhi);
            return e.dhi * (f.isotropic + f.circumsolar + f.band);
        };
        off.push_back(std::abs(diffuse(SkyModel::HayDavies) - e.hay_davies));
        off.push_back(std::abs(diffuse(SkyModel::Perez) - e.perez));
        EXPECT_NEAR(diffuse(SkyModel::Isotropic), e.dhi * (1 + std::cos(plane.tilt_rad)) / 2,
                    1e-12);
    }
    test::print_accuracy("sky models against pvlib", off, "W/m2", 0.001);
    for (const double error : off)
        EXPECT_LE(error, 1e-6);
    EXPECT_EQ(sky_factors(SkyModel::Perez, {}, {0, 1, 1, 1400}, 100, 0).isotropic, 0);
}

TEST(Transposition, IrradianceAboveTheAirFollowsTheYear) {
    EXPECT_NEAR(irradiance_above_air(1), 1413.98180, 1e-5);  // pvlib 0.16.1
    EXPECT_NEAR(irradiance_above_air(27), 1409.84798, 1e-5);
}

TEST(Transposition, TheSkyOverAHorizonIsThatOfTheFormulas) {
    const Plane level, wall = plane_deg(90, 222);
    EXPECT_EQ(open_sky(level), 1);
    EXPECT_NEAR(open_sky(wall), 0.5, 1e-15);
    for (const double h_deg : {0.0, 3.0, 10.0, 60.0}) {
        const Skyline ring({radians(h_deg)});
        const double h = radians(h_deg);
        EXPECT_NEAR(open_sky(level, ring), std::cos(h) * std::cos(h), 1e-7);
        EXPECT_NEAR(open_sky(wall, ring), 0.5 - h / kPi - std::sin(2 * h) / (2 * kPi), 1e-7);
    }
    EXPECT_NEAR(open_sky(plane_deg(30, 20), Skyline({0.0})), (1 + std::cos(radians(30))) / 2, 1e-7);
    // Ground below the level gives nothing.
    EXPECT_NEAR(open_sky(wall, Skyline({radians(-5)})), 0.5, 1e-7);
}

TEST(Transposition, TheSkyOverRidgesIsThatOfManyDirections) {
    std::vector<double> ridges;
    for (int k = 0; k < 360; ++k)
        ridges.push_back(radians(k < 120 ? 25 : 5 + 5 * std::sin(k)));
    const Skyline horizon(ridges);
    for (const Plane& plane : {plane_deg(0, 0), plane_deg(35, 60), plane_deg(90, 90)}) {
        double sum = 0;
        constexpr double kStep = radians(0.2);
        for (double azimuth = kStep / 2; azimuth < 2 * kPi; azimuth += kStep)
            for (double up = kStep / 2; up < kPi / 2; up += kStep)
                if (up > horizon.elevation_rad(azimuth))
                    sum += std::max(0.0, cosine_of(plane, azimuth, up)) * std::cos(up);
        EXPECT_NEAR(open_sky(plane, horizon), sum * kStep * kStep / kPi, 2e-4);
    }
}

}  // namespace
}  // namespace relevo::light::test_transposition
