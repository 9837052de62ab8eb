// Places as people write them.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/units.h"
#include "geo/format.h"

namespace relevo::geo {
namespace {

/// Metres between a text's place and latitude, longitude [deg]; infinite for no place.
double off_m(std::string_view text, double lat_deg, double lon_deg) {
    const std::optional<Geodetic> place = find_coordinates(text);
    return place ? geodesic(*place, geodetic_deg(lat_deg, lon_deg)).distance_m : INFINITY;
}

TEST(FindCoordinates, Degrees) {
    EXPECT_LT(off_m("47.4395, 11.8935", 47.4395, 11.8935), 1e-3);
    EXPECT_LT(off_m(" 47.4395 11.8935 ", 47.4395, 11.8935), 1e-3);
    EXPECT_LT(off_m("-33.9,18.4", -33.9, 18.4), 1e-3);
    EXPECT_LT(off_m("47.41700 N 11.43708 E", 47.417, 11.43708), 1e-3);
    EXPECT_LT(off_m("11.43708 E, 47.41700 N", 47.417, 11.43708), 1e-3);
    EXPECT_LT(
        off_m("47 26 22 N 11 53 37 E", 47 + 26 / 60.0 + 22 / 3600.0, 11 + 53 / 60.0 + 37 / 3600.0),
        1e-3);
    EXPECT_LT(off_m("47°26'22\"N 11°53'37\"E", 47 + 26 / 60.0 + 22 / 3600.0,
                    11 + 53 / 60.0 + 37 / 3600.0),
              1e-3);
}

TEST(FindCoordinates, UtmAndMgrs) {
    // GeoConvert(1), EXAMPLES.
    const double lat = 33 + 20 / 60.0 + 3.25 / 3600, lon = 44 + 24 / 60.0 + 13.06 / 3600;
    EXPECT_LT(off_m("38N 444500 E 3688500 N", lat, lon), 1);
    EXPECT_LT(off_m("31S 500000 9889470", -1, 3), 1);  // the hemisphere
    EXPECT_LT(off_m("38R 444500 3688500", lat, lon), 1);
    EXPECT_LT(off_m("38SMB4448788487", lat, lon), 30);
    EXPECT_LT(off_m("38S MB 44487 88487", lat, lon), 30);
}

TEST(FindCoordinates, ReadsWhatTheProgramWrites) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> lat(-85, 85), lon(-180, 180);
    for (int i = 0; i < 500; ++i) {
        const Geodetic place = geodetic_deg(lat(random), lon(random));
        for (const std::string& text : {utm_text(place), mgrs_text(place), degrees_text(place)}) {
            const std::optional<Geodetic> found = find_coordinates(text);
            ASSERT_TRUE(found) << text;
            EXPECT_LT(geodesic(*found, place).distance_m, 2) << text;
        }
    }
}

TEST(FindCoordinates, OtherTextsAreNone) {
    for (const char* text : {"", "  ", "Hochfeln", "47.4", "95, 11", "32N 1", "99N 500000 5000000",
                             "1 2 3 4 5 6 7", "32N a b", "nan, nan"})
        EXPECT_FALSE(find_coordinates(text)) << text;
}

}  // namespace
}  // namespace relevo::geo
