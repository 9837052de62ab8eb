#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/log.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "dem/tile_index.h"
#include "support/support.h"

// STAC Items whose posts and outlines contradict each other.

namespace relevo::dem::test_stac_places {
namespace {

using test::folder;
using testing::ElementsAre;
using testing::IsEmpty;

/// Warnings while something is done.
template <typename Body>
std::vector<std::string> warnings_of(const Body& body) {
    std::vector<std::string> said;
    log::set_sink([&](log::Level level, std::string_view message) {
        if (level >= log::Level::Warning) said.emplace_back(message);
    });
    body();
    log::set_sink({});
    return said;
}

TEST(StacPlaces, BboxAndGeometryWinOverAWrongTransform) {
    const auto path = [](const char* name) {
        return test::small_case(fmt::format("stac_wrong_transform/{}.json", name));
    };
    Array2d<float> right;
    EXPECT_THAT(warnings_of([&] { right = load(path("ok")).height_m; }), IsEmpty());
    const struct {
        const char* name;
        const char* tiles;
    } cases[] = {{"first_wrong", "1 (a)"}, {"second_wrong", "1 (b)"}, {"both_wrong", "2 (a, b)"}};
    for (const auto& c : cases) {
        Array2d<float> found;
        EXPECT_THAT(warnings_of([&] { found = load(path(c.name)).height_m; }),
                    ElementsAre(fmt::format("{}: proj:transform of {} of 2 tiles contradicts bbox "
                                            "and geometry, which are used",
                                            path(c.name), c.tiles)));
        ASSERT_EQ(found.width(), 72) << c.name;
        ASSERT_EQ(found.height(), 36) << c.name;
        EXPECT_EQ(std::memcmp(found.data(), right.data(), right.size() * sizeof(float)), 0);
    }
}

/// The tile of an Item of 40 rows by 60 columns.
TileIndex index_of(const std::string& properties, const std::string& place) {
    const std::string path = (folder() / "item.json").string();
    std::ofstream(path) << R"({"type": "Feature", "stac_version": "1.1.0", "id": "a", )" << place
                        << R"(, "properties": {"proj:shape": [40, 60], )" << properties
                        << R"(}, "assets": {"data": {"href": "a.tif", "roles": ["data"]}}})";
    return read_tile_index(path);
}

std::string box(double west, double south, double east, double north) {
    return fmt::format(R"("bbox": [{}, {}, {}, {}])", west, south, east, north);
}

TEST(StacPlaces, RoundedTurnedAndPartialOutlinesContradictNothing) {
    const std::string utm =
        R"("proj:epsg": 32632, "proj:transform": [30, 0, 500000, 0, -30, 5200000])";
    // 9 to 9.02366 E, 46.94273 to 46.95353 N.
    EXPECT_EQ(index_of(utm, box(9, 46.943, 9.024, 46.954)).contradicting.count, 0);
    const std::string survey =
        R"("geometry": {"type": "Polygon", "coordinates": [[[9.001, 46.943], [9.02, 46.944], )"
        R"([9.01, 46.952], [9.001, 46.943]]]})";
    EXPECT_EQ(index_of(utm, survey).contradicting.count, 0);
    // Longitudes of another turn, and across the antimeridian.
    const std::string degrees =
        R"("proj:epsg": 4326, "proj:transform": [0.01, 0, 179.7, 0, -0.01, 10])";
    EXPECT_EQ(index_of(degrees, box(179.7, 9.6, -179.7, 10)).contradicting.count, 0);
    const std::string turned =
        R"("proj:epsg": 4326, "proj:transform": [0.01, 0, 200, 0, -0.01, 10])";
    EXPECT_EQ(index_of(turned, box(-160, 9.6, -159.4, 10)).contradicting.count, 0);
    EXPECT_EQ(index_of(turned, R"("geometry": null)").contradicting.count, 0);
}

TEST(StacPlaces, OthersDo) {
    const auto contradicts = [](const std::string& transform, const std::string& place) {
        const TileIndex index =
            index_of(R"("proj:epsg": 4326, "proj:transform": )" + transform, place);
        const Extent& e = index.tiles.front().extent;
        EXPECT_EQ(index.contradicting.count == 0, e != (Extent{10, 9.6, 10.6, 10})) << transform;
        return index.contradicting.count == 1;
    };
    const std::string place = box(10, 9.6, 10.6, 10);
    EXPECT_TRUE(contradicts("[0.01, 0, 20, 0, -0.01, 10]", place)) << "elsewhere";
    EXPECT_TRUE(contradicts("[0.005, 0, 10, 0, -0.005, 10]", place)) << "smaller";
    EXPECT_TRUE(contradicts("[0.03, 0, 10, 0, -0.03, 10]", place)) << "larger";
    EXPECT_TRUE(contradicts("[0.01, 0, 10.05, 0, -0.01, 10]", place)) << "shifted";
    EXPECT_FALSE(contradicts("[0.01, 0, 9.995, 0, -0.01, 10.005]", place)) << "half a post";
}

}  // namespace
}  // namespace relevo::dem::test_stac_places
