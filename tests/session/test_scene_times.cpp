// Which DEM a picture of a job is of.
#include <cmath>

#include <gtest/gtest.h>

#include "base/units.h"
#include "dem/fixture.h"
#include "session/climate_words.h"
#include "session/scene_times.h"
#include "support/support.h"

namespace relevo::session::test_scene_times {
namespace {

TEST(SceneTimes, ADemThatIsReadOtherwiseIsAnotherDem) {
    test::Raster raster;
    raster.columns = raster.rows = 20;
    raster.value = [](int column, int row, int) {
        return column == 5 && row == 5 ? 7.0 : 100.0 + column;
    };
    scene::Scene plain;
    plain.dems = {test::write_raster(test::scratch_dir() / "plain.tif", raster)};
    scene::Scene feet = plain, holed = plain, elsewhere = plain;
    feet.dem.unit = "feet";
    holed.dem.nodata = 7;
    elsewhere.dem.crs = "EPSG:32633";
    SceneTimes times;
    const auto height_m = [&](const scene::Scene& scene, int column, int row) {
        return double{times.loaded(scene)->field.height_m.at(column, row)};
    };
    EXPECT_EQ(height_m(plain, 10, 3), 110);
    EXPECT_NEAR(height_m(feet, 10, 3), 110 * 0.3048, 1e-4);
    EXPECT_EQ(height_m(plain, 5, 5), 7);
    EXPECT_TRUE(std::isnan(height_m(holed, 5, 5)));
    EXPECT_NEAR(degrees(times.loaded(elsewhere)->field.grid.center().lon_rad -
                        times.loaded(plain)->field.grid.center().lon_rad),
                6, 0.01);
    // And the same one is read once.
    scene::Scene later = feet;
    later.time.at = "2026-06-21T12:00Z";
    EXPECT_EQ(times.loaded(later), times.loaded(feet));
}

TEST(ClimateWords, AreOfTheHeightAndTheMonthsThatTheyName) {
    const climate::ClimateMap map = climate::ClimateMap::shipped();
    for (const geo::Geodetic place :
         {geo::geodetic_deg(46.5, 8, 1960), geo::geodetic_deg(-33, -70, 300)}) {
        const ClimateReport report =
            climate_report(map, place, sun::parse_time("2026-01-20T12:00Z").utc);
        const climate::Months months =
            climate::CoverColumn(map.at(place)).temperature_c(place.height_m);
        EXPECT_EQ(report.january_c, months[0]);
        EXPECT_EQ(report.july_c, months[6]);
        EXPECT_EQ(report.height_m, place.height_m);
        EXPECT_EQ(report.july_c > report.january_c + 8, place.lat_rad > 0);
        // Higher it is colder, by some 6.5 degrees a kilometre (ICAO's standard atmosphere).
        geo::Geodetic higher = place;
        higher.height_m += 1000;
        const ClimateReport above =
            climate_report(map, higher, sun::parse_time("2026-01-20T12:00Z").utc);
        EXPECT_NEAR(report.july_c - above.july_c, 6.5, 2.5);
    }
}

}  // namespace
}  // namespace relevo::session::test_scene_times
