#include "names/ground_name.h"
#include "support/support.h"

namespace relevo::names::test_ground_name {
namespace {

/// A grid in degrees with posts 0.01 degrees apart.
dem::Grid grid_of(double west_deg, double north_deg, int columns, int rows) {
    return dem::Grid(columns, rows, {west_deg, 0.01, 0, north_deg, 0, -0.01},
                     geo::Crs::parse("EPSG:4326", "test"));
}

TEST(GroundName, HasTheLargestPlaceAndTheHighestSummit) {
    EXPECT_EQ(ground_name(Gazetteer::shipped(), grid_of(11, 48, 100, 100)),
              "Innsbruck – Schrankogel");
}

TEST(GroundName, HasTheOneThatThereIs) {
    EXPECT_EQ(ground_name(Gazetteer::shipped(), grid_of(-122, 47, 100, 100)), "Mount Rainier");
}

TEST(GroundName, IsThatOfAPlaceNearBy) {
    EXPECT_EQ(ground_name(Gazetteer::shipped(), grid_of(-122.26, 46.25, 13, 13)), "Near Amboy");
    EXPECT_EQ(ground_name(Gazetteer::shipped(), grid_of(-160, 1, 50, 50)), "");  // open sea
}

}  // namespace
}  // namespace relevo::names::test_ground_name
