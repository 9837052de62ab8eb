#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "cli/job_fixture.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_run {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The files that a page of the documentation shows, by their names: ```json day.json.
std::map<std::string, std::string> files_shown(const char* page) {
    std::map<std::string, std::string> result;
    std::string name;
    for (const std::string& line : split(read_text(source_dir() / "docs" / page, "test"), '\n')) {
        if (line.starts_with("```")) {
            const std::size_t blank = line.find(' ');
            name = blank == std::string::npos ? "" : line.substr(blank + 1);
        } else if (!name.empty()) {
            result[name] += line + "\n";
        }
    }
    return result;
}

class Run : public JobTest {
  protected:
    /// Suns, cameras and effects in turns: much that one picture could leave to the next.
    fs::path mixed_job() const {
        return job(
            "\"time\": {\"at\": \"0:00\", \"date\": \"2026-06-21\"},\n"
            "\"sweep\": [{\"times\": {\"from\": \"8:00\", \"to\": \"19:00\", \"step\": "
            "\"5h30min\"}}, {\"cameras\": [{\"name\": \"far\"}, {\"name\": \"near\", "
            "\"eye\": [36.33, -84.28, 30], \"eye_above_ground\": true, \"heading\": 40}]},"
            "{\"effects\": [{\"name\": \"plain\"}, {\"name\": \"wet\", \"enable\": "
            "[\"wet\"]}]}],\n"
            "\"output\": \"out/{time:%H%M}_{camera}_{effects}.png\"");
    }
};

TEST_F(Run, TheExamplesOfTheDocumentationAreAsTheySay) {
    fs::copy_file(bundled_dem(), dir_ / "jacksboro.tif");
    std::map<std::string, std::string> shown = files_shown("jobs.md");
    for (const auto& [name, text] : shown)
        write(name, text);
    const std::map<std::string, std::size_t> counts{{"day.json", 96},
                                                    {"noons.json", 53},
                                                    {"first-lights.json", 53},
                                                    {"sites.json", 4},
                                                    {"effects.json", 9}};
    std::set<std::string> listed;
    for (const auto& [name, count] : counts) {
        ASSERT_TRUE(shown.contains(name)) << name;
        const std::string file = (dir_ / name).string();
        std::size_t lines = 0;
        for (const std::string& line : split(relevo({"-q", "run", file, "--dry-run"}).out, '\n'))
            if (!line.empty()) {
                listed.insert(line);
                ++lines;
            }
        EXPECT_EQ(lines, count) << name;
        // Many pictures of one sweep have the same to show: an eighth of them is made.
        const std::size_t parts = count > 10 ? 8 : 1;
        const Result run =
            relevo({"-q", "run", file, "--size", "48x32", "--shard", fmt::format("1/{}", parts)});
        EXPECT_EQ(run.status, 0) << name << ": " << run.err;
        EXPECT_EQ(run.err, "") << name;
        const fs::path folder = dir_ / name.substr(0, name.find('.'));
        const auto made = files_in(folder);
        EXPECT_GE(made.size(), count / parts) << name;
        for (const auto& [picture, bytes] : made)
            EXPECT_TRUE(listed.contains((folder / picture).string())) << picture;
    }
    for (const char* picture : {"day/0000.png", "day/2345.png", "noons/2026-12-31.png",
                                "sites/valley_east.png", "effects/core_haze0.02.png"})
        EXPECT_TRUE(listed.contains((dir_ / picture).string())) << picture;
    // What is switched is seen.
    EXPECT_NE(image::read(dir_ / "effects/dry_haze0.png").values,
              image::read(dir_ / "effects/dry_haze0.2.png").values);
    EXPECT_NE(image::read(dir_ / "effects/dry_haze0.png").values,
              image::read(dir_ / "effects/wet_haze0.png").values);
}

