// What is read is not replaced, nothing appears beside it, and no file names a result outside of
// its folder.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_kept_files {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class KeptFiles : public testing::Test {
  protected:
    KeptFiles() { fs::copy(source_dir() / "tests/data/own", dir_, fs::copy_options::recursive); }

    std::string path(const std::string& name) const { return (dir_ / name).string(); }
    std::size_t count() const {
        return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(dir_), {}));
    }
    std::string written(const std::string& name, const json& text) const {
        std::ofstream(path(name)) << text.dump(1);
        return path(name);
    }

    fs::path dir_ = scratch_dir("kept");
};

TEST_F(KeptFiles, NoInputIsReplacedWhicheverOptionNamesIt) {
    struct Case {
        std::string file;
        std::vector<std::string> options;
    };
    // Each under a name that a picture may have.
    for (const auto& [file, options] : std::vector<Case>{
             {"metar.txt", {"--weather"}},
             {"cover.tif", {"--land-cover-classes", path("classes.txt"), "--land-cover"}},
             {"classes.txt", {"--land-cover", path("cover.tif"), "--land-cover-classes"}},
             {"slope.tif", {"--overlay"}},
             {"colours.txt", {"--overlay", path("slope.tif"), "--overlay-colours"}},
             {"look.json", {"--preset"}},
             {"scene_plain.json", {"--scene"}}}) {
        const bool is_json = file.ends_with(".json");
        const std::string input = path(is_json ? file : file + ".png"), link = path("link.png");
        if (!is_json) fs::copy_file(path(file), input);
        fs::remove(link);
        fs::create_symlink(input, link);
        const std::string before = read_text(input, "test");
        for (const std::string& output :
             {input, dir_.string() + "/./" + fs::path(input).filename().string(), link}) {
            std::vector<std::string> words{"-q",     "capture", path("d.tif"),
                                           "--size", "16x16",   "--overwrite"};
            words.insert(words.end(), options.begin(), options.end());
            words.push_back(input);
            if (is_json)  // the ending would be refused first
                words.insert(words.end(), {"--timings", output, "-o", path("a.png")});
            else
                words.insert(words.end(), {"-o", output});
            const Result run = relevo(words);
            EXPECT_EQ(run.status, 3) << file << ": " << run.err;
            EXPECT_THAT(run.err, HasSubstr("which would be overwritten")) << file;
            EXPECT_TRUE(read_text(input, "test") == before) << file;
        }
    }
}

