#include "base/units.h"
#include "sun/position.h"
#include "sun/seasons.h"
#include "sun/tables.h"

namespace relevo::sun::test_seasons {
namespace {

TEST(Seasons, OfTheNavalObservatoryToTheMinute) {
    const test::Csv csv =
        test::read_csv(test::source_dir() / "tests" / "data" / "sun" / "usno_seasons.csv");
    // Half a minute of rounding, and some seconds of an older ephemeris. Later ones hang on leap
    // seconds that nobody knows, and nobody knew in 2019.
    Accuracy past("USNO equinoxes and solstices 1900-2015", "s", 36);
    Accuracy future("USNO equinoxes and solstices 2020-2100", "s", 80);
    for (const Row& row : rows_of(csv)) {
        const Instant printed = instant_of(row.text("time_ut"));
        const auto [year, month, day] = printed.utc().date;
        const Seasons found = seasons(year);
        const Instant mine = month == 3   ? found.march_equinox
                             : month == 6 ? found.june_solstice
                             : month == 9 ? found.september_equinox
                                          : found.december_solstice;
        EXPECT_EQ(row.text("event"), month % 6 == 3 ? "equinox" : "solstice");
        (year < 2018 ? past : future).add(mine - printed, row);
    }
}

TEST(Seasons, OfMeeusToTheSecond) {
    // Astronomical Algorithms, 2nd edition, table 27.E, in dynamical time.
    const Seasons found = seasons(2000);
    for (const auto& [mine, printed] : {std::pair(found.march_equinox, "2000-03-20T07:36:19"),
                                        std::pair(found.june_solstice, "2000-06-21T01:48:46"),
                                        std::pair(found.september_equinox, "2000-09-22T17:28:40"),
                                        std::pair(found.december_solstice, "2000-12-21T13:38:30")})
        EXPECT_NEAR(mine + EarthRotation::built_in().at(mine).tt_minus_utc_s - instant_of(printed),
                    0, 1)
            << printed;
}

TEST(Seasons, AreQuartersOfTheSunsLongitude) {
    const Seasons found = seasons(2026);
    double expected_deg = 0;
    for (const Instant t : {found.march_equinox, found.june_solstice, found.september_equinox,
                            found.december_solstice}) {
        const double longitude_deg = degrees(geocentric(Epoch::at(t)).longitude_rad);
        EXPECT_NEAR(angle_between_deg(longitude_deg, expected_deg) * 3600, 0, 1e-4);
        expected_deg += 90;
    }
}

TEST(Seasons, OfOtherYearsAreAnError) {
    EXPECT_EQ(test::error_of([] { seasons(1899); }),
              "exit 3: seasons: 1899: the sun is computed for the years 1900 to 2100");
}

}  // namespace
}  // namespace relevo::sun::test_seasons