TEST_F(Run, PartsOfAJobAreTheSameBytesAsTheWhole) {
    const std::string path = mixed_job().string();
    ASSERT_EQ(relevo({"run", path}).status, 0);
    fs::rename(dir_ / "out", dir_ / "whole");
    const auto whole = files_in(dir_ / "whole");
    ASSERT_EQ(whole.size(), 12u);
    for (const char* shard : {"1/4", "2/4", "3/4"})
        ASSERT_EQ(relevo({"run", path, "--shard", shard}).status, 0) << shard;
    // The last one as a scheduler names it.
    const Result last =
        relevo({"run", path, "--shard", "array"},
               {"SLURM_ARRAY_TASK_ID=7", "SLURM_ARRAY_TASK_MIN=1", "SLURM_ARRAY_TASK_MAX=7",
                "SLURM_ARRAY_TASK_STEP=2", "SLURM_ARRAY_TASK_COUNT=4"});
    ASSERT_EQ(last.status, 0) << last.err;
    EXPECT_TRUE(files_in(dir_ / "out") == whole);

    // And what one picture carries makes it again by itself.
    for (const char* name : {"1330_near_wet.png", "1900_far_plain.png", "0800_near_plain.png"}) {
        const fs::path again = dir_ / ("again_" + std::string(name));
        const Result run =
            relevo({"capture", "--from", (dir_ / "whole" / name).string(), "-o", again.string()});
        ASSERT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(bytes_of(again), whole.at(name)) << name;
    }
}

