#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "base/units.h"
#include "sun/earth_rotation.h"
#include "sun/tables.h"

namespace relevo::sun {
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

TEST(EarthRotation, UncertaintyGrowsFromMeasuredToUnknown) {
    const auto uncertainty_s = [](const char* time) {
        return EarthRotation::built_in().ut1_uncertainty_s(instant_of(time));
    };
    EXPECT_EQ(uncertainty_s("1930-01-01T00:00"), 0);
    EXPECT_EQ(uncertainty_s("2000-01-01T00:00"), 0.006);
    // Bulletin A: 0.00025 s times the days to the 3/4: 0.0079 s after 100 days.
    EXPECT_NEAR(uncertainty_s("2026-11-21T00:00"), 0.006 + 0.0079, 0.0001);
    EXPECT_NEAR(uncertainty_s("2028-02-18T00:00"), 0.5, 0.05);
    EXPECT_NEAR(uncertainty_s("2034-12-31T00:00"), 0.97, 0.01);
    EXPECT_NEAR(uncertainty_s("2100-01-01T00:00"), 66, 0.1);
    double before = 0;
    for (int year = 1962; year <= 2100; ++year) {
        const double now = uncertainty_s(fmt::format("{}-07-01T00:00", year).c_str());
        EXPECT_GE(now, before) << year;
        before = now;
    }
}

// Lines of finals2000A.all, for the days around the leap second of 1 January 2017.
constexpr const char* kBulletin[] = {
    "161230 57752.00 I  0.088437 0.000050  0.259910 0.000074  I-0.4048540 0.0000080  1.3384",
    "161231 57753.00 I  0.086756 0.000050  0.259896 0.000074  I-0.4061480 0.0000080  1.2469",
    "17 1 1 57754.00 I  0.085167 0.000050  0.259982 0.000074  I 0.5926470 0.0000080  1.1650",
    "17 1 2 57755.00 I  0.083543 0.000050  0.260135 0.000074  P 0.5915020 0.0000080  1.1279",
    "17 1 3 57756.00                                                                       "};

std::filesystem::path bulletin(const std::string& name, std::size_t first, std::size_t last,
                               const std::string& extra = "") {
    const auto path = test::scratch_dir("finals_" + name) / "finals2000A.all";
    std::ofstream file(path);
    for (std::size_t i = first; i < last; ++i)
        file << kBulletin[i] << "\n";
    file << extra;
    return path;
}

TEST(EarthRotation, LoadsTheUsersBulletinA) {
    const EarthRotation loaded = EarthRotation::load_finals2000a(bulletin("good", 0, 5));
    const EarthOrientation e = loaded.at(instant_of("2016-12-31T00:00"));
    EXPECT_NEAR(e.ut1_minus_utc_s, -0.4061480, 1e-9);
    EXPECT_NEAR(e.pole_x_rad, 0.086756 * kArcsecond_rad, 1e-15);
    EXPECT_NEAR(e.pole_y_rad, 0.259896 * kArcsecond_rad, 1e-15);
    EXPECT_NEAR(loaded.at(instant_of("2017-01-01T00:00")).ut1_minus_utc_s, 0.5926470, 1e-9);
    // Half way, over the leap second: the mean of -0.4061480 and 0.5926470 - 1.
    EXPECT_NEAR(loaded.at(instant_of("2016-12-31T12:00")).ut1_minus_utc_s, -0.4067505, 3e-5);
    // Held after its days, the built-in table before them.
    EXPECT_NEAR(loaded.at(instant_of("2017-06-01T00:00")).ut1_minus_utc_s, 0.5915020, 1e-9);
    EXPECT_EQ(loaded.at(instant_of("2010-06-01T00:00")).ut1_minus_utc_s,
              EarthRotation::built_in().at(instant_of("2010-06-01T00:00")).ut1_minus_utc_s);
    // It agrees with the table that is built in.
    EXPECT_NEAR(e.ut1_minus_utc_s,
                EarthRotation::built_in().at(instant_of("2016-12-31T00:00")).ut1_minus_utc_s,
                0.006);
}

TEST(EarthRotation, WhatIsNotBulletinAIsAnError) {
    const auto error = [](const std::filesystem::path& path) {
        const std::string text = test::error_of([&] { EarthRotation::load_finals2000a(path); });
        const std::size_t at = text.find(path.string());
        return at == std::string::npos ? text : text.substr(at + path.string().size());
    };
    EXPECT_EQ(error(bulletin("short", 0, 3)), ": line 4: too short, expected four days or more");
    EXPECT_EQ(error(bulletin("other", 0, 0, "a,b\n1,2\n")),
              ": line 2: not IERS Bulletin A, expected the finals2000A format");
    EXPECT_EQ(error(bulletin("hole", 0, 2, std::string(kBulletin[3]) + "\n")),
              ": line 3: a day is missing, expected MJD 57754 but got 57755");
    std::string broken = kBulletin[2];
    broken.replace(58, 10, " 0.59x6470");
    EXPECT_EQ(error(bulletin("broken", 0, 2, broken + "\n")),
              ": line 3: no number in columns 59 to 68; expected the finals2000A format");
    EXPECT_EQ(test::error_of([] { EarthRotation::load_finals2000a("/nowhere/finals"); }),
              "exit 3: Earth rotation: /nowhere/finals: cannot be read, No such file or "
              "directory");
}

}  // namespace
}  // namespace relevo::sun
