#include <cmath>

#include "base/units.h"
#include "dem/placement.h"
#include "support/support.h"

namespace relevo::dem::test_placement {
namespace {

TEST(Bounds, AreWestSouthEastNorth) {
    EXPECT_EQ(parse_bounds("10,46,10.1,46.1", "--bounds"), (Bounds{10, 46, 10.1, 46.1}));
    EXPECT_EQ(parse_bounds("-122.5, -33, -122, -32", "--bounds"), (Bounds{-122.5, -33, -122, -32}));
    EXPECT_EQ(parse_bounds("179,-1,-179,1", "--bounds"), (Bounds{179, -1, 181, 1}));
    EXPECT_EQ(parse_bounds("-180,-90,180,90", "--bounds"), (Bounds{-180, -90, 180, 90}));
    EXPECT_EQ(parse_bounds("195,18,210,25", "--bounds"), (Bounds{195, 18, 210, 25}));
}

TEST(Bounds, WrongOnesHaveTheirMessages) {
    const struct {
        const char* text;
        const char* message;
    } cases[] = {
        {"", "\"\": expected WEST,SOUTH,EAST,NORTH in degrees"},
        {"1,2,3", "1,2,3: expected WEST,SOUTH,EAST,NORTH in degrees"},
        {"1,2,3,x", "1,2,3,x: expected WEST,SOUTH,EAST,NORTH in degrees"},
        {"10,47,11,46",
         "10,47,11,46: latitudes, expected -90 <= south < north <= 90 but got 47 and 46; the order "
         "is WEST,SOUTH,EAST,NORTH"},
        {"10,46,11,91",
         "10,46,11,91: latitudes, expected -90 <= south < north <= 90 but got 46 and 91; the order "
         "is WEST,SOUTH,EAST,NORTH"},
        {"10,46,10,47",
         "10,46,10,47: longitudes, expected two between -180 and 360 degrees but got 10 and 10; "
         "the "
         "order is WEST,SOUTH,EAST,NORTH"},
        {"-500,46,10,47",
         "-500,46,10,47: longitudes, expected two between -180 and 360 degrees but got -500 and "
         "10; "
         "the order is WEST,SOUTH,EAST,NORTH"},
    };
    for (const auto& c : cases)
        EXPECT_EQ(test::error_of([&] { parse_bounds(c.text, "--bounds"); }),
                  std::string("exit 2: --bounds: ") + c.message);
}

TEST(Bounds, PlaceTheEdgesOfTheCells) {
    const Affine a = affine_of(Bounds{10, 46, 12, 47}, geo::Crs(), 4, 2);
    EXPECT_EQ(a(-0.5, -0.5), glm::dvec2(10, 47));
    EXPECT_EQ(a(3.5, 1.5), glm::dvec2(12, 46));
    const Affine across = affine_of(Bounds{179, -1, 181, 1}, geo::Crs(), 4, 4);
    EXPECT_EQ(across(-0.5, -0.5), glm::dvec2(179, 1));
    EXPECT_EQ(across(3.5, 3.5), glm::dvec2(181, -1));
    const Affine world = affine_of(Bounds{-180, -90, 180, 90}, geo::Crs(), 360, 180);
    EXPECT_EQ(world(-0.5, -0.5), glm::dvec2(-180, 90));
    EXPECT_EQ(world(359.5, 179.5), glm::dvec2(180, -90));
}

TEST(Bounds, AreCornersInAProjectedCrs) {
    const geo::Crs mercator = geo::Crs::parse("EPSG:3857", "test");
    const Affine a = affine_of(Bounds{0, 0, 90, 66.51326}, mercator, 2, 2);
    // EPSG:3857: x = R lon, y = R ln(tan(45 + lat / 2)), and 66.51326 N is where y is R pi / 2.
    EXPECT_NEAR(a(1.5, -0.5).x, 6378137 * kPi / 2, 1e-3);
    EXPECT_NEAR(a(1.5, -0.5).y, 6378137 * kPi / 2, 0.5);
    EXPECT_NEAR(a(-0.5, 1.5).x, 0, 1e-6);
    EXPECT_NEAR(a(-0.5, 1.5).y, 0, 1e-6);
}

TEST(WebTile, IsTheEndOfAPath) {
    EXPECT_EQ(web_tile("/maps/12/2177/1435.png"), (WebTile{12, 2177, 1435}));
    EXPECT_EQ(web_tile("/maps/12/2177/1435@2x.png"), (WebTile{12, 2177, 1435}));
    EXPECT_EQ(web_tile("/maps/0/0/0.webp"), (WebTile{0, 0, 0}));
    for (const char* path : {"/maps/12/2177/dem.png", "/maps/12/a/1435.png", "/maps/x/1/1.png",
                             "/maps/12/4096/1.png", "/maps/12/1/4096.png", "/maps/31/1/1.png",
                             "/maps/12/-1/5.png", "/maps/12/1.5/5.png", "/vsizip/a.zip/1/1/1.png"})
        EXPECT_EQ(web_tile(path), std::nullopt) << path;
}

// The tile of Munich's centre at zoom 10 by the formulas of wiki.openstreetmap.org, "Slippy map
// tilenames": 544, 355; its north-west corner is 11.25 E 48.2246726 N.
TEST(WebTile, LiesWhereWebMapsHaveIt) {
    const Affine a = affine_of(WebTile{10, 544, 355}, 256, 256);
    const geo::Crs mercator = geo::Crs::parse("EPSG:3857", "test");
    const glm::dvec2 corner = a(-0.5, -0.5);
    const geo::Geodetic place = mercator.to_geodetic(corner.x, corner.y);
    EXPECT_NEAR(degrees(place.lon_rad), 11.25, 1e-9);
    EXPECT_NEAR(degrees(place.lat_rad), 48.2246726, 1e-7);
    const glm::dvec2 far = a(255.5, 255.5);
    EXPECT_NEAR(degrees(mercator.to_geodetic(far.x, far.y).lon_rad), 11.6015625, 1e-9);
}

}  // namespace
}  // namespace relevo::dem::test_placement