TEST_F(Run, WhatEndsItLeavesWholePicturesAndResumeMakesTheRest) {
    const std::string path = mixed_job().string();
    ASSERT_EQ(relevo({"run", path}).status, 0);
    fs::rename(dir_ / "out", dir_ / "whole");
    const auto whole = files_in(dir_ / "whole");
    std::srand(16);
    for (int i = 0; i < 10; ++i) {
        const pid_t child = fork();
        if (child == 0) {
            const int nothing = open("/dev/null", O_WRONLY);
            dup2(nothing, STDERR_FILENO);
            execl((build_dir() / "bin/relevo").c_str(), "relevo", "run", path.c_str(), "--resume",
                  "--device", "software", nullptr);
            _exit(127);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(300 + std::rand() % 2500));
        kill(child, i % 3 == 0 ? SIGINT : SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        if (!fs::exists(dir_ / "out")) continue;
        for (const auto& [name, bytes] : files_in(dir_ / "out"))
            EXPECT_TRUE(whole.contains(name) && whole.at(name) == bytes) << name;
    }
    const Result rest = relevo({"run", path, "--resume"});
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_TRUE(files_in(dir_ / "out") == whole);
    const Result nothing = relevo({"run", path, "--resume"});
    EXPECT_THAT(nothing.err, HasSubstr("relevo: 0 pictures in 0 s; 12 were there already\n"));
}

TEST_F(Run, ResumeRefusesWhatIsNotTheSame) {
    const fs::path path = job("\"time\": {\"at\": \"2026-06-21T12:00\"}, \"output\": \"a.png\"");
    const std::string exists =
        fmt::format("run: {}: exists, the first of 1", (dir_ / "a.png").string());
    const auto other = [&](const char* why) {
        return fmt::format(
            "run: {}: {}, the first of 1 that --resume cannot keep; pass --overwrite "
            "to make it again",
            (dir_ / "a.png").string(), why);
    };
    ASSERT_EQ(relevo({"run", path.string()}).status, 0);
    EXPECT_EQ(error(path), exists +
                               "; pass --overwrite to replace it, or --resume to make what is "
                               "missing");
    EXPECT_EQ(error(path, {"--resume", "--exposure", "1"}), other("it shows another scene"));
    EXPECT_EQ(error(path, {"--resume", "--bits", "16"}),
              other("it has other bits, quality or layers"));
    const std::string whole = bytes_of(dir_ / "a.png");
    std::ofstream(dir_ / "a.png", std::ios::binary) << whole.substr(0, whole.size() - 200);
    EXPECT_EQ(error(path, {"--resume"}), other("it is not a complete picture"));
    EXPECT_EQ(relevo({"run", path.string(), "--resume", "--overwrite"}).status, 0);
    EXPECT_EQ(bytes_of(dir_ / "a.png"), whole);
}

TEST_F(Run, APictureThatCannotBeMadeIsToldOfAndTheRestGoOn) {
    const fs::path path = job(
        "\"time\": {\"at\": \"2026-06-21T12:00\"}, \"sweep\": [{\"cameras\": [{\"name\": \"a\"},"
        "{\"name\": \"off\", \"eye\": [46, 8]}, {\"name\": \"sky\", \"eye\": [36.33, -84.28, 9000],"
        "\"pitch\": 80}, {\"name\": \"b\", \"orbit\": {\"azimuth\": 10}}]}],"
        "\"output\": \"{camera}.png\"");
    const Result run = relevo({"run", path.string()});
    EXPECT_EQ(run.status, 5);
    EXPECT_THAT(run.err, HasSubstr(fmt::format("relevo: error: {}: --eye: 46.00000 N 8.00000 E: "
                                               "outside the DEM or in a void",
                                               (dir_ / "off.png").string())));
    EXPECT_THAT(run.err, HasSubstr(fmt::format("relevo: error: 1 picture shows only sky (first: "
                                               "{}); turn the camera or add --allow-blank\n",
                                               (dir_ / "sky.png").string())));
    EXPECT_THAT(run.err, testing::EndsWith(fmt::format(
                             "relevo: error: run: 2 of 4 pictures could not be made, the first is "
                             "{}; --resume tries them again\n",
                             (dir_ / "off.png").string())));
    EXPECT_TRUE(fs::exists(dir_ / "a.png"));
    EXPECT_TRUE(fs::exists(dir_ / "b.png"));
    EXPECT_FALSE(fs::exists(dir_ / "off.png"));
    EXPECT_FALSE(fs::exists(dir_ / "sky.png"));
    EXPECT_EQ(relevo({"-q", "run", path.string(), "--resume", "--allow-blank"}).status, 5);
    EXPECT_TRUE(fs::exists(dir_ / "sky.png"));
}

TEST_F(Run, BadJobsSayWhatIsWrong) {
    const std::string at = "\"time\": {\"at\": \"2026-06-21T12:00Z\"}";
    const std::string file = (dir_ / "job.json").string();
    EXPECT_EQ(error(write("job.json", "{\"format\": 1,\n oops}")),
              "job: " + file +
                  ":2: syntax error while parsing object key - invalid literal; last read: "
                  "'1,<U+000A> o'; expected string literal");
    EXPECT_EQ(
        error(job("\"exaggeration\": \"high\"")),
        "job: " + file + ":2: exaggeration: expected a number in [0.01, 1000] but got \"high\"");
    EXPECT_EQ(error(job("\"swep\": []")),
              "job: " + file + ":2: swep: no such key; did you mean \"sweep\"?");
    EXPECT_EQ(error(job(at + ", \"effects\": {\"enable\": [\"hase\"]}, \"output\": \"a.png\"")),
              (dir_ / "a.png").string() + ": effects: hase: no such plugin; did you mean haze?");
    EXPECT_EQ(
        error(write("job.json", "{\"format\": 1, \"dem\": {\"files\": [\"no.tif\"]}," + at + "}")),
        fmt::format("{}: no such file", (dir_ / "no.tif").string()));
    EXPECT_EQ(error(job("\"sweep\": [{\"cameras\": []}]")),
              "job: " + file + ":2: sweep[0].cameras: expected values but the list is empty");
    EXPECT_EQ(error(job(at + ", \"sweep\": [{\"set\": \"haze.density\", \"from\": 0, \"to\": 1, "
                             "\"step\": 1e-6}]")),
              "job: " + file + ":2: sweep[0].step: expected at most 1000000 values");
    EXPECT_EQ(error(job(at + ", \"sweep\": [{\"set\": \"haze.density\", \"from\": 1, \"to\": 1000, "
                             "\"step\": 1}, {\"set\": \"sky.stars\", \"from\": 1, \"to\": 1000, "
                             "\"step\": 1}]")),
              "job: " + file +
                  ": the job has 1000000 pictures, more than 100000; add --yes to allow them");
    EXPECT_EQ(error(job(at + ", \"sweep\": [{\"cameras\": [{}, {}]}], \"output\": \"a.png\"")),
              fmt::format("job: {}:2: output: \"a.png\" names {} twice, for pictures 1 and 2; add "
                          "{{n}} or another field that differs",
                          file, (dir_ / "a.png").string()));
    write("file", "");
    EXPECT_EQ(error(job(at + ", \"output\": \"file/a.png\"")),
              fmt::format("run: {}: the folder cannot be made, Not a directory",
                          (dir_ / "file").string()));
    EXPECT_EQ(error(job(at + ", \"output\": \"a.bmp\"")),
              fmt::format("image: {}: unknown picture format; use png, jpg, webp, avif, tif or exr",
                          (dir_ / "a.bmp").string()));
    EXPECT_EQ(error(job(at + ", \"output\": \"{dem}.tif\""), {"-o", bundled_dem()}),
              fmt::format("run: {0}: is the DEM {0}, which would be overwritten; give the result "
                          "another name",
                          bundled_dem()));
    EXPECT_EQ(error(job(at + ", \"output\": \"a.png\""), {"-o", ""}, 2),
              "--output: expected a value but got \"\"; is a shell variable unset? See relevo run "
              "--help");
    EXPECT_EQ(error(job(at + ", \"output\": \"a.png\""), {"--shard", "array"}, 2),
              "--shard: array: expected a task of an array of Slurm, PBS, LSF, Grid Engine or AWS "
              "Batch, but none of their variables is set; write --shard I/N");
    EXPECT_EQ(error(job(at + ", \"output\": \"a.png\""), {"--shard", "5/4"}, 2),
              "--shard: 5/4: expected I/N with I from 1 to N, array, or array/N");
}

TEST_F(Run, ADiskThatIsFullFailsThePicturesThatDoNotFit) {
    const fs::path path =
        job("\"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"sweep\": [{\"cameras\": "
            "[{}, {\"fov\": 60}]}], \"output\": \"{camera}.png\"");
    // A file may have 4 KiB.
    const Result run =
        test::run("/bin/sh", {"-c", "ulimit -f 8; exec \"$0\" -q run \"$1\" --device software",
                              (build_dir() / "bin/relevo").string(), path.string()});
    EXPECT_EQ(run.status, 5);
    EXPECT_THAT(run.err, HasSubstr(fmt::format("relevo: error: {0}: run: {0}: cannot be written, "
                                               "File too large\n",
                                               (dir_ / "1.png").string())));
    EXPECT_FALSE(fs::exists(dir_ / "1.png"));
    EXPECT_FALSE(fs::exists(dir_ / "2.png"));
}

TEST_F(Run, ASmallDiskThatIsFullHasWholePicturesAndNoOthers) {
    const fs::path disk = dir_ / "disk";
    fs::create_directory(disk);
    const std::string mount = "mount -t tmpfs -o size=24k none \"$1\" && ";
    if (test::run("/usr/bin/unshare", {"-rm", "/bin/sh", "-c", mount + "true", "sh", disk.string()})
            .status != 0)
        GTEST_SKIP() << "a file system of its own cannot be mounted here";
    const fs::path path =
        job("\"time\": {\"at\": \"2026-06-21T16:00Z\"}, \"sweep\": [{\"set\": \"haze.density\", "
            "\"from\": 0, \"to\": 0.2, \"step\": 0.02}], \"output\": \"disk/{n}.png\"");
    fs::create_directory(dir_ / "kept");
    const Result run =
        test::run("/usr/bin/unshare", {"-rm", "/bin/sh", "-c",
                                       mount + "\"$2\" -q run \"$3\" --device software; status=$?; "
                                               "cp -a \"$1\"/. \"$4\" && exit $status",
                                       "sh", disk.string(), (build_dir() / "bin/relevo").string(),
                                       path.string(), (dir_ / "kept").string()});
    EXPECT_EQ(run.status, 5) << run.err;
    EXPECT_THAT(run.err, HasSubstr("cannot be written, No space left on device\n"));
    ASSERT_EQ(relevo({"-q", "run", path.string()}).status, 0);
    const auto whole = files_in(disk), kept = files_in(dir_ / "kept");
    EXPECT_GT(kept.size(), 0u);
    EXPECT_LT(kept.size(), whole.size());
    for (const auto& [name, bytes] : kept)
        EXPECT_TRUE(whole.contains(name) && whole.at(name) == bytes) << name;
}

TEST_F(Run, ShardsOfAllSchedulersAreThoseOfTheirArrays) {
    const fs::path path =
        job("\"time\": {\"at\": \"2026-06-21T12:00Z\"}, \"sweep\": [{\"set\": \"haze.density\", "
            "\"values\": [0, 1, 2]}], \"output\": \"{haze.density}.png\"");
    const auto listed = [&](const std::string& shard, const std::vector<std::string>& variables) {
        const Result run = relevo(
            {"-q", "run", path.string(), "--dry-run", "--only", "", "--shard", shard}, variables);
        return run.status == 0 ? fs::path(run.out.substr(0, run.out.find('\n'))).filename().string()
                               : run.err;
    };
    EXPECT_EQ(listed("array", {"AWS_BATCH_JOB_ARRAY_INDEX=0", "AWS_BATCH_JOB_ARRAY_SIZE=3"}),
              "0.png");
    EXPECT_EQ(listed("array/3", {"PBS_ARRAY_INDEX=2"}), "1.png");
    EXPECT_EQ(listed("array", {"LSB_JOBINDEX=3", "LSB_JOBINDEX_END=3", "LSB_JOBINDEX_STEP=1"}),
              "2.png");
    EXPECT_EQ(listed("array", {"SGE_TASK_ID=5", "SGE_TASK_FIRST=3", "SGE_TASK_LAST=7",
                               "SGE_TASK_STEPSIZE=2"}),
              "1.png");
    EXPECT_EQ(listed("array", {"PBS_ARRAY_INDEX=2"}),
              "relevo: error: --shard: array: PBS does not say how many tasks its array has; write "
              "array/N\n");
    EXPECT_EQ(
        listed("array",
               {"SLURM_ARRAY_TASK_ID=9", "SLURM_ARRAY_TASK_MIN=1", "SLURM_ARRAY_TASK_MAX=9",
                "SLURM_ARRAY_TASK_STEP=1", "SLURM_ARRAY_TASK_COUNT=3"}),
        "relevo: error: --shard: array: expected tasks of Slurm in equal steps from 1 on, 3 of "
        "them, but this is task 9; write --shard I/N\n");
}

TEST_F(Run, ASidecarSaysWhatThePictureWasMadeOf) {
    const fs::path path =
        job("\"time\": {\"at\": \"2026-06-21T16:00Z\"}, \"effects\": {\"only\": "
            "[\"haze\"]}, \"output\": \"a.png\"");
    ASSERT_EQ(relevo({"run", path.string(), "--sidecar"}).status, 0);
    const nlohmann::json json = nlohmann::json::parse(bytes_of(dir_ / "a.png.json"));
    EXPECT_EQ(json["picture"], "a.png");
    EXPECT_EQ(json["utc"], "2026-06-21T16:00:00Z");
    EXPECT_EQ(json["effects"], nlohmann::json::array({"haze", "sky"}));
    const Result sha = test::run("/usr/bin/sha256sum", {bundled_dem()});
    EXPECT_EQ(json["dem"]["files"][0]["sha256"], sha.out.substr(0, 64));
    const nlohmann::json sun =
        nlohmann::json::parse(relevo({"sun", "position", "--at",
                                      fmt::format("{},{}", json["sun"]["lat_deg"].get<double>(),
                                                  json["sun"]["lon_deg"].get<double>()),
                                      "--time", "2026-06-21T16:00Z", "--json"})
                                  .out);
    EXPECT_NEAR(json["sun"]["azimuth_deg"], sun["azimuth_deg"], 1e-6);
    EXPECT_EQ(
        json["scene"].dump(),
        nlohmann::json::parse(image::read_metadata(dir_ / "a.png").at("relevo:scene")).dump());
}

TEST_F(Run, AnAuditSaysInTheSidecarWhetherShadowsAreThoseOfTheFigures) {
    const fs::path path =
        job("\"time\": {\"at\": \"2026-06-21T11:00Z\"}, \"sweep\": [{\"effects\": [{\"name\": "
            "\"with\"}, {\"name\": \"without\", \"disable\": [\"shadows\"]}]}],"
            "\"output\": \"{effects}.png\"");
    ASSERT_EQ(relevo({"run", path.string(), "--size", "400x320", "--sidecar"}).status, 0);
    const std::map<std::string, std::string> before = files_in(dir_);
    // Sidecars that say less than is asked for are not whole.
    const std::vector<std::string> resume{"run",     path.string(), "--size",
                                          "400x320", "--resume",    "--audit"};
    const Result refused = relevo(resume);
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err,
                HasSubstr(fmt::format("{}: its sidecar has no audit, the first of 2 that --resume "
                                      "cannot keep; pass --overwrite to make them again\n",
                                      (dir_ / "with.png").string())));
    std::vector<std::string> replace = resume;
    replace.push_back("--overwrite");
    const Result run = relevo(replace);
    ASSERT_EQ(run.status, 0) << run.err;
    const auto audit_of = [&](const char* name) {
        return nlohmann::json::parse(bytes_of(dir_ / name))["audit"];
    };
    const nlohmann::json with = audit_of("with.png.json"), without = audit_of("without.png.json");
    EXPECT_EQ(with["provider"], "shadows");
    EXPECT_GE(with["agreement"], 0.99);
    EXPECT_GE(with["balanced_accuracy"], 0.99);
    EXPECT_GT(with["pixels"], 10000);
    EXPECT_TRUE(without["provider"].is_null());
    EXPECT_LT(without["agreement"], 0.85);
    EXPECT_EQ(without["balanced_accuracy"], 0.5);
    EXPECT_THAT(run.err, HasSubstr(fmt::format(
                             "relevo: audit: no active effect draws shadows; a fully lit DEM "
                             "agrees with the CPU sweep on {:.2f} % of {} pixels that show a post, "
                             "balanced 50.00 %; the worst of 2, {}\n",
                             100 * without["agreement"].get<double>(), without["pixels"].get<int>(),
                             (dir_ / "without.png").string())));
    // The pictures are as without it, and so is what one capture says.
    for (const char* name : {"with.png", "without.png"})
        EXPECT_TRUE(bytes_of(dir_ / name) == before.at(name)) << name;
    const Result again = relevo({"capture", "--from", (dir_ / "with.png").string(), "-o",
                                 (dir_ / "again.png").string(), "--audit"});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(audit_of("again.png.json"), with);
    EXPECT_THAT(again.err, HasSubstr(fmt::format(
                               "relevo: audit: shadows agrees with the CPU sweep on {:.2f} %",
                               100 * with["agreement"].get<double>())));
    expect_failure(
        {"capture", bundled_dem(), "-o", (dir_ / "ab.png").string(), "--audit", "--ab", "shadows"},
        2, "--audit: cannot audit a comparison; remove --ab");
    EXPECT_THAT(relevo(resume).err, HasSubstr("relevo: 0 pictures in 0 s; 2 were there already\n"));
}

