// relevo zones as a person calls it.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_zones {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::filesystem::path& folder() {
    static const std::filesystem::path path = scratch_dir("zones");
    return path;
}

std::string written(const std::string& name, const std::string& text) {
    const std::string path = (folder() / name).string();
    std::ofstream(path) << text;
    return path;
}

/// A square over the middle of the bundled DEM, a bow tie, and a zone that is none.
std::string zones() {
    return written("zones.geojson", R"({"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"n":"square, \"A\""},"geometry":{"type":"Polygon","coordinates":
[[[-84.26,36.29],[-84.24,36.29],[-84.24,36.31],[-84.26,36.31],[-84.26,36.29]]]}},
{"type":"Feature","properties":{"n":"tie"},"geometry":{"type":"Polygon","coordinates":
[[[-84.26,36.29],[-84.24,36.31],[-84.24,36.29],[-84.26,36.31],[-84.26,36.29]]]}},
{"type":"Feature","properties":{"n":"line"},"geometry":{"type":"LineString","coordinates":
[[-84.26,36.29],[-84.24,36.31]]}}]})");
}

TEST(ZonesVerb, TablesEachZoneOnceAndNamesWhatIsNone) {
    const Result csv = relevo({"zones", bundled_dem(), "--zones", zones(), "--id", "n"});
    ASSERT_EQ(csv.status, 0) << csv.err;
    EXPECT_THAT(csv.out, HasSubstr("zone,cells,area_m2,area_valid_m2,mean,integral,min,max,"
                                   "share_above,error\n"));
    EXPECT_THAT(csv.out, HasSubstr("\n\"square, \"\"A\"\"\","));
    EXPECT_THAT(csv.err, HasSubstr("zone line: no polygon"));
    const Result run =
        relevo({"zones", bundled_dem(), "--zones", zones(), "--json", "--above", "400"});
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["schema"], "relevo-zones-1");
    ASSERT_EQ(json["zones"].size(), 3);
    const nlohmann::json &square = json["zones"][0], &tie = json["zones"][1];
    EXPECT_NEAR(square["area_m2"].get<double>(), 0.02 * 0.02 * 110965 * 89850, 8000);
    EXPECT_NEAR(tie["area_m2"].get<double>() / square["area_m2"].get<double>(), 0.5, 1e-4);
    EXPECT_GT(square["mean"], square["min"]);
    EXPECT_LT(square["mean"], square["max"]);
    EXPECT_GT(square["share_above"], 0);
    EXPECT_TRUE(json["zones"][2]["mean"].is_null());
    EXPECT_EQ(json["zones"][2]["zone"], "2");
}

TEST(ZonesVerb, TellsRastersAndBandsApartOnlyWhereThereAreSeveral) {
    const Result two = relevo({"zones", bundled_dem(), bundled_dem(), "--zones", zones()});
    ASSERT_EQ(two.status, 0) << two.err;
    EXPECT_TRUE(two.out.starts_with("raster,zone,")) << two.out;
}

TEST(ZonesVerb, WritesAGeoPackageThatIsItselfAFileOfZones) {
    const std::string package = (folder() / "out.gpkg").string();
    const Result run =
        relevo({"zones", bundled_dem(), "--zones", zones(), "--id", "n", "-o", package});
    ASSERT_EQ(run.status, 0) << run.err;
    const Result again = relevo({"zones", bundled_dem(), "--zones", package, "--id", "zone"});
    ASSERT_EQ(again.status, 0) << again.err;
    const Result first = relevo({"zones", bundled_dem(), "--zones", zones(), "--id", "n"});
    EXPECT_EQ(again.out.substr(0, again.out.find("line")),
              first.out.substr(0, first.out.find("line")));
    EXPECT_EQ(relevo({"zones", bundled_dem(), "--zones", zones(), "-o", package}).status, 3);
}

TEST(ZonesVerb, RefusesWhatItCannotUseAndLeavesNothing) {
    const std::string out = (folder() / "none.csv").string();
    const auto fails = [&](const std::vector<std::string>& more, int status, const char* why) {
        std::vector<std::string> arguments{"zones", bundled_dem(), "-o", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, status) << run.err;
        EXPECT_THAT(run.err, HasSubstr(why));
        EXPECT_FALSE(std::filesystem::exists(out)) << why;
    };
    fails({}, 2, "--zones");
    fails({"--zones", "/nowhere.gpkg"}, 3, "/nowhere.gpkg");
    fails({"--zones", bundled_dem()}, 3, "no polygons that can be read");
    fails({"--zones", zones(), "--id", "name"}, 3, "no such field");
    fails({"--zones", written("empty.geojson", R"({"type":"FeatureCollection","features":[]})")}, 3,
          "no zones");
    fails({"--zones", written("cut.geojson", R"({"type":"FeatureCollection","features":[{"ty)")}, 3,
          "no polygons that can be read");
    fails({"--zones", zones(), "--weights", "equal"}, 2, "--weights");
    EXPECT_EQ(
        relevo({"zones", bundled_dem(), "--zones", zones(), "-o", zones(), "--overwrite"}).status,
        2);
    const Result outside = relevo(
        {"zones", bundled_dem(), "--zones",
         written("far.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1]]]})")});
    EXPECT_EQ(outside.status, 3);
    EXPECT_THAT(outside.err, HasSubstr("outside of the raster"));
    EXPECT_THAT(outside.err, HasSubstr("no zone has a figure"));
}

}  // namespace
}  // namespace relevo::test::test_zones
