#include <cmath>

#include "base/units.h"
#include "dem/load.h"
#include "support/support.h"

// The DEMs that the project ships (data/README.md) are where they say they are, the right way
// round.

namespace relevo::dem::test_bundled {
namespace {

Heightfield bundled(const char* name) {
    return load((test::source_dir() / "data" / "dem" / name).string());
}

struct Known {
    const char* name;
    double lat_deg, lon_deg;
    double low_m, high_m;  ///< what the height must lie between
};

/// How many of the known heights a field has at their places. The field may be seen mirrored.
int agreeing(const Heightfield& f, const std::vector<Known>& known, bool mirror_columns,
             bool mirror_rows) {
    int count = 0;
    for (const Known& k : known) {
        const glm::dvec2 post = f.grid.post(geo::geodetic_deg(k.lat_deg, k.lon_deg));
        const double column = mirror_columns ? f.grid.columns() - 1 - post.x : post.x;
        const double row = mirror_rows ? f.grid.rows() - 1 - post.y : post.y;
        const double height_m = f.height_at(column, row);
        const bool agrees = height_m >= k.low_m && height_m <= k.high_m;
        if (!mirror_columns && !mirror_rows) {
            EXPECT_TRUE(agrees) << k.name << " has " << height_m << " m";
        }
        count += agrees;
    }
    return count;
}

void expect_only_this_way_round(const Heightfield& f, const std::vector<Known>& known) {
    const int all = static_cast<int>(known.size());
    EXPECT_EQ(agreeing(f, known, false, false), all);
    for (const auto& [columns, rows] : {std::pair(true, false), {false, true}, {true, true}})
        EXPECT_LE(agreeing(f, known, columns, rows), all / 2) << columns << rows;
}

TEST(Bundled, JacksboroIsAsDescribed) {
    const Heightfield f = bundled("jacksboro.tif");
    EXPECT_EQ(f.grid.columns(), 403);
    EXPECT_EQ(f.grid.rows(), 344);
    EXPECT_EQ(f.grid.crs().code(), "EPSG:4326");
    EXPECT_EQ(f.about.statistics, (Statistics{236, 1076, 403 * 344, 0, 0}));
    EXPECT_EQ(f.about.unit_source, UnitSource::Band);
    EXPECT_NEAR(degrees(f.grid.center().lat_rad), 36.302917, 1e-6);
    EXPECT_NEAR(degrees(f.grid.center().lon_rad), -84.245833, 1e-6);
    // SRTM's posts are at whole multiples of 3 arc-seconds.
    const glm::dvec2 first = f.grid.affine()(0, 0) * 1200.0;
    EXPECT_NEAR(first.x, std::round(first.x), 1e-6);
    EXPECT_NEAR(first.y, std::round(first.y), 1e-6);
}

TEST(Bundled, JacksboroHasTheHighestPointWhereCrossMountainIs) {
    // 36°11'54"N 84°13'50"W, 3534 ft (1077 m): Wikipedia, "Cross Mountain (Tennessee)".
    const Heightfield f = bundled("jacksboro.tif");
    for (int r = 0; r < f.grid.rows(); ++r)
        for (int c = 0; c < f.grid.columns(); ++c)
            if (f.height_m.at(c, r) == f.about.statistics.max_m) {
                const geo::Geodetic summit = geo::geodetic_deg(36 + 11 / 60.0 + 54 / 3600.0,
                                                               -(84 + 13 / 60.0 + 50 / 3600.0));
                EXPECT_LT(geo::geodesic(f.place(c, r), summit).distance_m, 90);  // a post
            }
}

TEST(Bundled, JacksboroHasItsTownsInTheirValleys) {
    // Places and elevations of the towns in Wikipedia; the lake is at 305 m (winter pool) to 311 m.
    expect_only_this_way_round(bundled("jacksboro.tif"),
                               {
                                   {"Jacksboro, 335 m", 36.33, -84.1839, 310, 345},
                                   {"LaFollette, 327 m", 36.375, -84.1275, 310, 345},
                                   {"Rocky Top, 264 m", 36.22417, -84.15583, 250, 280},
                                   {"Cross Mountain, 1077 m", 36.19833, -84.23056, 1040, 1080},
                                   {"Norris Lake above its dam", 36.2300, -84.0850, 304, 312},
                                   {"Briceville, 280 m", 36.1787, -84.1844, 260, 310},
                               });
}

TEST(Bundled, VancouverIslandIsAsDescribed) {
    const Heightfield f = bundled("vancouver-island.tif");
    EXPECT_EQ(f.grid.columns(), 120);
    EXPECT_EQ(f.grid.rows(), 91);
    EXPECT_EQ(f.grid.crs().code(), "EPSG:3857");
    EXPECT_EQ(f.about.statistics, (Statistics{-1437, 2205, 120 * 91, 0, 0}));
    // The array's own first and last latitudes and longitudes, to a hundredth of a cell.
    const geo::Geodetic north_west = f.grid.place(0, 0);
    const geo::Geodetic south_east = f.grid.place(119, 90);
    EXPECT_NEAR(degrees(north_west.lat_rad), 49.98418, 3e-4);
    EXPECT_NEAR(degrees(north_west.lon_rad), 234.0167 - 360, 3e-4);
    EXPECT_NEAR(degrees(south_east.lat_rad), 48.01637, 3e-4);
    EXPECT_NEAR(degrees(south_east.lon_rad), 237.9834 - 360, 3e-4);
}

TEST(Bundled, VancouverIslandHasTheSeaAroundIt) {
    // Posts are 2.4 km apart, so peaks are low and only wide waters are deep.
    expect_only_this_way_round(bundled("vancouver-island.tif"),
                               {
                                   {"Golden Hinde, 2195 m", 49.66278, -125.74694, 1000, 2200},
                                   {"Mount Arrowsmith, 1819 m", 49.2236, -124.5939, 800, 1900},
                                   {"Mount Garibaldi, 2678 m", 49.8505, -123.0047, 1300, 2700},
                                   {"Olympic Mountains, their north", 48.02, -123.6, 300, 1500},
                                   {"Strait of Georgia", 49.3, -123.85, -500, -200},
                                   {"Strait of Juan de Fuca", 48.25, -124.0, -250, -100},
                                   {"continental shelf", 48.5, -125.9, -200, -60},
                                   {"continental slope", 48.05, -125.9, -1437, -700},
                               });
}

}  // namespace
}  // namespace relevo::dem::test_bundled