TEST_F(Run, ADryRunSaysWhatWouldHappenAndTouchesNothing) {
    const fs::path path =
        job("\"time\": {\"at\": \"2026-06-21T16:00Z\"}, \"sweep\": [{\"cameras\": [{\"name\": "
            "\"a\"}, {\"name\": \"b\", \"fov\": 20}]}], \"output\": \"out/{camera}.png\"");
    const std::string a = (dir_ / "out/a.png").string(), b = (dir_ / "out/b.png").string();
    const auto dry = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"run", path.string(), "--dry-run"});
        Result result = relevo(more);
        EXPECT_EQ(result.status, 0) << result.err;
        return result;
    };
    EXPECT_EQ(dry({}).out, a + "\n" + b + "\n");
    EXPECT_FALSE(fs::exists(dir_ / "out"));
    ASSERT_EQ(relevo({"run", path.string()}).status, 0);
    fs::remove(b);
    std::ofstream(b) << "mine";
    const auto before = files_in(dir_);
    const Result refused = dry({});
    EXPECT_EQ(refused.out, a + "\n" + b + "\n");
    EXPECT_THAT(refused.err, HasSubstr(fmt::format(
                                 "relevo: warning: would be refused: run: {}: exists, the first of "
                                 "2; pass --overwrite to replace them, or --resume to make what is "
                                 "missing\n",
                                 a)));
    EXPECT_THAT(dry({"--overwrite"}).err, HasSubstr("; 2 are replaced\n"));
    const Result resumed = dry({"--resume"});
    EXPECT_EQ(resumed.out, b + "\n");
    EXPECT_THAT(resumed.err, HasSubstr("; 1 are there already and stay\n"));
    EXPECT_THAT(resumed.err, HasSubstr(fmt::format(
                                 "would be refused: run: {}: it is not a complete picture, the "
                                 "first of 1 that --resume cannot keep",
                                 b)));
    EXPECT_THAT(dry({"-o", (dir_ / "job.json/{camera}.png").string()}).err,
                HasSubstr(fmt::format("would be refused: run: {}: no file can be made in it, Not a "
                                      "directory\n",
                                      path.string())));
    // In the working folder, too.
    EXPECT_EQ(dry({"-o", "relevo_dry_run_{camera}.png"}).out,
              "relevo_dry_run_a.png\nrelevo_dry_run_b.png\n");
    EXPECT_TRUE(files_in(dir_) == before);
}

