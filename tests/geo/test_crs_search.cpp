// A CRS by its code, its words and a place.
#include <algorithm>
#include <vector>

#include <gmock/gmock.h>

#include "geo/crs.h"
#include "geo/crs_search.h"

namespace relevo::geo {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string first_code(std::string_view text) {
    const std::vector<KnownCrs> found = search_crs(text, 5);
    return found.empty() ? "" : found.front().code;
}

TEST(CrsSearch, ByCodeWithAndWithoutItsAuthority) {
    EXPECT_EQ(first_code("31287"), "EPSG:31287");
    EXPECT_EQ(first_code("epsg:32632"), "EPSG:32632");
    EXPECT_EQ(first_code(" EPSG:2056 "), "EPSG:2056");
}

TEST(CrsSearch, ByWordsOfNameAndArea) {
    EXPECT_EQ(first_code("WGS 84 / UTM zone 32N"), "EPSG:32632");
    EXPECT_EQ(first_code("wgs utm 32n"), "EPSG:32632");
    EXPECT_EQ(first_code("mgi austria lambert"), "EPSG:31287");
    for (const KnownCrs& crs : search_crs("lambert portugal", 20))
        EXPECT_THAT(crs.name + crs.area, HasSubstr("Portugal"));
    EXPECT_THAT(search_crs("zzzz", 5), IsEmpty());
    EXPECT_THAT(search_crs("  ", 5), IsEmpty());
}

TEST(CrsSearch, ByPlaceTheSmallestAreaFirst) {
    const std::vector<KnownCrs> found = search_crs("47.26, 11.39", 40);
    ASSERT_EQ(found.size(), 40u);
    const auto area = [](const KnownCrs& crs) {
        return (crs.east_deg - crs.west_deg) * (crs.north_deg - crs.south_deg);
    };
    EXPECT_TRUE(std::ranges::is_sorted(found, {}, area));
    for (const KnownCrs& crs : found) {
        EXPECT_LE(crs.south_deg, 47.26);
        EXPECT_GE(crs.north_deg, 47.26);
    }
    EXPECT_TRUE(std::ranges::any_of(
        found, [](const KnownCrs& crs) { return crs.name.find("MGI") != std::string::npos; }));
    // Across the antimeridian.
    const std::vector<KnownCrs> fiji = search_crs("-17.5,179.9", 60);
    EXPECT_TRUE(std::ranges::any_of(
        fiji, [](const KnownCrs& crs) { return crs.name.find("Fiji") != std::string::npos; }));
}

TEST(CrsSearch, HoldsPointsInItsArea) {
    const KnownCrs west = search_crs("EPSG:31254", 1).front();  // Austria, west of 11.8 degrees
    // Innsbruck, and a place of the same numbers in another zone.
    EXPECT_TRUE(holds(west, std::vector<glm::dvec2>{{79'000, 236'000}, {82'000, 240'000}}));
    EXPECT_FALSE(holds(west, std::vector<glm::dvec2>{{79'000, 236'000}, {682'000, 240'000}}));
    const KnownCrs degrees = search_crs("EPSG:4326", 1).front();
    EXPECT_TRUE(holds(degrees, std::vector<glm::dvec2>{{11, 47}, {190, -47}}));
    EXPECT_FALSE(holds(degrees, std::vector<glm::dvec2>{{11, 91}}));
    EXPECT_FALSE(holds(degrees, std::vector<glm::dvec2>{{70'000, 47}}));
}

TEST(CrsSearch, GivesWhatParseTakes) {
    for (const KnownCrs& crs : search_crs("utm zone 3", 30))
        EXPECT_EQ(Crs::parse(crs.code, "test").is_geographic(), !crs.is_projected) << crs.code;
}

}  // namespace
}  // namespace relevo::geo