TEST_F(KeptFiles, NothingAppearsBesideACompressedFile) {
    fs::copy(source_dir() / "tests/data/cases/trust/F2.asc.gz", path("dem.asc.gz"));
    const std::size_t before = count();
    const Result run = relevo({"info", path("dem.asc.gz"), "--crs", "EPSG:32632"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(count(), before);
}

TEST_F(KeptFiles, AJobsOutputStaysBelowItsFolder) {
    const json shot = {{"format", 1},
                       {"dem", {{"files", {"d.tif"}}}},
                       {"time", {{"at", "2026-06-21T14:00Z"}}},
                       {"picture", {{"size", {16, 16}}}}};
    fs::create_directory(path("in"));
    fs::create_directory(path("out"));
    fs::create_directory_symlink(path("out"), path("in/link"));
    fs::copy_file(path("d.tif"), path("in/d.tif"));
    for (const std::string& output :
         {std::string("../out/a.png"), path("out/a.png"), std::string("link/a.png"),
          std::string("/vsis3/bucket/a.png")}) {
        json job = shot;
        job["output"] = output;
        const std::string file = written("in/job.json", job);
        const Result run = relevo({"-q", "run", file});
        EXPECT_EQ(run.status, 3) << output;
        EXPECT_THAT(run.err, HasSubstr("which is not below the job's own folder; name it with -o, "
                                       "or add --trust\n"))
            << output;
    }
    EXPECT_TRUE(fs::is_empty(path("out")));
    json inside = shot;
    inside["output"] = path("in/a.png");  // the whole name of a file of its folder
    EXPECT_EQ(relevo({"-q", "run", written("in/inside.json", inside)}).status, 0);
    EXPECT_TRUE(fs::exists(path("in/a.png")));
    EXPECT_EQ(relevo({"-q", "run", path("in/job.json"), "-o", path("out/a.png")}).status, 0);
    EXPECT_TRUE(fs::exists(path("out/a.png")));
}

TEST_F(KeptFiles, APlanNamesFilesOfItsOwnFolder) {
    fs::copy(source_dir() / "tests/data/cases/trust/F6_plan.json", path("plan.json"));
    json plan = json::parse(read_text(path("plan.json"), "test"));
    for (const std::string name :
         {"/vsicurl/http://127.0.0.1:1/a.tif", "../a.tif", "/tmp/a.tif", "a/b.tif", "a.vrt", ""}) {
        plan["tiles"][0][0] = name;
        written("plan.json", plan);
        expect_failure({"merge", dir_.string()}, 3,
                       fmt::format("plan: {}: a tile has the name \"{}\", expected that of a file "
                                   "of its folder; use another folder",
                                   path("plan.json"), name));
    }
    // A link to a file of another folder is no tile.
    fs::create_directory(path("tiles"));
    const std::vector<std::string> hours{"-q",      "sun",        "hours",  path("d.tif"),
                                         "--date",  "2026-06-21", "--step", "1h",
                                         "--tiles", "64",         "-o",     path("tiles")};
    ASSERT_EQ(relevo(hours).status, 0);
    const std::string tile = path("tiles/r0001_c0001.tif");
    fs::rename(tile, path("elsewhere.tif"));
    fs::create_symlink(path("elsewhere.tif"), tile);
    const Result merged = relevo({"merge", path("tiles")});
    EXPECT_EQ(merged.status, 1);
    EXPECT_THAT(merged.err, HasSubstr("is a link to a file of another folder"));
}

TEST_F(KeptFiles, TheTextOfARefusedFileIsNotPrinted) {
    std::ofstream(path("secret")) << "hunter2:x:0:0\nSECRET hunter2\n";
    json scene = json::parse(read_text(path("scene_plain.json"), "test"));
    const auto expect_untold = [&](const char* key, const json& value) {
        json changed = scene;
        changed[key] = value;
        const Result run = relevo(
            {"capture", "--scene", written("s.json", changed), "-o", path("a.png"), "--overwrite"});
        EXPECT_NE(run.status, 0) << key;
        EXPECT_THAT(run.err + run.out, Not(HasSubstr("hunter2"))) << key;
    };
    expect_untold("weather", "secret");
    expect_untold("land_cover", "secret");
    expect_untold("overlay", {{"file", "slope.tif"}, {"colours", "./secret"}});
    expect_untold("effects", {{"presets", {"./secret"}}});
    for (const std::string file : {"grade.lut", "drape.file", "tracks.file", "labels.file"})
        expect_untold("effects",
                      {{"enable", {file.substr(0, file.find('.'))}}, {"set", {{file, "secret"}}}});
    scene["land_cover"] = "cover.tif";
    expect_untold("land_cover_classes", "./secret");
}

TEST_F(KeptFiles, WithoutMemoryForThreadsARasterIsMadeOrRefused) {
    const std::string command = fmt::format(
        "ulimit -v 200000; exec timeout 60 '{}' -q sun hours '{}' --date 2026-06-21 --step 1h -o "
        "'{}'",
        (build_dir() / "bin/relevo").string(), path("d.tif"), path("hours.tif"));
    const Result run = test::run("/bin/bash", {"-c", command});
    EXPECT_THAT(run.status, testing::AnyOf(0, 1)) << run.err;  // 124: it waits for ever
    EXPECT_EQ(fs::exists(path("hours.tif")), run.status == 0);
}

TEST_F(KeptFiles, JobsOfOnesOwnAreDrawn) {
    for (const std::string job : {"job_times.json", "job_shots.json"})
        EXPECT_EQ(relevo({"-q", "run", path(job)}).err, "");
    for (const std::string picture :
         {"out_1.png", "out_2.png", "pictures/plain.png", "pictures/cover.png"})
        EXPECT_TRUE(fs::exists(path(picture))) << picture;
}

}  // namespace
}  // namespace relevo::test::test_kept_files