TEST_F(Run, EffectsAreThoseOfACaptureWhateverTheDemHas) {
    // The sea is on where a DEM has water, and a plain that rises has none.
    Raster plain;
    plain.columns = plain.rows = 60;
    write_raster(dir_ / "plain.tif", plain);
    const std::string members =
        "\"format\": 1, \"dem\": {\"files\": [\"plain.tif\"]}, \"picture\": {\"size\": [64, 48]}, "
        "\"time\": {\"at\": \"2026-06-21T16:00Z\"}, \"effects\": {\"set\": {\"sea.level_m\": 400}},"
        "\"camera\": {\"orbit\": {\"azimuth\": 180, \"elevation\": 30}}";
    const fs::path file = write("job.json", "{" + members + ", \"output\": \"run.png\"}"),
                   scene = write("scene.json", "{" + members + "}");
    const Result run = relevo({"run", file.string(), "--sidecar"});
    ASSERT_EQ(run.status, 0) << run.err;
    const Result capture = relevo(
        {"capture", "--scene", scene.string(), "-o", (dir_ / "capture.png").string(), "--sidecar"});
    ASSERT_EQ(capture.status, 0) << capture.err;
    EXPECT_TRUE(bytes_of(dir_ / "run.png") == bytes_of(dir_ / "capture.png"));
    const auto effects_of = [&](const char* name) {
        return nlohmann::json::parse(bytes_of(dir_ / name))["effects"].dump();
    };
    EXPECT_EQ(effects_of("run.png.json"), effects_of("capture.png.json"));
    EXPECT_EQ(effects_of("run.png.json").find("sea"), std::string::npos);
}

