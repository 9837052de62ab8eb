#include <cmath>

#include "base/units.h"
#include "sun/daylight.h"
#include "support/support.h"

namespace relevo::sun::test_daylight {
namespace {

TEST(AirMass, FollowsTheTableOfKastenAndYoung) {
    // Kasten and Young 1989, table 2: relative optical air mass of the ISO standard atmosphere.
    struct Row {
        double elevation_deg, mass;
    };
    for (const Row& row :
         {Row{90, 1.0000}, Row{60, 1.1539}, Row{45, 1.4128}, Row{30, 1.9943}, Row{20, 2.9016},
          Row{10, 5.5841}, Row{5, 10.3164}, Row{1, 26.2595}, Row{0, 38.0868}})
        EXPECT_NEAR(air_mass(radians(row.elevation_deg)), row.mass, 0.005 * row.mass)
            << row.elevation_deg;
}

TEST(Daylight, TakesMoreBlueThanRedAndMoreTheLowerTheSun) {
    double above = 2;
    for (double h_deg = 90; h_deg >= 1; h_deg -= 1) {
        const glm::dvec3 light = direct_transmittance(radians(h_deg), 0);
        EXPECT_GT(light.r, light.b) << h_deg;
        EXPECT_LT(light.g, above) << h_deg;
        above = light.g;
    }
    // A clear day at sea level: four fifths of the zenith sun's visible light arrive (IESNA's
    // extinction of 0.21 for clear sky: exp(-0.21) = 0.81).
    EXPECT_NEAR(direct_transmittance(radians(90), 0).g, std::exp(-0.21), 0.02);
    EXPECT_GT(direct_transmittance(radians(20), 4000).b, direct_transmittance(radians(20), 0).b);
}

TEST(Daylight, EndsWhenTheWholeDiscHasSet) {
    EXPECT_EQ(direct_transmittance(radians(-0.27), 0), glm::dvec3(0));
    EXPECT_GT(direct_transmittance(radians(-0.26), 0).r, 0);
}

TEST(Twilight, IsAsBrightAsTheAlmanacSays) {
    // Explanatory Supplement (1992), p. 491: 3.4 lux at the end of civil twilight, 0.0083 at the
    // end of nautical twilight; the day's formula is 5 % higher where the two meet.
    EXPECT_NEAR(sky_illuminance_lux(radians(-6)), 3.4 * 1.054, 0.1);
    EXPECT_NEAR(sky_illuminance_lux(radians(-12)), 0.0083 * 1.054, 0.0005);
    EXPECT_EQ(sky_illuminance_lux(radians(-30)), 0.002);
    EXPECT_NEAR(sky_illuminance_lux(radians(1e-9)), sky_illuminance_lux(radians(-1e-9)), 1);
    EXPECT_NEAR(sky_illuminance_lux(radians(90)), 16300, 1);  // IESNA RP-21: 0.8 + 15.5 klx
}

TEST(Twilight, IsBluerThanTheDay) {
    const auto blue = [](double h_deg) {
        const glm::dvec3 light = sky_irradiance(radians(h_deg));
        return light.b / light.r;
    };
    EXPECT_NEAR(blue(40), blue(1e-9), 1e-9);
    EXPECT_NEAR(blue(-3), (1.72 + 2.42) / (0.79 + 0.62), 1e-9);  // half way
    EXPECT_NEAR(blue(-6), 2.42 / 0.62, 1e-9);
    EXPECT_NEAR(blue(-15), blue(-6), 1e-9);
}

TEST(Exposure, GrowsAsLightFadesButNotToDay) {
    double before = 0;
    double level_before = 1e9;
    for (double h_deg = 60; h_deg >= -18; h_deg -= 1) {
        const double exposure = natural_exposure(radians(h_deg));
        EXPECT_GE(exposure, before) << h_deg;
        before = exposure;
        // Exposed sky light falls all the same once the sun is down.
        if (h_deg < 0) {
            const double level = exposure * sky_illuminance_lux(radians(h_deg));
            EXPECT_LE(level, level_before * 1.0001) << h_deg;
            level_before = level;
        }
    }
}

TEST(Exposure, IsThatOfALightMeter) {
    // Level white ground under a high sun and its sky: the rule of sunny 16 is EV 15.
    EXPECT_NEAR(ev100_of_exposure(natural_exposure(radians(60.0))), 14.8, 0.3);
    // ISO 2720: 0.125 cd/m2 is middle grey at EV 0, 4096 cd/m2 at EV 15.
    EXPECT_NEAR(exposure_of_ev100(15) * 4096 / kUnitLuminance_cd_m2, 0.18, 1e-9);
    EXPECT_NEAR(ev100_of_exposure(exposure_of_ev100(-3.7)), -3.7, 1e-12);
}

TEST(Daylight, ThinAirHasAllOfItsOzone) {
    // Of the green light's optical depth in the zenith only what Rayleigh and dust make falls with
    // the height, by e over 8430 m; ozone lies above: 0.085 / cm of 3 mm.
    const double zenith = kPi / 2, mass = air_mass(zenith);
    const double low = -std::log(direct_transmittance(zenith, 0)[1]) / mass;
    const double high = -std::log(direct_transmittance(zenith, 8430)[1]) / mass;
    const double share = std::exp(-1.0);
    EXPECT_NEAR((high - low * share) / (1 - share), 0.085 * 0.3, 1e-9);
}

}  // namespace
}  // namespace relevo::sun::test_daylight
