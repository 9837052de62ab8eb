#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_capture {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

class Capture : public testing::Test {
  protected:
    /// Takes a picture of the bundled DEM; the run must succeed.
    std::filesystem::path take(const std::string& name, std::vector<std::string> more = {}) {
        const std::filesystem::path path = dir_ / name;
        more.insert(more.begin(), {"-q", "capture", bundled_dem(), "-o", path.string(), "--size",
                                   "320x256", "--overwrite"});
        const Result run = relevo(more);
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return path;
    }

    static double brightness(const image::Image8& picture) {
        double sum = 0;
        for (const std::uint8_t value : picture.values)
            sum += value;
        return sum / static_cast<double>(picture.values.size());
    }

    std::filesystem::path dir_ = scratch_dir("cli_capture");
};

TEST_F(Capture, WritesAPictureOfTheSizeAskedForWithItsSunInside) {
    const auto path = take("a.png", {"--time", "2026-06-21T18:30", "--tz", "America/New_York"});
    const image::Image8 picture = image::read(path);
    EXPECT_EQ(picture.width, 320);
    EXPECT_EQ(picture.height, 256);
    EXPECT_EQ(image::read_metadata(path).at("Description"),
              "36.30292 N 84.24583 W; 2026-06-21T22:30:00Z; sun at azimuth 280.33, elevation 27.03 "
              "(27.05 "
              "with refraction)");
}

TEST_F(Capture, TellsOfTheSunAsTheEyeSeesIt) {
    // The DEM's corner is a tenth of a degree from its centre, and so is the sun.
    const std::vector<std::string> eye{"--eye", "36.05,-84.05,3000", "--heading", "300"};
    const std::vector<std::string> time{"--time", "2026-06-21T18:30-04:00"};
    const auto run = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"-v", "capture", bundled_dem(), "-o", (dir_ / "a.png").string(),
                                   "--size", "32x32", "--overwrite", "--only", ""});
        more.insert(more.end(), time.begin(), time.end());
        return relevo(more).err;
    };
    const nlohmann::json sun = nlohmann::json::parse(
        relevo({"sun", "position", "--at", "36.05,-84.05,3000", time[0], time[1], "--json"}).out);
    const std::string expected =
        fmt::format("sun at azimuth {:.2f}, elevation {:.2f} ({:.2f} with refraction)",
                    sun["azimuth_deg"].get<double>(), sun["elevation_deg"].get<double>(),
                    sun["apparent_elevation_deg"].get<double>());
    for (const char* exaggeration : {"1", "3"}) {
        std::vector<std::string> more = eye;
        more.insert(more.end(), {"--exaggerate", exaggeration});
        EXPECT_THAT(run(more),
                    HasSubstr("relevo: 36.05000 N 84.05000 W (the eye), 2026-06-21T22:30:00Z: " +
                              expected + "\n"));
        EXPECT_EQ(image::read_metadata(dir_ / "a.png").at("Description"),
                  "36.05000 N 84.05000 W (the eye); 2026-06-21T22:30:00Z; " + expected);
    }
    const std::string orbit = run({});
    EXPECT_THAT(orbit,
                HasSubstr("relevo: 36.30292 N 84.24583 W, 2026-06-21T22:30:00Z: sun at azimuth "
                          "280.33, elev"));
    EXPECT_EQ(orbit.find(expected), std::string::npos);
}

/// What a capture without options of time and view writes, line by line.
std::vector<std::string> lines_of(const std::string& dem, const std::filesystem::path& picture,
                                  const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"capture", dem,     "-o",          picture.string(),
                                   "--size",  "64x48", "--overwrite", "--allow-blank"};
    words.insert(words.end(), more.begin(), more.end());
    const Result run = relevo(words);
    EXPECT_EQ(run.status, 0) << run.err;
    std::vector<std::string> lines = split(run.err, '\n');
    if (!lines.empty()) {
        EXPECT_EQ(lines.back(), "");
        lines.pop_back();
    }
    return lines;
}

