#include <chrono>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/job_fixture.h"
#include "dem/fixture.h"
#include "image/image.h"

/// What `relevo run` reads, keeps and replaces.
namespace relevo::test::test_run_files {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RunFiles : public JobTest {
  protected:
    /// A job of every kind of input, each a file of the test's own.
    fs::path job_of_all_inputs() {
        Raster plain;
        plain.columns = plain.rows = 20;
        write_raster(dir_ / "dem.tif", plain);
        plain.value = [](int column, int row, int) { return column + row; };
        write_raster(dir_ / "overlay.tif", plain);
        write("colours.txt", "0 0 0 255\n40 255 0 0\n");
        write("look.json", "{\"set\": {\"haze.density\": 0.1}}");
        fs::create_directories(dir_ / "plugins/red");
        write("plugins/red/plugin.json",
              "{\"format\": 1, \"id\": \"red\", \"name\": \"Red\", \"description\": \"Red "
              "ground\", \"version\": \"1.0.0\"}");
        write("plugins/red/red.glsl", kRed);
        return write(
            "job.json",
            "{\"format\": 1, \"dem\": {\"files\": [\"dem.tif\"]}, \"picture\": {\"size\": [64, "
            "48]}, \"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"overlay\": {\"file\": "
            "\"overlay.tif\", \"colours\": \"colours.txt\"}, \"effects\": {\"presets\": "
            "[\"./look.json\"]}, \"output\": \"a.png\"}");
    }
    static constexpr const char* kRed =
        "void red_on_material(inout Surface s) { s.diffuse = vec3(1, 0, 0); }\n";

    Result resumed(const fs::path& path, std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"run", path.string(), "--resume", "--plugin-path",
                                   (dir_ / "plugins").string()});
        return relevo(more);
    }
    std::string cannot_keep(const char* why) const {
        return fmt::format(
            "relevo: error: run: {}: {}, the first of 1 that --resume cannot keep; pass "
            "--overwrite to make it again\n",
            (dir_ / "a.png").string(), why);
    }
};

TEST_F(RunFiles, ResumeNoticesEveryInputWhoseContentChangedWhateverItsTime) {
    const fs::path path = job_of_all_inputs();
    const Result first = resumed(path);
    ASSERT_EQ(first.status, 0) << first.err;
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(24 * 365);
    const std::vector<std::pair<const char*, const char*>> inputs{
        {"dem.tif", "the DEM has changed"},
        {"overlay.tif", "the overlay has changed"},
        {"colours.txt", "the colour file has changed"},
        {"look.json", "the preset has changed"},
        {"plugins/red/red.glsl", "a plugin has changed"}};
    for (const auto& [name, why] : inputs) {
        const std::string before = bytes_of(dir_ / name);
        std::string after = before;
        if (fs::path(name).extension() == ".tif")
            after[after.size() - 3] ^= 1;  // a value of the last post
        else
            after += " ";
        write(name, after);
        // As a copy that keeps times, or a clock that was wrong.
        fs::last_write_time(dir_ / name, old);
        EXPECT_THAT(resumed(path).err, HasSubstr(cannot_keep(why))) << name;
        write(name, before);
        EXPECT_THAT(resumed(path).err, HasSubstr("0 pictures in 0 s; 1 were there already"))
            << name << " is as it was, and newer than the picture";
    }
}

TEST_F(RunFiles, ResumeNoticesATileOfAFolder) {
    fs::create_directories(dir_ / "tiles");
    fs::create_directories(dir_ / "plugins");
    Raster plain;
    plain.columns = plain.rows = 20;
    for (const char* name : {"tiles/west.tif", "tiles/east.tif"}) {
        write_raster(dir_ / name, plain);
        (*plain.geotransform)[0] += 20 * (*plain.geotransform)[1];
    }
    const fs::path path =
        write("job.json",
              "{\"format\": 1, \"dem\": {\"files\": [\"tiles\"]}, \"picture\": {\"size\": [64, "
              "48]}, \"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"output\": \"a.png\"}");
    ASSERT_EQ(resumed(path).status, 0);
    std::string east = bytes_of(dir_ / "tiles/east.tif");
    east[east.size() - 3] ^= 1;
    write("tiles/east.tif", east);
    EXPECT_THAT(resumed(path).err, HasSubstr(cannot_keep("the DEM has changed")));
    // And no picture may take the place of one.
    EXPECT_THAT(error(path, {"-o", (dir_ / "tiles/east.tif").string(), "--overwrite"}),
                HasSubstr("the DEM"));
    EXPECT_EQ(bytes_of(dir_ / "tiles/east.tif"), east);
}

