#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "climate/fine_cover.h"
#include "support/support.h"

namespace relevo::climate::test_fine_cover {
namespace {

/// Two numbers of a place: dryness at a height, then the ice's balance and the snow's share there.
struct Read {
    float dryness, balance_m, snow;
};

Read read(const FineCover& cover, const CoverTable& table, double day, int column, int row,
          int level) {
    const std::vector<float> texels = cover.texels(day);
    EXPECT_EQ(texels.size(),
              8U * static_cast<std::size_t>(cover.columns() * cover.rows() * table.heights()));
    const auto at = [&](int of) {
        return &texels[4 * static_cast<std::size_t>((of * cover.rows() + row) * cover.columns() +
                                                    column)];
    };
    const float* const snow = at(level + table.heights());
    return {at(level)[0], snow[0], snow[1]};
}

TEST(FineCover, IsTheTableWhereNothingFinerIsKnown) {
    const ClimateMap map = ClimateMap::shipped();
    const Box alps{11, 12, 47, 48};
    const CoverTable table(map, alps, 400, 3500);
    const FineCover cover(map, alps, table, [](const geo::Geodetic&) { return 1000.0F; });
    EXPECT_EQ(cover.columns(), table.columns());
    EXPECT_EQ(cover.texels(200), table.texels(200));
}

TEST(FineCover, IslandsInTheTradeWindsHaveADrySide) {
    const ClimateMap map = ClimateMap::shipped();
    const Box box{-156.2, -154.7, 18.8, 20.4};
    const CoverTable table(map, box, -600, 4500);
    const FineCover cover(map, box, table, [](const geo::Geodetic& place) {
        const double lat = place.lat_rad * 180 / kPi - 19.6,
                     lon = place.lon_rad * 180 / kPi + 155.5;
        return static_cast<float>(4000 * std::exp(-8 * (lat * lat + lon * lon)) - 300);
    });
    EXPECT_EQ(cover.columns(), 33);
    const int shore = static_cast<int>(600 / table.step_m());
    const Read wet = read(cover, table, 200, 24, 20, shore),
               dry = read(cover, table, 200, 8, 12, shore);
    fmt::print("[ climate ] dryness {:.2f} before the wind, {:.2f} behind\n", wet.dryness,
               dry.dryness);
    EXPECT_GT(wet.dryness, 3 * dry.dryness);
    // The summit is above the clouds.
    EXPECT_LT(read(cover, table, 200, 24, 20, static_cast<int>(4600 / table.step_m())).dryness,
              0.4F * wet.dryness);
}

TEST(FineCover, IslandsOfAWholeChainHaveADrySide) {
    const ClimateMap map = ClimateMap::shipped();
    const auto heights = [](const geo::Geodetic& place) {
        const double lat = degrees(place.lat_rad) - 19.6, lon = degrees(place.lon_rad) + 155.5;
        return static_cast<float>(4000 * std::exp(-8 * (lat * lat + lon * lon)) - 300);
    };
    for (const double width_deg : {15.0, 23.0}) {
        const Box box{-155.5 - 0.75 * width_deg, -155.5 + 0.25 * width_deg, 16, 25};
        const CoverTable table(map, box, -600, 4500);
        const FineCover cover(map, box, table, heights);
        EXPECT_EQ(cover.rows(), 33);
        const auto column = [&](double lon_deg) {
            return static_cast<int>(
                std::lround((lon_deg - box.west_deg) / width_deg * (cover.columns() - 1)));
        };
        const int shore = static_cast<int>(600 / table.step_m());
        const int row = static_cast<int>(std::lround((19.6 - 16) / 9 * 32));
        const Read wet = read(cover, table, 200, column(-155.1), row, shore);
        const Read dry = read(cover, table, 200, column(-155.9), row, shore);
        fmt::print(
            "[ climate ] {:.0f} degrees wide, {} columns: dryness {:.2f} before the wind, {:.2f} "
            "behind\n",
            width_deg, cover.columns(), wet.dryness, dry.dryness);
        EXPECT_GT(wet.dryness, 2 * dry.dryness);
        EXPECT_GE(dry.dryness, 0.64F) << "places 40 km apart have no desert";
    }
    const Box ocean{-180, -140, 0, 30};
    const CoverTable table(map, ocean, -600, 4500);
    EXPECT_EQ(FineCover(map, ocean, table, heights).columns(), table.columns());
}

TEST(FineCover, AntarcticasHillsWithoutMappedIceAreBare) {
    const ClimateMap map = ClimateMap::shipped();
    const auto heights = [](const geo::Geodetic&) { return 50.0F; };
    for (const Box& oasis : {Box{100.6, 101.0, -66.35, -66.2}, Box{78.0, 78.4, -68.62, -68.5}}) {
        const CoverTable table(map, oasis, -600, 2500);
        const FineCover cover(map, oasis, table, heights);
        const Read middle = read(cover, table, 15, 16, 16, 16);
        EXPECT_LT(middle.balance_m, 0);
        EXPECT_LT(middle.snow, 0.3F);
    }
    const Box sheet{79.4, 79.8, -69.2, -69.0};
    const CoverTable table(map, sheet, -600, 2500);
    const FineCover cover(map, sheet, table, heights);
    EXPECT_GT(read(cover, table, 15, 16, 16, 30).balance_m, 1);
}

}  // namespace
}  // namespace relevo::climate::test_fine_cover