TEST_F(Capture, SaysWhatItChoseInOneLine) {
    const auto picture = dir_ / "chosen.png";
    const auto chosen = lines_of(bundled_dem(), picture);
    ASSERT_EQ(chosen.size(), 1u);
    EXPECT_THAT(chosen[0],
                MatchesRegex("relevo: chosen: 21 June 2026 [0-9]+:[0-9]+, seen from the "
                             "[NESW]+, heights × 2.2; --time, --view and --exaggerate set others"));
    const auto time = lines_of(bundled_dem(), picture, {"--view", "az=200,el=30"});
    ASSERT_EQ(time.size(), 1u);
    EXPECT_THAT(time[0], MatchesRegex("relevo: chosen: 21 June 2026 [0-9]+:[0-9]+; --time sets "
                                      "another"));
    const std::vector<std::string> at{"--time", "2026-06-21T22:30Z"};
    const auto view = lines_of(bundled_dem(), picture, at);
    ASSERT_EQ(view.size(), 1u);
    EXPECT_THAT(view[0],
                MatchesRegex("relevo: chosen: seen from the [NESW]+; --view sets another"));
    EXPECT_TRUE(lines_of(bundled_dem(), picture, {at[0], at[1], "--view", "top"}).empty());
    const auto small = lines_of(bundled_dem(), picture, {"--memory", "64"});
    ASSERT_EQ(small.size(), 2u);
    EXPECT_THAT(small[0], HasSubstr("not 2.2 times, with a --memory below 3072 MiB"));
}

// "A normal run says at most one line of assumptions": and one more of what it chose.
TEST_F(Capture, WithoutOptionsWritesAtMostTwoLines) {
    // Undeclared voids, no unit, no datum, sea at the edge, holes that are filled and cut.
    Raster raster;
    raster.columns = raster.rows = 60;
    raster.value = [](int column, int row, int) {
        const bool inside = column == 40 && row == 30, edge = column == 30 && row == 0;
        return inside || edge ? -9999.0 : std::max(-40.0, 10.0 * column - 100 + row % 3);
    };
    std::vector<std::string> dems{write_raster(dir_ / "many_assumptions.tif", raster)};
    if (const auto data = test_data_dir())
        for (const char* name : {"N42E001.hgt", "HI_topo_04.nc", "mt_rainier_90m.tif",
                                 "swellendam/srtm_41_19_4326.tif", "hawaii_rotated20.tif"})
            dems.push_back((*data / "dem" / name).string());
    for (const std::string& dem : dems) {
        const auto lines = lines_of(dem, dir_ / "few.png");
        EXPECT_LE(lines.size(), 2u) << testing::PrintToString(lines);
        EXPECT_THAT(lines.back(), StartsWith("relevo: chosen: "));
    }
    // The rest is there, one notice a line, for who asks.
    const auto all = lines_of(dems[0], dir_ / "few.png", {"-v"});
    EXPECT_GT(all.size(), 4u);
    const auto few = lines_of(dems[0], dir_ / "few.png");
    ASSERT_EQ(few.size(), 2u);
    EXPECT_THAT(few[0], MatchesRegex("relevo: .*-9999 is taken as a void .*; [0-9] more notices? "
                                     "with -v"));
}

TEST_F(Capture, IsTheSamePictureEveryTime) {
    EXPECT_EQ(read_text(take("a.png"), "test"), read_text(take("b.png"), "test"));
}

TEST_F(Capture, HasNeitherBlackDuskNorWhiteNoon) {
    for (const char* time : {"2026-06-21T17:30Z", "2026-06-22T00:30Z", "2026-06-22T01:15Z"}) {
        const double level = brightness(image::read(take("a.png", {"--time", time})));
        EXPECT_GT(level, 25) << time;
        EXPECT_LT(level, 200) << time;
    }
}

TEST_F(Capture, NoEffectsIsNotLayering) {
    const image::Image8 plain = image::read(take("plain.png", {"--only", ""}));
    const image::Image8 layered = image::read(take("layered.png"));
    const image::Image8 paper = image::read(take("paper.png", {"--preset", "paper"}));
    EXPECT_LT(image::compare(plain, layered).psnr_db, 35);
    EXPECT_LT(image::compare(paper, layered).psnr_db, 35);
}