TEST_F(RunFiles, ADeepRecordIsNoRecord) {
    const fs::path path = job("\"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"output\": \"a.png\"");
    ASSERT_EQ(relevo({"run", path.string(), "--sidecar"}).status, 0);
    constexpr std::size_t kDeep = 1'000'000;
    write("a.png.json", "{\"scene\": " + std::string(kDeep, '[') + std::string(kDeep, ']') + "}");
    EXPECT_THAT(relevo({"run", path.string(), "--resume", "--sidecar"}).err,
                HasSubstr(cannot_keep("its sidecar is of another scene")));
}

TEST_F(RunFiles, ResumeKeepsNoSidecarOfAnotherDate) {
    const auto on = [&](const char* date) {
        return job(fmt::format("\"time\": {{\"at\": \"{}T12:00Z\"}}, \"output\": \"a.png\"", date));
    };
    ASSERT_EQ(relevo({"run", on("2026-06-21").string(), "--sidecar"}).status, 0);
    ASSERT_EQ(relevo({"run", on("2026-12-21").string(), "--overwrite"}).status, 0);
    const std::string path = (dir_ / "job.json").string();
    EXPECT_THAT(relevo({"run", path, "--resume", "--sidecar"}).err,
                HasSubstr(cannot_keep("its sidecar is of another scene")));
    ASSERT_EQ(relevo({"run", path, "--resume", "--sidecar", "--overwrite"}).status, 0);
    const auto json = nlohmann::json::parse(bytes_of(dir_ / "a.png.json"));
    EXPECT_EQ(json["utc"], "2026-12-21T12:00:00Z");
    EXPECT_THAT(relevo({"run", path, "--resume", "--sidecar"}).err,
                HasSubstr("0 pictures in 0 s; 1 were there already"));
}

TEST_F(RunFiles, ResumeMakesThePairOfWhichAKillLeftOne) {
    const fs::path path =
        job("\"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"sweep\": [{\"cameras\": [{}, {\"fov\": "
            "20}, {\"fov\": 30}]}], \"output\": \"{camera}.png\"");
    ASSERT_EQ(relevo({"run", path.string(), "--sidecar"}).status, 0);
    const auto whole = files_in(dir_);
    fs::remove(dir_ / "1.png.json");
    fs::remove(dir_ / "2.png");
    const Result rest = relevo({"run", path.string(), "--resume", "--sidecar"});
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_THAT(rest.err, HasSubstr("relevo: 2 pictures in "));
    EXPECT_THAT(rest.err, HasSubstr("; 1 were there already\n"));
    EXPECT_TRUE(files_in(dir_) == whole);
    // What merely has a sidecar's name is not replaced.
    fs::remove(dir_ / "2.png");
    write("2.png.json", "{\"mine\": 1}");
    EXPECT_EQ(error(path, {"--resume", "--sidecar"}),
              fmt::format("run: {}: its sidecar is incomplete, the first of 1 that --resume "
                          "cannot keep; pass --overwrite to make it again",
                          (dir_ / "2.png").string()));
    EXPECT_EQ(bytes_of(dir_ / "2.png.json"), "{\"mine\": 1}");
}

