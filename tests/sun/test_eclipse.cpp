#include <cmath>
#include <numeric>

#include "base/units.h"
#include "sun/eclipse.h"
#include "sun/position.h"
#include "sun/tables.h"

namespace relevo::sun::test_eclipse {
namespace {

/// The eclipse at a place on the day of a time.
std::optional<SolarEclipse> eclipse_on(Instant time, const geo::Geodetic& place,
                                       const EarthRotation& rotation = EarthRotation::built_in()) {
    const auto found = solar_eclipses(time - kDay_s, time + kDay_s, place, rotation);
    EXPECT_LE(found.size(), 1U);
    return found.empty() ? std::nullopt : std::optional(found.front());
}

geo::Geodetic place_of(double lat_deg, double lon_deg) {
    return {radians(lat_deg), radians(lon_deg), 0};
}

TEST(Eclipse, HasTheContactsOfEclipseWise) {
    SKIP_WITHOUT_TEST_DATA(data);
    const test::Csv csv = test::read_csv(data / "sky" / "solar_eclipses_local.csv");
    // Its TT-UT1 was predicted; all times of an eclipse are late or early with it.
    Accuracy contacts("EclipseWise, contacts and greatest eclipse", "s", 5);
    Accuracy spread("EclipseWise, the same without what all of an eclipse share", "s", 1);
    Accuracy elevations("EclipseWise, the sun's elevation then", "deg", 0.6);
    std::size_t count = 0;
    for (const Row& row : rows_of(csv)) {
        const auto eclipse =
            eclipse_on(instant_of(row.text("greatest_utc").substr(0, 19)), row.place());
        ASSERT_TRUE(eclipse) << row.whole();
        EXPECT_EQ(std::toupper(name_of(eclipse->kind)[0]), row.text("kind")[0]);
        std::vector<double> of_eclipse_s;
        const auto compare = [&](const char* contact, const std::optional<EclipseMoment>& moment) {
            const std::string column = std::string(contact) + "_utc";
            ASSERT_EQ(row.has(column), moment.has_value()) << row.whole();
            if (!moment) return;
            const std::string text = row.text(column);
            const double late_s = moment->utc - instant_of(text.substr(0, text.size() - 1));
            std::printf("[ accuracy ] %s %s: %+.1f s\n", contact, text.c_str(), late_s);
            of_eclipse_s.push_back(late_s);
            contacts.add(late_s, row);
            // Without refraction, printed to a degree or a tenth.
            elevations.add(degrees(moment->elevation_rad) -
                               row.number(std::string(contact) + "_elevation_deg"),
                           row);
        };
        compare("c1", eclipse->first);
        compare("c2", eclipse->second);
        compare("greatest", eclipse->greatest);
        compare("c3", eclipse->third);
        compare("c4", eclipse->last);
        const auto n = static_cast<double>(of_eclipse_s.size());
        const double mean_s = std::accumulate(of_eclipse_s.begin(), of_eclipse_s.end(), 0.0) / n;
        for (const double late_s : of_eclipse_s)
            spread.add(late_s - mean_s, row);
        count += of_eclipse_s.size();
    }
    EXPECT_EQ(count, 13U);
}

TEST(Eclipse, HasThoseOfNasasCatalogue) {
    // Every third of two centuries, at its place of greatest eclipse, which is given to 0.1
    // degrees: up to 8 km, by which the central phase gets shorter; those of a few seconds may be
    // missed. Where the shadow's axis misses the Earth, the place sees its own greatest eclipse up
    // to half a minute from the world's.
    const test::Csv csv =
        test::read_csv(test::source_dir() / "tests" / "data" / "moon" / "nasa_eclipses.csv");
    Accuracy magnitudes("NASA's catalogue of eclipses, magnitude", "", 0.006);
    Accuracy times("NASA's catalogue of eclipses, time of greatest eclipse", "s", 30);
    Accuracy durations("NASA's catalogue of eclipses, duration of the central phase", "s", 4);
    int count = 0;
    for (const Row& row : rows_of(csv)) {
        if (count++ % 3 != 0) continue;
        const double delta_t_s = row.number("delta_t_s");
        const Instant ut1 = instant_of(row.text("time_tt")) - delta_t_s;
        const auto eclipse =
            eclipse_on(ut1, row.place(), EarthRotation::fixed({delta_t_s, 0, 0, 0}));
        ASSERT_TRUE(eclipse) << row.whole();
        times.add(eclipse->greatest.utc - ut1, row);
        const char kind = row.text("kind")[0];
        if (kind == 'P') {
            EXPECT_EQ(eclipse->kind, EclipseKind::Partial) << row.whole();
            magnitudes.add(eclipse->greatest.magnitude - row.number("magnitude"), row);
        } else if (row.has("duration_s") && row.number("duration_s") > 20) {
            EXPECT_EQ(eclipse->kind, kind == 'A' ? EclipseKind::Annular : EclipseKind::Total)
                << row.whole();
            ASSERT_TRUE(eclipse->second && eclipse->third) << row.whole();
            durations.add((eclipse->third->utc - eclipse->second->utc) - row.number("duration_s"),
                          row);
        }
    }
}

TEST(Eclipse, HasAMagnitudeToTheMoonsFarLimb) {
    // Annular on 2023-10-14 near its place of greatest eclipse: the moon's diameter is 0.952 of the
    // sun's (NASA), and the discs are concentric but for some arc-seconds. So much is covered
    // from the near limb of the sun to the far one of the moon: (1 + 0.952) / 2.
    const auto eclipse = eclipse_on(instant_of("2023-10-14T17:59:29"), place_of(11.4, -83.1));
    ASSERT_TRUE(eclipse);
    EXPECT_EQ(eclipse->kind, EclipseKind::Annular);
    EXPECT_NEAR(eclipse->greatest.magnitude, (1 + 0.952) / 2, 0.002);
    EXPECT_NEAR(eclipse->greatest.obscuration, 0.952 * 0.952, 0.002);
}

TEST(Eclipse, AreAsManyAsAPlaceHas) {
    // Munich saw totality once in the 20th century, 1999-08-11. Those of 1990 to 2009 with the
    // sun up at the beginning or the end:
    const auto of = [](int from, int to, double lat_deg, double lon_deg) {
        return solar_eclipses(Instant::from_utc({{from, 1, 1}}), Instant::from_utc({{to, 1, 1}}),
                              place_of(lat_deg, lon_deg));
    };
    std::string seen;
    for (const SolarEclipse& eclipse : of(1990, 2010, 48.137, 11.575)) {
        if (std::max(eclipse.first.elevation_rad, eclipse.last.elevation_rad) > 0)
            seen += to_string(eclipse.greatest.utc.utc().date) + " " +
                    std::string(name_of(eclipse.kind)) + "; ";
    }
    EXPECT_EQ(seen,
              "1994-05-10 partial; 1996-10-12 partial; 1999-08-11 total; 2003-05-31 partial; "
              "2005-10-03 partial; 2006-03-29 partial; 2008-08-01 partial; ");
    // 2026-08-12 at Burgos: totality of 1 min 44 s, low in the west.
    const auto burgos = of(2026, 2027, 42.34, -3.70);
    ASSERT_EQ(burgos.size(), 1U);
    EXPECT_EQ(burgos.front().kind, EclipseKind::Total);
    EXPECT_EQ(to_string(burgos.front().greatest.utc.utc().date), "2026-08-12");
    EXPECT_NEAR(burgos.front().third->utc - burgos.front().second->utc, 104, 4);
    // A year without one.
    EXPECT_EQ(of(2004, 2005, 48.137, 11.575).size(), 0U);
    // First and last year that are computed.
    EXPECT_NO_THROW(of(1900, 1901, 48.137, 11.575));
    EXPECT_NO_THROW(of(2100, 2101, 48.137, 11.575));
}

TEST(Eclipse, LeavesOfTheDiscWhatTheMoonDoesNotCover) {
    EXPECT_EQ(visible_fraction(1, 1, 3), 1);
    EXPECT_EQ(visible_fraction(1, 1.1, 0.05), 0);
    EXPECT_DOUBLE_EQ(visible_fraction(1, 0.9, 0.05), 1 - 0.81);
    // Equal discs, each centre on the other's rim: 2/3 - sqrt(3) / (2 pi) of a disc is common.
    EXPECT_NEAR(visible_fraction(1, 1, 1), 1 - (2.0 / 3 - std::sqrt(3.0) / (2 * kPi)), 1e-12);
    // Continuous at the contacts.
    EXPECT_NEAR(visible_fraction(1, 1.05, 2.05 - 1e-9), 1, 1e-9);
    EXPECT_NEAR(visible_fraction(1, 1.05, 0.05 + 1e-9), 0, 1e-6);
    EXPECT_NEAR(visible_fraction(1, 0.95, 0.05 + 1e-9), 1 - 0.9025, 1e-6);
}

TEST(Eclipse, IsInTheLightOfAPlace) {
    const auto visible = [](const char* utc, const geo::Geodetic& place) {
        const Instant at = instant_of(utc);
        return sun_visible_fraction(position(at, place), moon_position(at, place));
    };
    const geo::Geodetic ohio = place_of(41.0341, -83.6523);
    EXPECT_EQ(visible("2024-04-08T17:50:00", ohio), 1);
    EXPECT_EQ(visible("2024-04-08T19:12:34", ohio), 0);
    const double half = visible("2024-04-08T18:34:00", ohio);
    EXPECT_GT(half, 0.4);
    EXPECT_LT(half, 0.7);
    EXPECT_EQ(visible("2024-04-20T19:12:34", ohio), 1);
    // Total there, nothing of it in Patagonia.
    EXPECT_EQ(visible("2024-04-08T19:12:34", place_of(-50, -70)), 1);
}

TEST(Eclipse, IsGreatestWhereTheSunIsUp) {
    const geo::Geodetic place = place_of(41.0341, -83.6523);
    const auto eclipse = eclipse_on(instant_of("2024-04-08T19:12:34"), place);
    ASSERT_TRUE(eclipse);
    const Instant greatest = eclipse->greatest.utc;
    const auto all = greatest_within(*eclipse, {{greatest - 6000, greatest + 6000}}, place);
    ASSERT_TRUE(all);
    EXPECT_EQ(all->utc, greatest);
    const auto late = greatest_within(*eclipse, {{greatest + 1800, greatest + 90000}}, place);
    ASSERT_TRUE(late);
    EXPECT_EQ(late->utc, greatest + 1800);
    EXPECT_LT(late->magnitude, 0.7);
    EXPECT_FALSE(greatest_within(*eclipse, {{greatest + 9000, greatest + 90000}}, place));
    // The nearer of two, by the rotation of the caller: with another the shadow comes elsewhere.
    const auto nearer = greatest_within(
        *eclipse, {{greatest - 6000, greatest - 900}, {greatest + 1800, greatest + 6000}}, place);
    ASSERT_TRUE(nearer);
    EXPECT_EQ(nearer->utc, greatest - 900);
    const auto turned = greatest_within(*eclipse, {{greatest + 1800, greatest + 90000}}, place,
                                        EarthRotation::fixed({69.2, 600, 0, 0}));
    ASSERT_TRUE(turned);
    EXPECT_GT(std::abs(turned->magnitude - late->magnitude), 0.001);
}

}  // namespace
}  // namespace relevo::sun::test_eclipse
