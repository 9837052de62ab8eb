#include <cmath>
#include <ctime>

#include <fmt/format.h>

#include "climate/cover_table.h"
#include "support/support.h"

namespace relevo::climate {
namespace {

using geo::geodetic_deg;

TEST(CoverTable, CornersAreTheColumnsOfTheirPlaces) {
    const ClimateMap map = ClimateMap::shipped();
    const Box box{.west_deg = 11, .east_deg = 12, .south_deg = 47, .north_deg = 48};
    const CoverTable table(map, box, 400, 3500);
    const std::vector<float> texels = table.texels(200);
    ASSERT_EQ(texels.size(),
              8U * static_cast<std::size_t>(table.columns() * table.rows() * table.heights()));
    for (int height = 0; height < table.heights(); height += 7) {
        for (const bool north_east : {false, true}) {
            const CoverColumn column(
                map.at(north_east ? geodetic_deg(48, 12) : geodetic_deg(47, 11)));
            const double height_m = 400 + height * table.step_m();
            const int place = north_east ? table.columns() * table.rows() - 1 : 0;
            const float* const texel =
                &texels[4 *
                        static_cast<std::size_t>(height * table.columns() * table.rows() + place)];
            EXPECT_NEAR(texel[0], column.dryness(height_m), 1e-4);
            EXPECT_NEAR(texel[1], column.growth(height_m), 1e-4);
            EXPECT_NEAR(texel[2], column.green(height_m, 200), 1e-4);
            EXPECT_NEAR(texel[3], column.mean_c(height_m), 1e-4);
            const float* const snow = texel + texels.size() / 2;
            EXPECT_NEAR(snow[0], column.ice_balance_mm(height_m) / 1000, 1.5);  // mapped ice
            EXPECT_NEAR(snow[1], column.snow_share(height_m, 200), 0.35) << height_m;
        }
    }
}

TEST(CoverTable, SnowOfADayIsNotThatOfAnother) {
    const CoverTable table(ClimateMap::shipped(), {11, 12, 47, 48}, 400, 3500);
    const auto mean_snow = [&](double day) {
        const std::vector<float> texels = table.texels(day);
        double sum = 0;
        for (std::size_t i = texels.size() / 2 + 1; i < texels.size(); i += 4)
            sum += texels[i];
        return 8 * sum / static_cast<double>(texels.size());
    };
    EXPECT_GT(mean_snow(30), 0.8);
    EXPECT_LT(mean_snow(210), 0.3);
}

TEST(CoverTable, HasRoomForAPlanetAndIsQuickForATile) {
    const ClimateMap map = ClimateMap::shipped();
    const auto took_ms = [&](const Box& box, double lowest_m, double highest_m) {
        double least = 1e9;
        for (int i = 0; i < 3; ++i) {
            const std::clock_t began = std::clock();
            const CoverTable table(map, box, lowest_m, highest_m);
            EXPECT_LE(table.columns() * table.rows(), CoverTable::kMostPlaces);
            EXPECT_FALSE(table.texels(10).empty());
            const auto took = static_cast<double>(std::clock() - began);
            least = std::min(least, 1e3 * took / CLOCKS_PER_SEC);
        }
        return least;
    };
    const double tile_ms = took_ms({11, 12, 47, 48}, 400, 3500);
    const double planet_ms = took_ms({-180, 180, -90, 90}, -500, 6000);
    fmt::print(
        "[ measured ] processor time of a tile's table {:.1f} ms, of the planet's {:.0f} ms\n",
        tile_ms, planet_ms);
    EXPECT_LT(tile_ms, 60);  // guards for slow machines
    EXPECT_LT(planet_ms, 5000);
}

}  // namespace
}  // namespace relevo::climate