TEST_F(Run, ScenesThatAreSavedAreAsTheSchemaHasThem) {
    const Result hours = relevo({"-q", "sun", "sky-view", bundled_dem(), "-o",
                                 (dir_ / "sky.tif").string(), "--directions", "8"});
    ASSERT_EQ(hours.status, 0) << hours.err;
    Raster plain;
    plain.columns = plain.rows = 20;
    write_raster(dir_ / "west.tif", plain);
    plain.geotransform = {{500600, 30, 0, 5200000, 0, -30}};
    write_raster(dir_ / "east.tif", plain);
    const std::string dem = bundled_dem(), west = (dir_ / "west.tif").string(),
                      east = (dir_ / "east.tif").string();
    const std::vector<std::vector<std::string>> all{
        {dem},
        {dem, "--time", "sunset-1h", "--date", "2026-10-01", "--tz", "solar"},
        {dem, "--time", "2026-06-21T08:00", "--tz", "Europe/Zurich", "--enable", "wet", "--disable",
         "haze", "--preset", "paper", "--set", "sky.stars=3", "--exposure", "1.5"},
        {dem, "--only", "", "--refraction", "saemundsson", "--exaggerate", "2", "--holes", "mark"},
        {dem, "--eye", "36.33,-84.28,30agl", "--heading", "350", "--pitch=-5", "--fov", "60"},
        {dem, "--eye", "36.33,-84.28", "--look-at", "36.36,-84.23,100agl", "--focal-length", "35"},
        {dem, "--view", "top"},
        {dem, "--overlay", (dir_ / "sky.tif").string(), "--overlay-range", "0.5,1",
         "--overlay-opacity", "0.5", "--overlay-title", "sky", "--overlay-colours", "viridis"},
        {west, east, "--unit", "ft", "--nodata", "none", "--memory", "100", "--pixel-error", "1"},
        {west, "--crs", "EPSG:32632", "--band", "1", "--nodata", "-5"},
    };
    std::vector<std::string> files{(source_dir() / "tests/check_schema.py").string(),
                                   source_dir().string()};
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::vector<std::string> arguments = all[i];
        files.push_back((dir_ / fmt::format("{}.json", i)).string());
        arguments.insert(arguments.begin(), {"-q", "capture"});
        for (const std::string& more :
             {std::string("-o"), (dir_ / fmt::format("{}.png", i)).string(),
              std::string("--save-scene"), files.back(), std::string("--size"),
              std::string("40x30"), std::string("--allow-blank")})
            arguments.push_back(more);
        const Result saved = relevo(arguments);
        ASSERT_EQ(saved.status, 0) << i << ": " << saved.err;
        // What pictures carry is a scene as well.
        files.push_back((dir_ / fmt::format("{}_carried.json", i)).string());
        std::ofstream(files.back())
            << image::read_metadata(dir_ / fmt::format("{}.png", i)).at("relevo:scene");
    }
    const Result checked = test::run("/usr/bin/python3", files);
    EXPECT_EQ(checked.status, 0);
    EXPECT_EQ(checked.out, "");
    EXPECT_EQ(checked.err, "");
}