TEST_F(RunFiles, NoPictureReplacesWhatAnotherIsMadeOf) {
    const std::string picture = "\"picture\": {\"size\": [64, 48]}, ";
    Raster plain;
    plain.columns = plain.rows = 20;
    write_raster(dir_ / "far.tif", plain);
    write("base.png.json", "{\"format\": 1, " + picture + "\"dem\": {\"files\": [\"" +
                               bundled_dem() + "\"]}, \"time\": {\"at\": \"2026-06-21T12:00Z\"}}");
    write("places.png.json",
          "{\"type\": \"FeatureCollection\", \"features\": [{\"type\": \"Feature\", "
          "\"properties\": {\"name\": \"places\"}, \"geometry\": {\"type\": \"Point\", "
          "\"coordinates\": [-84.28, 36.33]}}]}");
    write("look.png.json", "{\"set\": {\"haze.density\": 0.1}}");
    const auto refused = [&](const std::string& members, const std::string& what,
                             const std::string& name, const std::string& input) {
        const fs::path path = write(
            "job.json", "{\"format\": 1, \"scene\": \"base.png.json\", " + picture + members + "}");
        const auto before = files_in(dir_);
        EXPECT_EQ(error(path, {"--overwrite", "--sidecar"}),
                  fmt::format(
                      "run: {}: is {} {}, which would be overwritten; give the result another name",
                      (dir_ / name).string(), what, (dir_ / input).string()));
        EXPECT_TRUE(files_in(dir_) == before) << what;
    };
    refused("\"output\": \"base.png\"", "the scene", "base.png.json", "base.png.json");
    refused("\"sweep\": [{\"sites\": {\"file\": \"places.png.json\"}}], \"output\": \"{site}.png\"",
            "the sites", "places.png.json", "places.png.json");
    // Of another shot, drawn later.
    refused(
        "\"shots\": [{\"name\": \"look\"}, {\"name\": \"b\", \"effects\": {\"presets\": "
        "[\"look.png.json\"]}}], \"output\": \"{shot}.png\"",
        "the preset", "look.png.json", "look.png.json");
    refused(
        "\"shots\": [{\"name\": \"far\"}, {\"name\": \"b\", \"dem\": {\"files\": "
        "[\"far.tif\"]}}], \"output\": \"{shot}.tif\"",
        "the DEM", "far.tif", "far.tif");
    write_raster(dir_ / "laid.tif", plain);
    refused(
        "\"shots\": [{\"name\": \"laid\"}, {\"name\": \"b\", \"dem\": {\"files\": "
        "[\"far.tif\"]}, \"overlay\": {\"file\": \"laid.tif\"}}], \"output\": \"{shot}.tif\"",
        "the overlay", "laid.tif", "laid.tif");
    write("table.png.json", "0 0 0 0\n");
    refused(
        "\"shots\": [{\"name\": \"table\"}, {\"name\": \"b\", \"overlay\": {\"file\": "
        "\"laid.tif\", \"colours\": \"table.png.json\"}}], \"output\": \"{shot}.png\"",
        "the colours", "table.png.json", "table.png.json");
    refused(
        "\"shots\": [{\"name\": \"table\"}, {\"name\": \"b\", \"land_cover\": \"laid.tif\", "
        "\"land_cover_classes\": \"table.png.json\"}], \"output\": \"{shot}.png\"",
        "the classes", "table.png.json", "table.png.json");
    // By a link, and where another part of the job reads it.
    fs::create_symlink("laid.tif", dir_ / "link.tif");
    refused(
        "\"shots\": [{\"name\": \"link\"}, {\"name\": \"b\", \"dem\": {\"files\": "
        "[\"far.tif\"]}, \"overlay\": {\"file\": \"laid.tif\"}}], \"output\": \"{shot}.tif\"",
        "the overlay", "link.tif", "laid.tif");
}

TEST_F(RunFiles, TwoPicturesThatALinkMakesOneAreRefused) {
    fs::create_directories(dir_ / "one");
    fs::create_symlink("one", dir_ / "two");
    const std::string sweep =
        "\"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"sweep\": [{\"cameras\": [{\"name\": \"one\"},"
        "{\"name\": \"two\", \"fov\": 20}]}], ";
    const auto refused = [&](const fs::path& path, const char* a, const char* b, const char* is) {
        EXPECT_EQ(error(path, {"--overwrite"}),
                  fmt::format("run: {} and {}: a symbolic link makes them one file, {}; name them "
                              "apart",
                              (dir_ / a).string(), (dir_ / b).string(), (dir_ / is).string()));
    };
    refused(job(sweep + "\"output\": \"{camera}/a.png\""), "one/a.png", "two/a.png", "one/a.png");
    EXPECT_TRUE(fs::is_empty(dir_ / "one"));
    // Also where the file of one does not exist yet, and the link leads nowhere.
    fs::create_symlink("one.png", dir_ / "two.png");
    refused(job(sweep + "\"output\": \"{camera}.png\""), "one.png", "two.png", "one.png");
    EXPECT_FALSE(fs::exists(dir_ / "one.png"));
}

