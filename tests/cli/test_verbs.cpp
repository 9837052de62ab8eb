#include <filesystem>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_verbs {
namespace {

TEST(Help, OfAllListsEveryOptionOfEveryVerb) {
    const Result all = relevo({"--help-all"});
    EXPECT_EQ(all.status, 0);
    for (const std::vector<std::string>& verb :
         std::vector<std::vector<std::string>>{{"capture"},
                                               {"zones"},
                                               {"info"},
                                               {"doctor"},
                                               {"export", "heightmap"},
                                               {"export", "normals"},
                                               {"export", "mesh"},
                                               {"export", "web"},
                                               {"plugins", "info"},
                                               {"sun", "position"},
                                               {"sun", "day"},
                                               {"sun", "horizon"},
                                               {"sun", "carpet"},
                                               {"sun", "when"},
                                               {"sun", "along"},
                                               {"moon", "when"}}) {
        std::vector<std::string> arguments = verb;
        arguments.emplace_back("--help");
        std::string name = verb.front();
        if (verb.size() > 1) name += " " + verb.back();
        const std::size_t begin = all.out.find("\n" + name + "\n");
        ASSERT_NE(begin, std::string::npos) << name;
        const std::string of_verb = all.out.substr(begin, all.out.find("\n\n", begin + 1) - begin);
        std::istringstream help(relevo(arguments).out);
        for (std::string line; std::getline(help, line);) {
            std::istringstream words(line);
            std::string option;
            words >> option;
            if (!line.starts_with("  -") || option.starts_with("-h") || option == "--help-all")
                continue;
            EXPECT_NE(of_verb.find("    " + option), std::string::npos) << name << " " << option;
        }
    }
}

TEST(InfoVerb, SpeaksJsonAsDocumented) {
    const Result run = relevo({"info", bundled_dem(), "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["driver"], "GTiff");
    EXPECT_EQ(json["size"], (nlohmann::json{403, 344}));
    EXPECT_EQ(json["crs"], "EPSG:4326");
    EXPECT_NEAR(json["center"]["lat_deg"].get<double>(), 36.30292, 1e-5);
    EXPECT_NEAR(json["center"]["lon_deg"].get<double>(), -84.24583, 1e-5);
    EXPECT_EQ(json["elevation_m"]["min"], 236);
    EXPECT_EQ(json["elevation_m"]["max"], 1076);
    EXPECT_EQ(json["nodata_share"], 0);
    for (const char* key : {"extent_m", "post_spacing_m", "unit", "assumptions"})
        EXPECT_TRUE(json.contains(key)) << key;
}

TEST(SunPositionVerb, TakesASouthernLatitudeWithoutAnEqualsSign) {
    const Result run =
        relevo({"sun", "position", "--at", "-33.9,18.4", "--time", "2026-06-21T12:00Z", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["utc"], "2026-06-21T12:00:00.000Z");
    // In Cape Town the midwinter sun stands in the north after noon, 90 - 33.9 - 23.4 degrees high
    // at most.
    EXPECT_GT(json["azimuth_deg"].get<double>(), 270);
    EXPECT_LT(json["elevation_deg"].get<double>(), 32.7);
    EXPECT_GT(json["elevation_deg"].get<double>(), 25);
    EXPECT_GT(json["apparent_elevation_deg"], json["elevation_deg"]);
    EXPECT_NEAR(json["declination_deg"].get<double>(), 23.43, 0.01);
    EXPECT_NEAR(json["equation_of_time_min"].get<double>(), -1.9, 0.1);
    EXPECT_NEAR(json["distance_au"].get<double>(), 1.0162, 1e-4);
}

TEST(SunPositionVerb, RefractionCanBeLeftOut) {
    const Result run = relevo({"sun", "position", "--at", "47,11", "--time", "2026-06-21T04:00Z",
                               "--no-refraction", "--json"});
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["apparent_elevation_deg"], json["elevation_deg"]);
}

TEST(PluginsVerb, ListsWhatIsThereWithItsParameters) {
    const Result run = relevo({"plugins", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_TRUE(json["broken"].empty()) << json["broken"];
    for (const nlohmann::json& plugin : json["plugins"]) {
        const Result info = relevo({"plugins", "info", plugin["id"].get<std::string>()});
        EXPECT_EQ(info.status, 0) << info.err;
        for (const nlohmann::json& param : plugin["parameters"])
            EXPECT_NE(info.out.find(param["address"].get<std::string>()), std::string::npos);
    }
}

TEST(PluginsVerb, LeavesOutWhatOnlyThePluginsCodeWrites) {
    const std::filesystem::path folder = scratch_dir("cli_plugins") / "tide";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json")
        << R"({"format": 1, "id": "tide", "name": "Tide", "version": "1"})";
    std::ofstream(folder / "tide.glsl") << "uniform float tide_range_m = 3.0; //@ range(0, 20)\n"
                                           "uniform float tide_level_m = 0.0; //@ host\n"
                                           "void tide_on_albedo(inout Surface s) {}\n";
    const Result run =
        relevo({"plugins", "info", "tide", "--json", "--plugin-path", folder.string()});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json parameters = nlohmann::json::parse(run.out)["parameters"];
    ASSERT_EQ(parameters.size(), 1u);
    EXPECT_EQ(parameters[0]["address"], "tide.range_m");
}

}  // namespace
}  // namespace relevo::test::test_verbs
