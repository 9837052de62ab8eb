#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/units.h"
#include "chart/skyline_names.h"
#include "light/fields.h"
#include "names/summit_list.h"

// Names of summits in the horizon of a point.
namespace relevo::chart {
namespace {

struct Hill {
    const char* name;
    double row, column, height_m;
};
/// Seen from the middle, (100, 100), on a plain of 500 m with posts 111 m apart.
constexpr Hill kHills[] = {{"Front", 80, 100, 560},  {"Sky", 60, 100, 1500},
                           {"Hidden", 30, 100, 900}, {"East", 100, 150, 800},
                           {"Close", 100, 97, 520},  {"Low", 140, 100, 700},
                           {"Behind", 100, 170, 914}};  // by 0.05 degrees

dem::Heightfield land() {
    return test::field_of(
        201, 201, {10, 0.001, 0, 0.2, 0, -0.001}, "EPSG:4326", [](int column, int row) {
            double height_m = 500;
            for (const Hill& hill : kHills)
                height_m = std::max(height_m, hill.height_m - 40 * std::hypot(column - hill.column,
                                                                              row - hill.row));
            return height_m;
        });
}

names::Gazetteer list(const dem::Grid& grid, double off_posts, int height_m = 0) {
    std::string rows;
    for (const Hill& hill : kHills) {
        const geo::Geodetic place = grid.place(hill.column + off_posts, hill.row);
        rows += fmt::format("{}\t\t\t{:.5f}\t{:.5f}\t{}\tG\n", hill.name, degrees(place.lat_rad),
                            degrees(place.lon_rad), height_m ? std::to_string(height_m) : "");
    }
    return test::summit_list(rows);
}

std::vector<std::string> texts_of(const std::vector<SkylineName>& names) {
    std::vector<std::string> texts;
    for (const SkylineName& name : names)
        texts.push_back(name.text);
    return texts;
}

TEST(SkylineNames, AreThoseOfTopsAgainstTheSky) {
    const dem::Heightfield field = land();
    const light::TerrainHorizon horizon(field, field.grid.place(100, 100));
    const names::Gazetteer gazetteer = list(field.grid, 1);
    const std::vector<SkylineName> names = names_on_skyline(horizon, gazetteer);
    // Not the hill in front of another one, behind one, even by little, and at the feet.
    EXPECT_THAT(texts_of(names), testing::ElementsAre("Sky ~1500 m", "East ~800 m", "Low ~700 m"));
    const auto near_deg = [](double rad, double deg) {
        return std::abs(std::remainder(degrees(rad) - deg, 360)) < 0.01;
    };
    ASSERT_EQ(names.size(), 3u);
    EXPECT_TRUE(near_deg(names[0].azimuth_rad, 0));  // of the top, not of the record
    EXPECT_TRUE(near_deg(names[1].azimuth_rad, 90));
    EXPECT_TRUE(near_deg(names[2].azimuth_rad, 180));
    for (const SkylineName& name : names)
        EXPECT_NEAR(name.elevation_rad, horizon.elevation_rad(name.azimuth_rad), 1e-9);
    EXPECT_NEAR(degrees(names[0].elevation_rad), degrees(std::atan(1000 / 4423.0)), 0.1);
}

TEST(SkylineNames, HaveTheirOwnHeight) {
    const dem::Heightfield field = land();
    const light::TerrainHorizon horizon(field, field.grid.place(100, 100));
    const names::Gazetteer gazetteer = list(field.grid, 1, 1234);
    EXPECT_THAT(texts_of(names_on_skyline(horizon, gazetteer)),
                testing::ElementsAre("Sky 1234 m", "East 1234 m", "Low 1234 m"));
}

TEST(SkylineNames, FarFromTheirTopsHaveNoHeightOfTheDem) {
    const dem::Heightfield field = land();
    const light::TerrainHorizon horizon(field, field.grid.place(100, 100));
    const names::Gazetteer gazetteer = list(field.grid, 3);
    for (const std::string& text : texts_of(names_on_skyline(horizon, gazetteer)))
        EXPECT_THAT(text, testing::Not(testing::HasSubstr("~")));
}

}  // namespace
}  // namespace relevo::chart