TEST_F(RunFiles, AJobOfManyDemsTakesTheMemoryOfOne) {
    Raster hills;
    hills.columns = hills.rows = 1400;
    hills.value = [](int column, int row, int) { return 500 + (column * 7 + row * 13) % 101; };
    write_raster(dir_ / "1.tif", hills);
    const auto peak_mib = [&](int dems) {
        std::string shots;
        for (int i = 1; i <= dems; ++i) {
            if (i > 1 && !fs::exists(dir_ / fmt::format("{}.tif", i)))
                fs::copy_file(dir_ / "1.tif", dir_ / fmt::format("{}.tif", i));
            shots +=
                fmt::format("{}{{\"dem\": {{\"files\": [\"{}.tif\"]}}}}", i > 1 ? ", " : "", i);
        }
        // The view is left open, so that heights of all are needed.
        const fs::path path =
            write("job.json",
                  "{\"format\": 1, \"picture\": {\"size\": [32, 24]}, \"time\": {\"at\": "
                  "\"2026-06-21T12:00Z\"}, \"effects\": {\"only\": []}, \"shots\": [" +
                      shots + "]}");
        const Measured dry = measured({"run", path.string(), "--dry-run"});
        EXPECT_EQ(dry.run.status, 0) << dry.run.err;
        return dry.peak_mib;
    };
    const int two = peak_mib(2), twelve = peak_mib(12);
    fmt::print("[ measured ] 2 DEMs {} MiB, 12 DEMs {} MiB\n", two, twelve);
    // Heights take 7.5 MiB a DEM and what is made of them as much again; 7.5 MiB of the file stay
    // in GDAL's cache of blocks, which has a limit of its own.
    EXPECT_LT(twelve - two, 10 * 11);
}

TEST_F(RunFiles, ASceneThatAJpegHasNoRoomForIsInTheFileBesideIt) {
    // As long as that of a DEM of 2,500 tiles; no stamp of it is shown.
    const std::string words(100'000, 'x');
    const std::string members =
        "\"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"camera\": {\"orbit\": {\"azimuth\": 180, "
        "\"elevation\": 35}}, \"stamps\": {\"title\": \"" +
        words + "\"}";
    const fs::path path = job(members + ", \"output\": \"a.jpg\"");
    const Result run = relevo({"run", path.string()});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err,
                HasSubstr(fmt::format(
                    "relevo: warning: {0}: the scene is too long for this format; it is in "
                    "{0}.json, keep both together\n",
                    (dir_ / "a.jpg").string())));
    EXPECT_FALSE(image::read_metadata(dir_ / "a.jpg").contains("relevo:scene"));
    EXPECT_THAT(relevo({"run", path.string(), "--resume"}).err,
                HasSubstr("0 pictures in 0 s; 1 were there already"));

    // It is found there, and makes the same picture again.
    const std::string a = (dir_ / "a.jpg").string(), again = (dir_ / "again.jpg").string();
    const Result from = relevo({"capture", "--from", a, "-o", again});
    ASSERT_EQ(from.status, 0) << from.err;
    EXPECT_TRUE(bytes_of(dir_ / "a.jpg") == bytes_of(dir_ / "again.jpg"));
    // A PNG has room for it.
    ASSERT_EQ(relevo({"capture", "--from", a, "-o", (dir_ / "a.png").string()}).status, 0);
    EXPECT_FALSE(fs::exists(dir_ / "a.png.json"));

    const auto refused = [&](const char* why) {
        expect_failure({"capture", "--from", a, "-o", (dir_ / "b.jpg").string()}, 3,
                       fmt::format("{0}: its scene is in {0}.json, which {1}; put the picture's "
                                   "own file there",
                                   a, why));
    };
    fs::rename(dir_ / "a.jpg.json", dir_ / "kept.json");
    refused("is missing");
    // Of one of the pair, as a kill may leave it, --resume makes both.
    const Result pair = relevo({"run", path.string(), "--resume"});
    EXPECT_EQ(pair.status, 0) << pair.err;
    EXPECT_TRUE(bytes_of(dir_ / "a.jpg.json") == bytes_of(dir_ / "kept.json"));
    write("a.jpg.json", "{}");
    refused("is not a sidecar");
    write("a.jpg.json", "{\"scene\": {\"format\": 1}}");
    refused("has another scene");
}

}  // namespace
}  // namespace relevo::test::test_run_files
