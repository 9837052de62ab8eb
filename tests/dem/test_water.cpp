#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "dem/fill_holes.h"
#include "dem/load.h"
#include "dem/water.h"
#include "support/support.h"

namespace relevo::dem::test_water {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// A grid of 30 m in the middle of a place, north up.
Grid grid_at(double lat_deg, double lon_deg, int columns, int rows, double step_deg = 0.0003) {
    return {columns,
            rows,
            {lon_deg - 0.5 * columns * step_deg, step_deg, 0, lat_deg + 0.5 * rows * step_deg, 0,
             -step_deg},
            geo::Crs()};
}

Grid alps(const Array2d<float>& h) {
    return grid_at(47, 11, h.width(), h.height());
}

template <typename HeightOf>
Array2d<float> ground(int columns, int rows, const HeightOf& height_of) {
    Array2d<float> h(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            h.at(x, y) = static_cast<float>(height_of(x, y));
    return h;
}

/// Rough hills at least 3 m above their foot.
double hills(int x, int y) {
    return 3 + 0.4 * std::hypot(x - 60, y - 40) + 2 * std::sin(0.7 * x) * std::sin(0.9 * y);
}

TEST(Water, SeaIsWhatReachesTheEdgeAtZero) {
    const auto h =
        ground(200, 100, [](int x, int y) { return x < 50 ? 0 : 0.3 * (x - 49) + y % 3; });
    const Water water = find_water(h, alps(h));
    EXPECT_EQ(water.sea_posts, 50 * 100);
    EXPECT_EQ(water.kind.at(49, 7), WaterKind::Sea);
    EXPECT_EQ(water.kind.at(50, 7), WaterKind::None);
    EXPECT_TRUE(water.assumptions.empty());
    EXPECT_EQ(water.sea_floor_share(), 0) << "its surface";
    EXPECT_DOUBLE_EQ(water.sea_rim_share(), (2 * 50 + 98) / 596.0);
}

TEST(Water, AFloorBelowZeroIsSeaWithAFloor) {
    const auto h = ground(200, 100, [](int x, int y) { return x - 80.5 + 0.1 * (y % 3); });
    const Water water = find_water(h, alps(h));
    EXPECT_EQ(water.sea_posts, 81 * 100 - 0);
    EXPECT_EQ(water.kind.at(10, 7), WaterKind::SeaFloor);
    EXPECT_DOUBLE_EQ(water.sea_floor_share(), 81.0 / 200);
    // It may be a depression that nobody has told of: that is said.
    ASSERT_EQ(water.assumptions.size(), 1u);
    EXPECT_TRUE(
        water.assumptions[0].starts_with("8100 connected posts at or below 0 m, down to "
                                         "-80.5 m, are drawn as sea"))
        << water.assumptions[0];
}

TEST(Water, ADryHollowBelowZeroInsideIsLand) {
    const auto h = ground(200, 100, [](int x, int y) { return std::hypot(x - 100, y - 50) - 30; });
    EXPECT_FALSE(find_water(h, alps(h)).any());
    // Deeper than any land it can only be under water.
    auto deep = h;
    deep.at(100, 50) = -451;
    EXPECT_TRUE(find_water(deep, alps(deep)).any());
}

TEST(Water, AnOpenHoleStandsForTheSeaBeyond) {
    auto h = ground(200, 100,
                    [](int x, int y) { return std::hypot(x - 100, y - 50) > 20 ? 9 + x % 4 : -1; });
    EXPECT_EQ(find_water(h, alps(h)).sea_posts, 0);
    h.at(100, 50) = kHole;
    EXPECT_GT(find_water(h, alps(h)).sea_posts, 1000);
}

TEST(Water, KnownDepressionsStayDry) {
    // The same slope down to -80 m over the DEM's edge, in places of the Earth.
    const auto slope = [](double lat, double lon) {
        const auto h = ground(200, 100, [](int x, int y) { return 20 - 0.5 * x + 0.1 * (y % 3); });
        return find_water(h, grid_at(lat, lon, h.width(), h.height())).sea_posts;
    };
    EXPECT_GT(slope(47, 11), 15000);      // nobody knows of a depression in the Alps
    EXPECT_EQ(slope(36.2, -116.9), 0);    // Death Valley
    EXPECT_EQ(slope(31.5, 35.5), 0);      // the Dead Sea
    EXPECT_EQ(slope(29.5, 27.5), 0);      // Qattara
    EXPECT_EQ(slope(42.7, 89.2), 0);      // Turpan
    EXPECT_EQ(slope(14.2, 40.3), 0);      // Danakil
    EXPECT_EQ(slope(33.2, -115.8), 0);    // Salton
    EXPECT_GT(slope(32.0, 34.7), 15000);  // Tel Aviv
    EXPECT_GT(slope(36.6, -122), 15000);  // Monterey
}

TEST(Water, PoldersAreDryAndTheSeaBesideThemIsNot) {
    // Zeeland: the sea at 0, a dike, land at -2 that reaches the edge.
    const auto h = ground(200, 100, [](int x, int y) {
        return x < 90 ? 0 : x < 93 ? 8 : -2 + 0.1 * ((x + y) % 5);
    });
    const Water water = find_water(h, grid_at(51.5, 4.0, h.width(), h.height()));
    EXPECT_EQ(water.sea_posts, 90 * 100);
    EXPECT_EQ(water.kind.at(150, 50), WaterKind::None);
}

TEST(Water, ACollarOfZerosIsNoSea) {
    const auto h = ground(200, 100, [](int x, int y) {
        return std::min({x, y, 199 - x, 99 - y}) < 10 ? 0.0 : 400 + x % 7;
    });
    EXPECT_FALSE(find_water(h, alps(h)).any());
}

TEST(Water, AFlatWithHigherGroundAroundIsALake) {
    const auto h =
        ground(120, 80, [](int x, int y) { return 500 + std::max(hills(x, y) - 10, 0.0); });
    const Water water = find_water(h, alps(h));
    EXPECT_EQ(water.lakes, 1);
    // A post that no other touches by a side is none of it.
    EXPECT_NEAR(static_cast<double>(water.lake_posts),
                static_cast<double>(std::count(h.begin(), h.end(), 500.0f)), 50);
    EXPECT_EQ(water.kind.at(60, 40), WaterKind::Lake);
}

TEST(Water, AReservoirWithTheGroundFallingBehindItsDamIsALake) {
    const auto h = ground(120, 80, [](int x, int y) {
        if (x >= 60 && x < 62 && std::abs(y - 40) < 10) return 510.0;  // the dam
        if (x >= 62) return 480 + 0.8 * std::abs(y - 40) + 0.1 * (120 - x);
        return 500 + std::max(std::abs(y - 40) - 8.0 + 0.1 * (60 - x), 0.0) * 2;
    });
    const Water water = find_water(h, alps(h));
    EXPECT_EQ(water.lakes, 1);
    EXPECT_EQ(water.kind.at(50, 40), WaterKind::Lake);
    EXPECT_EQ(water.kind.at(70, 40), WaterKind::None);
}

TEST(Water, AResampledLakeIsALake) {
    // Between posts of one height rounding leaves the last bit.
    const auto h = ground(120, 80, [](int x, int y) {
        return hills(x, y) < 10 ? 558.1f * (1 + 1e-7f * static_cast<float>((x * 7 + y) % 2))
                                : 558.1f + static_cast<float>(hills(x, y)) - 9;
    });
    EXPECT_EQ(find_water(h, alps(h)).lakes, 1);
}

TEST(Water, ALakeOnTwoSheetsIsALake) {
    // As the lakes of Thun and Brienz in DHM25: 558.01 m and 558 m.
    const auto h = ground(120, 80, [](int x, int y) {
        return hills(x, y) < 10 ? (x < 60 ? 558.01f : 558.0f)
                                : 558.5f + static_cast<float>(hills(x, y)) - 9;
    });
    const Water water = find_water(h, alps(h));
    EXPECT_EQ(water.kind.at(57, 40), WaterKind::Lake);
    EXPECT_EQ(water.kind.at(62, 40), WaterKind::Lake);
}

TEST(Water, AShoreThatACubicKernelLoweredIsOneOfALake) {
    // As Lake Garda in SRTM in whole metres: a ring below the lake, and mountains behind it.
    const auto ringed = [](double behind) {
        return ground(160, 120, [behind](int x, int y) {
            const double r = std::hypot(x - 80, y - 60);
            if (r < 40) return 562.0;
            if (r < 42 && y < 95) return 561.0 - (x + y) % 2;
            return std::round(562 + behind * (r - 39.5));
        });
    };
    const auto lake = ringed(8);
    EXPECT_EQ(find_water(lake, alps(lake)).lakes, 1);
    const auto hilltop = ringed(-8);
    EXPECT_FALSE(find_water(hilltop, alps(hilltop)).any());
}

TEST(Water, TerracesOfWholeMetresAreNoLakes) {
    const auto whole = [](double metres) { return std::floor(metres); };
    const auto slope =
        ground(300, 300, [&](int x, int y) { return whole(300 + 0.03 * x + 0.01 * y); });
    EXPECT_FALSE(find_water(slope, alps(slope)).any());
    // A valley that falls, and a plain with a hollow whose rim rises by a metre.
    const auto valley = ground(300, 300, [&](int x, int y) {
        return whole(300 + 0.02 * x + 0.0004 * (y - 150) * (y - 150));
    });
    EXPECT_FALSE(find_water(valley, alps(valley)).any());
    const auto plain = ground(300, 300, [&](int x, int y) {
        return whole(300.5 + 0.9 * std::sin(0.06 * x) * std::sin(0.05 * y) + 0.004 * x);
    });
    const Water water = find_water(plain, alps(plain));
    EXPECT_LT(static_cast<double>(water.lake_posts), 0.02 * 300 * 300);
}

TEST(Water, APlayaThatIsNotQuiteFlatIsLand) {
    const auto h = ground(300, 200, [](int x, int y) {
        const double r = std::hypot(x - 150, y - 100);
        return 1200 + (r < 60 ? 0.002 * r : 0.12 + 0.5 * (r - 60));
    });
    EXPECT_FALSE(find_water(h, alps(h)).any());
}

TEST(Water, AFlatHilltopIsLand) {
    const auto h =
        ground(120, 80, [](int x, int y) { return 500 - std::max(hills(x, y) - 10, 0.0); });
    EXPECT_FALSE(find_water(h, alps(h)).any());
}

TEST(Water, RealCoastsAndLakesAreFound) {
    SKIP_WITHOUT_TEST_DATA(data);
    const std::filesystem::path folder = data / "dem";
    const auto of = [&](const char* file) {
        const Heightfield field = load((folder / file).string());
        return std::pair(field, find_water(field.height_m, field.grid));
    };
    const auto kind_at = [](const auto& found, double lat_deg, double lon_deg) {
        const glm::dvec2 post = found.first.grid.post(geo::geodetic_deg(lat_deg, lon_deg));
        return found.second.kind.at(static_cast<int>(std::lrint(post.x)),
                                    static_cast<int>(std::lrint(post.y)));
    };
    const auto highlands = of("highlands_srtm3/highlands_srtm3.vrt");
    EXPECT_EQ(kind_at(highlands, 56.52, -5.55), WaterKind::Sea);     // the Firth of Lorn
    EXPECT_EQ(kind_at(highlands, 56.52, -4.13), WaterKind::Lake);    // Loch Tay
    EXPECT_EQ(kind_at(highlands, 56.797, -5.004), WaterKind::None);  // Ben Nevis
    const auto tyrol = of("tyrol_aw3d30_n47e011_1s_cog.tif");
    EXPECT_EQ(kind_at(tyrol, 47.71, 11.74), WaterKind::Lake);  // Tegernsee
    EXPECT_EQ(tyrol.second.sea_posts, 0);
    EXPECT_LT(tyrol.second.lakes, 20);  // of 13 million posts with many flats
    const auto monterey = of("monterey_bay_topobathy.tif");
    EXPECT_EQ(kind_at(monterey, 36.79, -121.95), WaterKind::SeaFloor);
    for (const char* dry : {"srtm_bigtujunga30m_utm11.tif", "swellendam/srtm_41_19_4326.tif",
                            "colorado_tut_relief.nc", "holyroodpark.tif"})
        EXPECT_FALSE(of(dry).second.any()) << dry;
}

TEST(FillHoles, SmallOnesAreFilledLargeOnesCoveredAndThoseAtTheEdgeStay) {
    auto h = ground(200, 150, [](int x, int y) { return 100 + 2 * x + y; });
    const auto cut = [&](int west, int north, int columns, int rows) {
        for (int y = north; y < north + rows; ++y)
            for (int x = west; x < west + columns; ++x)
                h.at(x, y) = kHole;
    };
    cut(10, 10, 5, 5);
    cut(0, 0, 3, 3);
    cut(100, 40, 65, 10);
    const auto before = h;
    const FilledHoles found = fill_small_holes(h, Holes::Fill);
    EXPECT_EQ(found.filled_posts, 25);
    EXPECT_EQ(found.covered_posts, 650);
    EXPECT_EQ(found.cut_posts, 9);
    for (int y = 0; y < 150; ++y)
        for (int x = 0; x < 200; ++x) {
            const bool is_filled = x >= 10 && x < 15 && y >= 10 && y < 15;
            const bool is_covered = x >= 100 && x < 165 && y >= 40 && y < 50;
            EXPECT_EQ(found.filled.at(x, y), is_filled ? kFilled : is_covered ? kCovered : 0);
            // Within what a plane differs by over the hole.
            if (is_filled || is_covered) {
                EXPECT_NEAR(found.height_m.at(x, y), 100 + 2 * x + y, 4);
            } else if (!std::isnan(before.at(x, y))) {
                EXPECT_EQ(found.height_m.at(x, y), before.at(x, y));
            }
        }
    EXPECT_EQ(found.text(Holes::Fill),
              "voids: 2.28 % of the DEM, 0.0833 % drawn filled (--holes mark shows them), 2.17 % "
              "covered in grey (wider than 64 posts), 0.03 % cut out (at the edge)");
}

TEST(Water, ALakeWithAVoidIsOneLake) {
    auto h = ground(200, 160, [](int x, int y) {
        return std::hypot(x - 100, y - 80) < 60 ? 431.27 : 440 + hills(x, y);
    });
    const std::int64_t lake = find_water(h, alps(h)).lake_posts;
    for (int y = 40; y < 120; ++y)
        for (int x = 60; x < 130; ++x)
            if (std::hypot(x - 95, y - 80) < 35) h.at(x, y) = kHole;
    EXPECT_LT(find_water(h, alps(h)).lake_posts, lake);
    const FilledHoles drawn = fill_small_holes(h, Holes::Fill, ThinGround::Dropped);
    EXPECT_EQ(drawn.covered_posts, 0);
    const Water water = find_water(drawn.height_m, alps(h));
    EXPECT_EQ(water.lakes, 1);
    EXPECT_EQ(water.lake_posts, lake);
}

TEST(FillHoles, ACoverSpansFromRimToRimWithoutAStep) {
    // A plane is its own membrane; an island in the void keeps its height.
    auto h = ground(300, 260, [](int x, int y) { return 100 + 2 * x + y; });
    for (int y = 30; y < 230; ++y)
        for (int x = 40; x < 260; ++x)
            if (std::hypot(x - 150, y - 130) > 6) h.at(x, y) = kHole;
    const FilledHoles found = fill_small_holes(h, Holes::Fill);
    double worst_m = 0;
    for (int y = 0; y < 260; ++y)
        for (int x = 0; x < 300; ++x)
            worst_m = std::max(worst_m, std::abs(found.height_m.at(x, y) - (100.0 + 2 * x + y)));
    EXPECT_LT(worst_m, 8);  // of 840 m that the plane rises by
    EXPECT_EQ(found.cut_posts, 0);
}

TEST(FillHoles, CutFillsNone) {
    auto h = ground(50, 50, [](int x, int y) { return x + y; });
    h.at(20, 20) = kHole;
    const FilledHoles found = fill_small_holes(h, Holes::Cut);
    EXPECT_TRUE(found.height_m.empty());
    EXPECT_EQ(found.text(Holes::Cut), "voids: 0.04 % of the DEM, cut out");
    EXPECT_EQ(
        fill_small_holes(ground(9, 9, [](int, int) { return 1; }), Holes::Fill).text(Holes::Fill),
        "");
}

}  // namespace
}  // namespace relevo::dem::test_water