TEST_F(Capture, ComparingSaysNothingOfTheHalfWithoutTheEffect) {
    const std::filesystem::path folder = dir_ / "tide";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json")
        << R"({"format": 1, "id": "tide", "name": "Tide", "version": "1"})";
    std::ofstream(folder / "tide.glsl")
        << "uniform float tide_tone = 0.3; //@ range(0, 1)\n"
           "void tide_on_albedo(inout Surface s) { s.diffuse = vec3(tide_tone); }\n";
    const Result run = relevo({"capture", bundled_dem(), "-o", (dir_ / "ab.png").string(),
                               "--overwrite", "--size", "64x48", "--only", "", "--plugin-path",
                               folder.string(), "--ab", "tide", "--set", "tide.tone=0.9"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err.find("tide"), std::string::npos) << run.err;
}

TEST_F(Capture, OtherFormatsHoldTheSamePicture) {
    const image::Image8 png = image::read(take("a.png"));
    EXPECT_EQ(image::compare(png, image::read(take("a.tif"))).worst, 0);
    EXPECT_GT(image::compare(png, image::read(take("a.jpg"))).psnr_db, 35);
    const image::ImageF light = image::read_float(take("a.exr"));
    EXPECT_EQ(light.width, 320);
    for (const float value : light.values)
        ASSERT_TRUE(std::isfinite(value));
}

TEST_F(Capture, TheGroundIsBelowTheHorizonForAnEyeInTheValley) {
    const auto path =
        take("eye.png", {"--eye", "36.25,-84.25,1200", "--heading", "0", "--fov", "60"});
    const image::Image8 picture = image::read(path);
    // Sky on top is bluer than it is green; ground at the bottom is not.
    const auto blue_minus_green = [&](int y) {
        double sum = 0;
        for (int x = 0; x < picture.width; ++x)
            sum += picture.at(x, y, 2) - picture.at(x, y, 1);
        return sum / picture.width;
    };
    EXPECT_GT(blue_minus_green(5), 5);
    EXPECT_LT(blue_minus_green(picture.height - 5), -5);
}

TEST_F(Capture, OfASavedSceneIsTheSamePicture) {
    const std::string file = (dir_ / "view.json").string();
    const auto drawn = take("a.png", {"--time",       "2026-06-21T18:30",
                                      "--tz",         "America/New_York",
                                      "--eye",        "36.30,-84.20,300agl",
                                      "--heading",    "70",
                                      "--fov",        "35",
                                      "--exaggerate", "1.5",
                                      "--disable",    "haze",
                                      "--set",        "layering.texture_m=8",
                                      "--exposure",   "0.5",
                                      "--save-scene", file});
    const auto again = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"-q", "capture", "--scene", file, "-o",
                                   (dir_ / "b.png").string(), "--overwrite"});
        const Result run = relevo(more);
        EXPECT_EQ(run.status, 0) << run.err;
        return read_text(dir_ / "b.png", "test");
    };
    const std::string picture = read_text(drawn, "test");
    EXPECT_EQ(again({}), picture);
    // What is given beside it comes last.
    EXPECT_NE(again({"--heading", "250"}), picture);
    EXPECT_NE(again({"--enable", "haze"}), picture);
    EXPECT_EQ(again({"--heading", "70", "--disable", "haze"}), picture);
    again({"--size", "64x48"});
    EXPECT_EQ(image::read(dir_ / "b.png").width, 64);
    // Neither the scene nor its DEM is replaced.
    expect_failure({"capture", "--scene", file, "-o", (dir_ / "c.png").string(), "--save-scene",
                    file, "--overwrite"},
                   3,
                   fmt::format("--save-scene: {0}: is the scene {0}, which would be overwritten; "
                               "give the result another name",
                               file));
    expect_failure(
        {"capture", "-o", (dir_ / "c.png").string()}, 2,
        "DEM is missing; write relevo capture DEM --output FILE; see relevo capture --help");
}

TEST_F(Capture, TimingsNameEveryStage) {
    const std::string file = (dir_ / "timings.json").string();
    take("a.png", {"--timings", file, "--repeat", "3"});
    const nlohmann::json json = nlohmann::json::parse(read_text(file, "test"));
    for (const char* stage : {"load", "device", "compile", "upload", "passes", "readback", "write"})
        EXPECT_GT(json["stages_ms"][stage].get<double>(), 0) << stage;
    for (const char* pass : {"geometry", "terrain", "background", "antialias"})
        EXPECT_GT(json["passes_ms"][pass].get<double>(), 0) << pass;
    EXPECT_EQ(json["frames"]["count"], 3);
    EXPECT_LE(json["frames"]["min_ms"], json["frames"]["median_ms"]);
    EXPECT_LE(json["frames"]["median_ms"], json["frames"]["max_ms"]);
    EXPECT_GT(json["frames"]["passes"]["terrain"]["processor_ms"].get<double>(), 0);
    EXPECT_FALSE(json["frames"]["passes"].contains("sun"));
    EXPECT_GT(json["frames_with_sun_moved"]["passes"]["sun"]["ms"].get<double>(), 0);
}

TEST_F(Capture, DumpsTheProgramsItCompiled) {
    take("a.png", {"--dump-shaders", (dir_ / "shaders").string()});
    EXPECT_TRUE(
        read_text(dir_ / "shaders/terrain.frag.glsl", "test").starts_with("#version 450 core\n"));
}

}  // namespace
}  // namespace relevo::test::test_capture
