#include <cmath>

#include <erfa.h>
#include <erfam.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/moon.h"
#include "sun/moon_ephemeris.h"
#include "sun/position_table.h"
#include "sun/refraction.h"
#include "sun/tables.h"

namespace relevo::sun::test_moon {
namespace {

std::filesystem::path published(const char* name) {
    return test::source_dir() / "tests" / "data" / "moon" / name;
}

TEST(Moon, IsWhereHorizonsHasItWithoutAir) {
    // Printed to 0.0001 degrees in azimuth and elevation, to 0.00001 in right ascension. Before
    // 1962 azimuths differ by the pole, of which Horizons knows nothing then, and all by TT-UT1.
    const test::Csv csv = test::read_csv(published("horizons_airless.csv"));
    Accuracy sky("JPL Horizons 1900-2019, moon without air", "arcsec", 1);
    Accuracy equatorial("JPL Horizons 1900-2019, moon's topocentric RA and Dec", "arcsec", 1);
    Accuracy later("JPL Horizons 2019-2099, its prediction of UT1, moon's RA and Dec", "arcsec", 2);
    for (const Row& row : rows_of(csv)) {
        const MoonPosition moon = moon_position(Epoch::at(row.time()), row.place());
        const double arcsec =
            separation_arcsec(degrees(moon.right_ascension_rad), degrees(moon.declination_rad),
                              row.number("ra_deg"), row.number("dec_deg"));
        if (row.time() > instant_of("2019-07-01T00:00")) {
            later.add(arcsec, row);
            continue;
        }
        equatorial.add(arcsec, row);
        sky.add(separation_arcsec(degrees(moon.azimuth_rad), degrees(moon.elevation_rad),
                                  row.number("az_deg"), row.number("el_deg")),
                row);
    }
}

/// Rows of outside data whose column of time has another name.
void compare_refracted(const test::Csv& csv, const char* title) {
    Accuracy sky(title, "arcsec", 6);
    const Refraction refraction = Refraction::saemundsson();
    for (const Row& row : rows_of(csv)) {
        if (row.number("apparent_elevation_deg") < 5) continue;
        const Instant time = instant_of(row.text("time_utc"));
        const MoonPosition moon = moon_position(time, row.place());
        sky.add(separation_arcsec(degrees(moon.azimuth_rad),
                                  degrees(refraction.apparent_rad(moon.elevation_rad)),
                                  row.number("azimuth_deg"), row.number("apparent_elevation_deg")),
                row);
    }
}

TEST(Moon, IsWhereHorizonsHasItThroughAir) {
    SKIP_WITHOUT_TEST_DATA(data);
    compare_refracted(test::read_csv(data / "sky" / "moon_horizons_n29w081.csv"),
                      "JPL Horizons 2018, moon above 5 degrees, its refraction");
    compare_refracted(test::read_csv(data / "sky" / "moon_horizons_1900_2099.csv"),
                      "JPL Horizons 1900-2099, moon above 5 degrees, its refraction");
}

TEST(Moon, IsWhereAnIndependentSeriesHasIt) {
    // Meeus' abridgement of ELP 2000-82 in ERFA is good to 10".
    std::vector<double> arcsec, km;
    for (int i = 0; i < 400; ++i) {
        const double jd = ERFA_DJ00 - 36525 + i * 183.1;
        double pv[2][3];
        eraMoon98(jd, 0, pv);
        const glm::dvec3 other = glm::dvec3(pv[0][0], pv[0][1], pv[0][2]) * ERFA_DAU;
        const glm::dvec3 moon = moon_icrs_m(jd, 0);
        arcsec.push_back(glm::length(glm::normalize(moon) - glm::normalize(other)) /
                         kArcsecond_rad);
        km.push_back(std::abs(glm::length(moon) - glm::length(other)) / 1000);
        EXPECT_LE(arcsec.back(), 25) << jd;
        EXPECT_LE(km.back(), 30) << jd;
    }
    test::print_accuracy("moon against ERFA's eraMoon98", arcsec, "arcsec", 25);
    test::print_accuracy("moon against ERFA's eraMoon98, distance", km, "km", 30);
}

TEST(Moon, HasItsTables) {
    std::vector<double> arcsec;
    for (const int year : {1900, 1972, 2026, 2100}) {
        const Instant from = Instant::from_utc({{year, 3, 1}});
        const PositionTable table(from, from + 12 * kDay_s, Body::Moon);
        for (int i = 0; i <= 60; ++i) {
            const Instant t = from + i * 17280.0;
            const geo::Geodetic place{std::asin(2 * std::fmod(i * 0.41421356, 1.0) - 1),
                                      2 * kPi * std::fmod(i * 0.7320508, 1.0), (i % 9) * 1000.0};
            const glm::dvec3 v = table.vector_au(t, Observer(place));
            const MoonPosition moon = moon_position(t, place);
            arcsec.push_back(glm::length(glm::normalize(v) - moon.direction) / kArcsecond_rad);
            EXPECT_LE(arcsec.back(), 0.02) << to_iso(t);
            EXPECT_NEAR(glm::length(v), moon.distance_au, 1e-9);
        }
    }
    test::print_accuracy("moon, table against rigorous", arcsec, "arcsec", 0.02);
}

TEST(Moon, HasThePhasesOfTheNavalObservatory) {
    const test::Csv csv = test::read_csv(published("usno_phases.csv"));
    Accuracy phases("U.S. Naval Observatory, phases of the moon 1900-2019", "s", 60);
    Accuracy later("U.S. Naval Observatory, phases to 2100, TT-UT1 predicted", "s", 240);
    for (const Row& row : rows_of(csv)) {
        const Instant time = row.time();
        const auto found = moon_phases(time - kDay_s, time + kDay_s);
        ASSERT_EQ(found.size(), 1U) << row.whole();
        EXPECT_EQ(static_cast<int>(found.front().phase), row.number("phase")) << row.whole();
        (time < instant_of("2020-01-01T00:00") ? phases : later).add(found.front().utc - time, row);
    }
}

TEST(Moon, HasEveryPhaseOfAYearOnceAndInOrder) {
    const auto phases =
        moon_phases(Instant::from_utc({{2026, 1, 1}}), Instant::from_utc({{2027, 1, 1}}));
    EXPECT_EQ(phases.size(), 50U);
    for (std::size_t i = 1; i < phases.size(); ++i) {
        EXPECT_EQ((static_cast<int>(phases[i - 1].phase) + 1) % 4,
                  static_cast<int>(phases[i].phase));
        const double days = (phases[i].utc - phases[i - 1].utc) / kDay_s;
        EXPECT_GT(days, 6.4);
        EXPECT_LT(days, 8.5);
    }
}

TEST(Moon, IsLitFromTheSunsSide) {
    // Meeus, Astronomical Algorithms, example 48.a: 12 April 1992, 0 h TT, from the Earth's
    // centre: illuminated 0.6786, bright limb at 285.0 degrees. From a place it differs by less
    // than a degree.
    const MoonPosition moon =
        moon_position(Epoch::from_ut1(instant_of("1992-04-12T00:00"), 0), {0, radians(110.0), 0});
    EXPECT_NEAR(moon.illuminated_fraction, 0.6786, 0.01);
    EXPECT_NEAR(degrees(moon.bright_limb_rad), 285.0, 1.0);
    EXPECT_EQ(phase_name(moon.phase_longitude_rad), "waxing gibbous");
    // A first quarter in the evening is lit on the right in the north, on the left in the south.
    const Instant quarter = instant_of("2026-03-25T19:18");
    const auto limb_deg = [&](double lat_deg) {
        return degrees(
            moon_position(quarter, {radians(lat_deg), 0, 0}).bright_limb_from_zenith_rad);
    };
    EXPECT_GT(limb_deg(50), 180);
    EXPECT_LT(limb_deg(-50), 180);
}

TEST(Moon, HasAnAgeAndAName) {
    EXPECT_NEAR(moon_age_d(instant_of("2026-03-19T01:24")), 0, 0.01);
    EXPECT_NEAR(moon_age_d(instant_of("2026-03-25T19:18")), 6.745, 0.01);
    // At both ends; the new moon before 1900 was on 3 December 1899, 0:48 UT.
    EXPECT_NEAR(moon_age_d(instant_of("1900-01-01T00:00")), 28.967, 0.01);
    EXPECT_NEAR(moon_age_d(instant_of("2100-12-31T23:59")), 1.0, 0.01);
    EXPECT_EQ(phase_name(0), "new moon");
    EXPECT_EQ(phase_name(radians(359)), "new moon");
    EXPECT_EQ(phase_name(radians(40)), "waxing crescent");
    EXPECT_EQ(phase_name(radians(93)), "first quarter");
    EXPECT_EQ(phase_name(radians(180)), "full moon");
    EXPECT_EQ(phase_name(radians(200)), "waning gibbous");
    EXPECT_EQ(phase_name(radians(275)), "last quarter");
    EXPECT_EQ(phase_name(radians(300)), "waning crescent");
}

TEST(Moon, OutsideTheYearsIsAnError) {
    EXPECT_EQ(
        test::error_of([] {
            moon_position(instant_of("1850-01-01T00:00"), {0, 0, 0});
        }),
        "exit 3: time: 1850-01-01T00:00:00Z: sun and moon are computed for the years 1900 to 2100");
}

}  // namespace
}  // namespace relevo::sun::test_moon
