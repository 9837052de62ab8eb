#include <cmath>

#include "base/units.h"
#include "sun/earth_rotation.h"
#include "sun/tables.h"

namespace relevo::sun::test_earth_rotation {
namespace {

class EarthRotationTables : public SunTables {};

TEST_P(EarthRotationTables, DeltaTAsPublished) {
    Accuracy measured("TT-UT1 1973-2022, IERS, " + GetParam(), "s", 0.006);
    Accuracy historic("TT-UT1 1900-1970, USNO, " + GetParam(), "s", 0.02);
    Accuracy dut1("UT1-UTC 1973-2022, IERS, " + GetParam(), "s", 0.006);
    for (const Row& row : rows("delta_t.csv")) {
        const int year = static_cast<int>(row.number("year"));
        if (year < kFirstYear) continue;
        const Instant t = Instant::from_utc({{year, static_cast<int>(row.number("month")), 1}});
        const EarthOrientation earth = EarthRotation::built_in().at(t);
        const double error_s =
            earth.tt_minus_utc_s - earth.ut1_minus_utc_s - row.number("delta_t_s");
        (year >= 1973 ? measured : historic).add(error_s, row);
        if (row.has("dut1_s")) dut1.add(earth.ut1_minus_utc_s - row.number("dut1_s"), row);
    }
}

INSTANTIATE_TEST_SUITE_P(Sun, EarthRotationTables, testing::Values("published", "outside"),
                         [](const auto& set) { return set.param; });

TEST(EarthRotation, LeapSecondsAsAnnounced) {
    // IERS Bulletin C; USNO tai-utc.dat before 1972.
    EXPECT_EQ(tai_minus_utc_s(instant_of("1972-01-01T00:00")), 10);
    EXPECT_EQ(tai_minus_utc_s(instant_of("2016-12-31T23:59:59.9")), 36);
    EXPECT_EQ(tai_minus_utc_s(instant_of("2017-01-01T00:00")), 37);
    EXPECT_EQ(tai_minus_utc_s(instant_of("2100-12-31T00:00")), 37);
    EXPECT_NEAR(tai_minus_utc_s(instant_of("1962-01-01T00:00")), 1.845858, 1e-9);
    EXPECT_NEAR(tai_minus_utc_s(instant_of("1968-02-01T12:00")), 6.185682 + 0.002592 * 0.5, 1e-9);
}

TEST(EarthRotation, Ut1IsSmoothOverLeapSecondsAndOverTheEndsOfItsTables) {
    // UT1 itself does not jump: what changes by a second is UTC. From 1962 an Instant is UTC, which
    // was then 0.03 s off UT1.
    const auto ut1_from_tt_s = [](const char* time) {
        const EarthOrientation e = EarthRotation::built_in().at(instant_of(time));
        return e.ut1_minus_utc_s - e.tt_minus_utc_s;
    };
    EXPECT_NEAR(ut1_from_tt_s("2016-12-31T23:59:59.999"), ut1_from_tt_s("2017-01-01T00:00:00"),
                1e-6);
    EXPECT_NEAR(ut1_from_tt_s("1972-06-30T23:59:59.999"), ut1_from_tt_s("1972-07-01T00:00:00"),
                1e-6);
    EXPECT_NEAR(ut1_from_tt_s("1961-12-31T23:59:59"), ut1_from_tt_s("1962-01-01T00:00:01"), 0.02);
    EXPECT_NEAR(ut1_from_tt_s("2027-08-17T23:59:59"), ut1_from_tt_s("2027-08-18T00:00:01"), 1e-4);
}

TEST(EarthRotation, TheLastValueIsHeld) {
    const EarthRotation& table = EarthRotation::built_in();
    const double last_s = table.at(instant_of("2027-08-18T00:00")).ut1_minus_utc_s;
    EXPECT_EQ(table.at(instant_of("2060-01-01T00:00")).ut1_minus_utc_s, last_s);
    EXPECT_LT(std::abs(last_s), 0.9);
    // The pole goes to its mean place, which is all that is known of it.
    const EarthOrientation later = table.at(instant_of("2030-01-01T00:00"));
    EXPECT_NEAR(later.pole_x_rad / kArcsecond_rad, 0.0550 + 0.001677 * 30, 0.0001);
    EXPECT_NEAR(later.pole_y_rad / kArcsecond_rad, 0.3205 + 0.003460 * 30, 0.0001);
}

}  // namespace
}  // namespace relevo::sun::test_earth_rotation
