#include <cmath>
#include <random>
#include <vector>

#include "base/units.h"
#include "geo/geodetic.h"
#include "support/support.h"

namespace relevo::geo::test_geodetic {
namespace {

constexpr double kEquatorialRadius_m = 6378137;     // WGS 84, NIMA TR8350.2, table 3.1
constexpr double kQuarterMeridian_m = 10001965.73;  // equator to pole, same report, table 3.3

double dms(double degrees, double minutes, double seconds) {
    return degrees + minutes / 60 + seconds / 3600;
}

TEST(Geodetic, LongitudesComeIntoHalfATurn) {
    EXPECT_EQ(normalized_lon_deg(180), -180);
    EXPECT_EQ(normalized_lon_deg(-180), -180);
    EXPECT_EQ(normalized_lon_deg(202.5), -157.5);
    EXPECT_EQ(normalized_lon_deg(-540), -180);
    EXPECT_EQ(normalized_lon_deg(11.4041), 11.4041);
    EXPECT_EQ(geodetic_deg(10, 359).lon_rad, radians(-1));
}

TEST(Geodesic, FromNewYorkToSingaporeIsAsPublished) {
    // GeographicLib, GeodSolve(1), EXAMPLES: JFK airport to Singapore Changi; printed to 0.1" and
    // 1 m.
    const Geodetic jfk = geodetic_deg(dms(40, 38, 23), -dms(73, 46, 44));
    const Geodetic changi = geodetic_deg(dms(1, 21, 33), dms(103, 59, 22));
    const Geodesic way = geodesic(jfk, changi);
    EXPECT_NEAR(way.distance_m, 15347628, 0.5);
    EXPECT_NEAR(degrees(way.azimuth_rad), dms(3, 18, 29.9), 0.05 / 3600);
    EXPECT_NEAR(degrees(way.end_azimuth_rad), dms(177, 29, 9.2), 0.05 / 3600);
}

TEST(PolygonArea, OfAnOctantIsAnEighthOfTheEllipsoid) {
    // Surface of WGS 84: 510 065 621.724 km^2 (Moritz, Geodetic Reference System 1980, for the
    // nearly equal GRS 80: 510 065 622 km^2).
    const std::vector<Geodetic> octant{geodetic_deg(0, 0), geodetic_deg(0, 90),
                                       geodetic_deg(90, 0)};
    EXPECT_NEAR(polygon_area_m2(octant), 510065621.724e6 / 8, 1e3);
    const std::vector<Geodetic> back(octant.rbegin(), octant.rend());
    EXPECT_NEAR(polygon_area_m2(back), 510065621.724e6 / 8, 1e3);
    EXPECT_EQ(polygon_area_m2(std::vector{octant[0], octant[1]}), 0);
}

TEST(Geodesic, AlongTheEquatorIsAnArcOfACircle) {
    const Geodesic way = geodesic(geodetic_deg(0, 10), geodetic_deg(0, 11));
    EXPECT_NEAR(way.distance_m, kEquatorialRadius_m * kPi / 180, 1e-6);
    EXPECT_NEAR(degrees(way.azimuth_rad), 90, 1e-12);
}

TEST(Geodesic, FromTheEquatorToThePoleIsTheQuarterMeridian) {
    EXPECT_NEAR(geodesic(geodetic_deg(0, 0), geodetic_deg(90, 0)).distance_m, kQuarterMeridian_m,
                0.01);
}

TEST(Geodesic, WestwardAzimuthIsBetweenHalfAndWholeTurn) {
    EXPECT_NEAR(degrees(geodesic(geodetic_deg(0, 0), geodetic_deg(0, -1)).azimuth_rad), 270, 1e-12);
}

TEST(Geodesic, DestinationUndoesTheInverseProblem) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> lat(-89.9, 89.9);
    std::uniform_real_distribution<double> lon(-180, 180);
    std::vector<double> errors_mm;
    for (int i = 0; i < 1000; ++i) {
        const Geodetic from = geodetic_deg(lat(random), lon(random), 100);
        const Geodetic to = geodetic_deg(lat(random), lon(random));
        const Geodesic way = geodesic(from, to);
        const Geodetic found = destination(from, way.azimuth_rad, way.distance_m);
        EXPECT_EQ(found.height_m, 100);
        errors_mm.push_back(geodesic(found, to).distance_m * 1000);
    }
    EXPECT_LT(*std::max_element(errors_mm.begin(), errors_mm.end()), 1e-3);
    test::print_accuracy("geodesic direct after inverse", errors_mm, "mm", 1e-3);
}

TEST(ParsePlace, LatitudeComesFirst) {
    const PlaceText text = parse_place("47.2692,11.4041", "--at");
    EXPECT_EQ(text.place, geodetic_deg(47.2692, 11.4041, 0));
    EXPECT_FALSE(text.has_height);
    EXPECT_FALSE(text.above_ground);
}

TEST(ParsePlace, HeightMayBeAboveGround) {
    const PlaceText ground = parse_place("-34.01, 20.45, 1.8agl", "--eye");
    EXPECT_EQ(ground.place, geodetic_deg(-34.01, 20.45, 1.8));
    EXPECT_TRUE(ground.has_height);
    EXPECT_TRUE(ground.above_ground);
    const PlaceText zero = parse_place("-34.01,20.45,-12", "--eye");
    EXPECT_EQ(zero.place.height_m, -12);
    EXPECT_TRUE(zero.has_height);
    EXPECT_FALSE(zero.above_ground);
}

TEST(ParsePlace, LongitudesFromZeroTo360AreTaken) {
    EXPECT_EQ(parse_place("21.5,202.5", "--at").place, geodetic_deg(21.5, -157.5));
    EXPECT_EQ(parse_place("-90,360", "--at").place, geodetic_deg(-90, 0));
}

TEST(ParsePlace, ErrorsSayWhatIsWrong) {
    const struct {
        const char* text;
        const char* message;
    } cases[] = {
        {"91,11",
         "exit 2: --at: 91,11: latitude, expected -90 to 90 degrees but got 91; latitude comes "
         "first, perhaps 11,91"},
        {"-122.19,46.19",
         "exit 2: --at: -122.19,46.19: latitude, expected -90 to 90 degrees but got -122.19; "
         "latitude comes first, perhaps 46.19,-122.19"},
        {"4000000,500000",
         "exit 2: --at: 4000000,500000: latitude, expected -90 to 90 degrees but got 4000000"},
        {"10,361", "exit 2: --at: 10,361: longitude, expected -180 to 360 degrees but got 361"},
        {"47.3",
         "exit 2: --at: 47.3: a place, expected LAT,LON or LAT,LON,H but got 1 part; write decimal "
         "degrees, latitude first, as in 46.55,8.56"},
        {"1,2,3,4",
         "exit 2: --at: 1,2,3,4: a place, expected LAT,LON or LAT,LON,H but got 4 parts; write "
         "decimal degrees, latitude first, as in 46.55,8.56"},
        {"",
         "exit 2: --at: : a place, expected LAT,LON or LAT,LON,H but got 0 parts; write decimal "
         "degrees, latitude first, as in 46.55,8.56"},
        {"47N,11E",
         "exit 2: --at: 47N,11E: latitude, expected a number of degrees but got \"47N\""},
        {"47,", "exit 2: --at: 47,: longitude, expected a number of degrees but got \"\""},
        {"nan,0", "exit 2: --at: nan,0: latitude, expected a number of degrees but got \"nan\""},
        {"47,11,2km",
         "exit 2: --at: 47,11,2km: height, expected a number of metres (suffix agl: above ground) "
         "but got \"2km\""},
    };
    for (const auto& c : cases)
        EXPECT_EQ(test::error_of([&] { parse_place(c.text, "--at"); }), c.message);
}

}  // namespace
}  // namespace relevo::geo::test_geodetic