TEST_F(Run, PicturesOfEveryFormatAreMadeAgainByteForByte) {
    for (const char* ending : {"png", "jpg", "webp", "tif", "exr"}) {
        const fs::path first = dir_ / (std::string("a.") + ending),
                       again = dir_ / (std::string("b.") + ending);
        const Result one = relevo({"-q", "capture", bundled_dem(), "-o", first.string(), "--size",
                                   "64x48", "--time", "sunset-30min", "--date", "2026-06-21",
                                   "--ab", "haze", "--set", "haze.density=0.7", "--fov", "33.3"});
        ASSERT_EQ(one.status, 0) << one.err;
        // TIFF and EXR said when they were written, to the second.
        std::this_thread::sleep_for(std::chrono::milliseconds(1100));
        const Result two =
            relevo({"-q", "capture", "--from", first.string(), "-o", again.string()});
        ASSERT_EQ(two.status, 0) << two.err;
        EXPECT_TRUE(bytes_of(first) == bytes_of(again)) << ending;
        EXPECT_EQ(image::read_metadata(first).at("relevo:compared"), "haze") << ending;
    }
    image::write(dir_ / "plain.png", image::Image8(4, 4, 3));
    expect_failure(
        {"capture", "--from", (dir_ / "plain.png").string(), "-o", (dir_ / "c.png").string()}, 3,
        fmt::format("--from: {}: contains no scene; expected a picture of relevo capture or run "
                    "with its metadata",
                    (dir_ / "plain.png").string()));
}

TEST_F(Run, CompareTellsPicturesApart) {
    image::Image8 a(4, 2, 3), b(4, 2, 3);
    b.values[5] = 3;
    const fs::path first = dir_ / "a.png", second = dir_ / "b.png";
    image::write(first, a);
    image::write(second, b);
    const Result same = relevo({"compare", first.string(), first.string()});
    EXPECT_EQ(same.status, 0);
    EXPECT_EQ(same.out, "same: worst 0/255, mean 0, 0 of 24 values beyond 0\n");
    const Result apart =
        relevo({"compare", first.string(), second.string(), "-o", (dir_ / "d.png").string()});
    EXPECT_EQ(apart.status, 6);
    EXPECT_EQ(apart.out, "different: worst 3/255, mean 0.125, 1 of 24 values beyond 0\n");
    EXPECT_EQ(apart.err,
              fmt::format("relevo: error: compare: {}, {}: they differ, by 3/255 at worst, "
                          "expected at most 0\n",
                          first.string(), second.string()));
    EXPECT_EQ(image::read(dir_ / "d.png").values[5], 255);
    EXPECT_EQ(relevo({"compare", first.string(), second.string(), "--tolerance", "3"}).status, 0);
    EXPECT_EQ(relevo({"compare", first.string(), second.string(), "--tolerance", "2"}).status, 6);
    image::write(dir_ / "c.png", image::Image8(3, 2, 3));
    EXPECT_EQ(relevo({"compare", first.string(), (dir_ / "c.png").string()}).status, 6);
}

}  // namespace
}  // namespace relevo::test::test_run
