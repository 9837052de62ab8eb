#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "cli/job_fixture.h"
#include "film/decoded_film.h"
#include "image/image.h"

namespace relevo::test::test_film {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FilmJob : public JobTest {
  protected:
    /// A morning in `frames` frames.
    fs::path morning(int frames, const std::string& output = "day.mp4",
                     const std::string& more = "") const {
        return job(
            fmt::format("\"time\": {{\"at\": \"12:00\", \"date\": \"2026-06-21\"}}, \"sweep\": "
                        "[{{\"times\": {{\"from\": \"sunrise\", \"to\": \"noon\", \"frames\": "
                        "{}}}}}],{}\n\"output\": \"{}\"",
                        frames, more, output));
    }
};

TEST_F(FilmJob, HasTheFramesThatItsPicturesHave) {
    const fs::path job = morning(20);
    const Result run = relevo({"run", job.string(), "--size", "320x180"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err,
                testing::ContainsRegex("day.mp4: 20 frames, 0.667 s, 0.[0-9] MB, made in"));
    const Result pictures = relevo({"-q", "run", job.string(), "--size", "320x180", "-o",
                                    (dir_ / "frames/{n:02}.png").string()});
    ASSERT_EQ(pictures.status, 0) << pictures.err;
    const DecodedFilm film = decode_film(dir_ / "day.mp4");
    ASSERT_EQ(film.times_s.size(), 20u);
    EXPECT_EQ(film.matrix, "bt709");
    EXPECT_EQ(film.range, "tv");
    for (std::size_t i = 0; i < 20; ++i) {
        const image::Image8 picture = image::read(dir_ / fmt::format("frames/{:02}.png", i + 1));
        EXPECT_GT(image::compare(film.frames[i], picture).psnr_db, 33) << i;
        double made = 0, given = 0;
        for (std::size_t k = 0; k < picture.values.size(); ++k) {
            made += film.frames[i].values[k];
            given += picture.values[k];
        }
        const auto count = static_cast<double>(picture.values.size());
        EXPECT_NEAR(made / count, given / count, 0.6) << i;
    }
    const nlohmann::json record = nlohmann::json::parse(film.comment);
    EXPECT_EQ(record["relevo:job"]["sweep"][0]["times"]["frames"], 20);
    EXPECT_EQ(record["relevo:job"]["dem"]["files"][0], bundled_dem());
}

TEST_F(FilmJob, MakesPanoramasAndAnaglyphsAsPicturesAndAsAFilm) {
    for (const std::string camera :
         {R"("eye": [36.33, -84.25, 700], "panorama": "equirectangular")",
          R"("eye": [36.33, -84.25, 700], "panorama": "cylindrical")", R"("stereo": "anaglyph")"}) {
        const fs::path job =
            this->job("\"camera\": {" + camera +
                      "}, \"time\": {\"at\": \"2026-06-21T10:00\"}, \"sweep\": [{\"set\": "
                      "\"haze.density\", \"from\": 0.1, \"to\": 0.3, \"frames\": 2}]");
        for (const char* const output : {"a.mp4", "{n}.png"}) {
            const Result run = relevo({"-q", "run", job.string(), "--size", "64x32", "--overwrite",
                                       "-o", (dir_ / output).string()});
            EXPECT_EQ(run.status, 0) << camera << run.err;
        }
        EXPECT_EQ(decode_film(dir_ / "a.mp4").frames.size(), 2u) << camera;
        EXPECT_EQ(image::read(dir_ / "2.png").width, 64) << camera;
    }
}

TEST_F(FilmJob, FilmsAreTheSameBytesAgain) {
    const fs::path job = morning(5);
    ASSERT_EQ(relevo({"-q", "run", job.string()}).status, 0);
    const std::string first = bytes_of(dir_ / "day.mp4");
    EXPECT_EQ(error(job),
              "run: " + (dir_ / "day.mp4").string() + ": exists; pass --overwrite to replace it");
    ASSERT_EQ(relevo({"-q", "run", job.string(), "--overwrite"}).status, 0);
    EXPECT_TRUE(bytes_of(dir_ / "day.mp4") == first);
}

TEST_F(FilmJob, MistakesAreToldBeforeAnyWork) {
    const fs::path job = morning(5);
    const std::string name = (dir_ / "day.mp4").string();
    EXPECT_EQ(error(job, {"--size", "641x360"}),
              "film: " + name +
                  ": H.264 needs an even width and height but the size is 641x360; use --size "
                  "642x360, or a webm");
    for (const std::string option : {"--resume", "--sidecar", "--audit", "--shard=1/2"})
        EXPECT_EQ(error(job, {option}, 2),
                  option.substr(0, option.find('=')) + ": " + name +
                      " is one film, made at once; -o frames/{n:04}.png makes its frames as "
                      "pictures");
    const fs::path sizes = this->job(
        "\"shots\": [{}, {\"picture\": {\"size\": [66, 48]}}], \"output\": \"a.mp4\"", "b.json");
    EXPECT_THAT(error(sizes), HasSubstr("a film has frames of one size but frame 1 has 64x48 and "
                                        "frame 2 66x48"));
    EXPECT_THAT(error(morning(5, "day.avi", "\"film\": {},")), HasSubstr("unknown film format"));
    EXPECT_EQ(files_in(dir_).size(), 2u) << "nothing but the jobs";
}

TEST_F(FilmJob, NoEncoderIsAnErrorThatNamesIt) {
    const Result run =
        relevo({"run", morning(5).string()},
               {std::string("LD_PRELOAD=") + RELEVO_TEST_SHIM, "RELEVO_SHIM=encoders"});
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.err,
                testing::ContainsRegex(
                    "day.mp4: this FFmpeg \\(libavcodec [0-9.]+\\) has none of the encoders "
                    "libx264, libopenh264; use another ending"));
    EXPECT_FALSE(fs::exists(dir_ / "day.mp4"));
}

TEST_F(FilmJob, AFullDiskLeavesNothing) {
    const Result run = test::run(
        "/bin/sh", {"-c", "ulimit -f 40; exec \"$0\" \"$@\"", (build_dir() / "bin/relevo").string(),
                    "run", morning(60).string(), "--device", "software", "--size", "320x180"});
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_THAT(run.err,
                testing::ContainsRegex("film: .*day.mp4: (frame [0-9]+: )?cannot be written, "
                                       "File too large"));
    EXPECT_EQ(files_in(dir_).size(), 1u);
}

TEST_F(FilmJob, WhatEndsItLeavesNothing) {
    const fs::path job = morning(5000);
    const pid_t child = fork();
    if (child == 0) {
        execl((build_dir() / "bin/relevo").c_str(), "relevo", "-q", "run", job.c_str(), "--device",
              "software", nullptr);
        _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::seconds(3));
    kill(child, SIGTERM);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it was done before it could be ended";
    EXPECT_EQ(files_in(dir_).size(), 1u);
}

TEST_F(FilmJob, TheExamplesOfTheDocumentationAreFilms) {
    fs::copy_file(bundled_dem(), dir_ / "jacksboro.tif");
    const std::string page = read_text(source_dir() / "docs/jobs.md", "test");
    for (const std::string name : {"film", "flight"}) {
        const std::string fence = "```json " + name + ".json\n";
        const std::size_t begin = page.find(fence);
        ASSERT_NE(begin, std::string::npos) << name;
        const std::size_t from = begin + fence.size();
        const fs::path job =
            write(name + ".json", page.substr(from, page.find("```", from) - from));
        const Result run = relevo({"run", job.string(), "--dry-run", "--size", "64x48"});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_THAT(run.err, testing::ContainsRegex(name == "film" ? "300 frames, 10 s"
                                                                   : "360 frames, 12 s"));
    }
}

// --- relevo film

class FilmVerb : public JobTest {
  protected:
    Result film(std::vector<std::string> more) const {
        std::vector<std::string> arguments{"film", bundled_dem(), "--size", "64x48"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return relevo(arguments);
    }
    nlohmann::json job_of(std::vector<std::string> more) const {
        const std::string name = (dir_ / "job.json").string();
        for (const char* const word : {"--save-job", name.c_str(), "--dry-run", "--overwrite"})
            more.emplace_back(word);
        const Result run = film(more);
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(read_text(name, "test"));
    }
    std::string out(const char* name = "a.mp4") const { return (dir_ / name).string(); }
};

TEST_F(FilmVerb, MakesADayThatItsJobMakesAgain) {
    const Result run = film({"-o", out(), "--duration", "0.5", "--date", "2026-10-01", "--save-job",
                             (dir_ / "job.json").string()});
    ASSERT_EQ(run.status, 0) << run.err;
    const DecodedFilm film = decode_film(out());
    EXPECT_EQ(film.times_s.size(), 15u);
    const Result again = relevo({"-q", "run", (dir_ / "job.json").string(), "--overwrite"});
    ASSERT_EQ(again.status, 0) << again.err;
    const DecodedFilm same = decode_film(out());
    ASSERT_EQ(same.frames.size(), 15u);
    for (std::size_t i = 0; i < 15; ++i)
        EXPECT_EQ(same.frames[i].values, film.frames[i].values) << i;
    const nlohmann::json job =
        nlohmann::json::parse(read_text((dir_ / "job.json").string(), "test"));
    EXPECT_EQ(job["output"], "a.mp4");
    EXPECT_EQ(job["sweep"][0]["times"]["from"], "sunrise-30min");
    EXPECT_EQ(job["time"]["date"], "2026-10-01");
    EXPECT_EQ(job["time"]["zone"], "America/New_York");
}

TEST_F(FilmVerb, MotionsAreAxes) {
    const nlohmann::json year =
        job_of({"-o", out(), "--motion", "year", "--time", "2025-03-01T15:30"});
    EXPECT_EQ(year["sweep"][0]["dates"]["year"], 2025);
    EXPECT_EQ(year["sweep"][0]["dates"]["at"], "15:30");
    EXPECT_EQ(year["time"]["zone"], "solar");
    std::ofstream(dir_ / "line.csv") << "lat,lon\n36.30,-84.28\n36.36,-84.20\n";
    const nlohmann::json both = job_of({"-o", out("b.webm"), "--motion", "day,flight", "--along",
                                        (dir_ / "line.csv").string(), "--above", "200", "--fps",
                                        "24", "--span", "15:00,sunset"});
    EXPECT_EQ(both["combine"], "zip");
    EXPECT_EQ(both["sweep"][0]["times"]["to"], "sunset");
    EXPECT_EQ(both["sweep"][1]["flight"]["along"], "line.csv");
    EXPECT_EQ(both["sweep"][1]["flight"]["height_m"], 200);
    EXPECT_FALSE(both["sweep"][1]["flight"].contains("ease")) << "flights do by default";
    EXPECT_EQ(both["film"]["fps"], 24);
    const nlohmann::json orbit = job_of({"-o", out(), "--motion", "orbit", "--turns", "-0.5"});
    EXPECT_EQ(orbit["sweep"][0]["orbit"]["turns"], -0.5);
    EXPECT_FALSE(orbit["sweep"][0]["orbit"].contains("ease"));
}

TEST_F(FilmVerb, AParameterIsAnAxisAloneOrWithOthers) {
    const nlohmann::json alone =
        job_of({"-o", out(), "--time", "2026-06-21T15:00", "--vary", "haze.density=0.2,0"});
    ASSERT_EQ(alone["sweep"].size(), 1u);
    EXPECT_EQ(alone["sweep"][0]["set"], "haze.density");
    EXPECT_EQ(alone["sweep"][0]["from"], 0.2);
    EXPECT_EQ(alone["sweep"][0]["to"], 0);
    const nlohmann::json with = job_of(
        {"-o", out(), "--motion", "orbit", "--ease", "--vary", "seconds=0,10", "--duration", "3"});
    EXPECT_EQ(with["combine"], "zip");
    EXPECT_EQ(with["sweep"][0]["orbit"]["ease"], true);
    EXPECT_EQ(with["sweep"][1]["set"], "seconds");
    EXPECT_EQ(with["sweep"][1]["duration_s"], 3);
}

TEST_F(FilmVerb, ASpanMakesAParameterMoveThroughADay) {
    const nlohmann::json job =
        job_of({"-o", out(), "--vary", "haze.density=0,1", "--span", "15:00,sunset"});
    ASSERT_EQ(job["sweep"].size(), 2u);
    EXPECT_EQ(job["sweep"][0]["times"]["from"], "15:00");
    EXPECT_EQ(job["sweep"][1]["set"], "haze.density");
}

TEST_F(FilmVerb, OptionsNeedTheirMotion) {
    const auto expect = [&](std::vector<std::string> more, const std::string& message) {
        more.insert(more.begin(), {"film", bundled_dem(), "-o", out()});
        expect_failure(more, 2, message);
    };
    expect({"--motion", "orbit", "--span", "10:00,12:00"}, "--span: needs --motion day");
    expect({"--turns", "2"}, "--turns: needs --motion orbit");
    expect({"--no-ease"}, "--ease: needs --motion orbit or flight");
    expect({"--vary", "haze.density=0,1", "--ease"}, "--ease: needs --motion orbit or flight");
    expect({"--above", "200"}, "--above: needs --motion flight");
}

TEST_F(FilmVerb, PanoramasAndMapsHaveAnEvenSize) {
    const auto size_of = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{
            "film", bundled_dem(), "-o",          out(),        "--duration",
            "0.1",  "--dry-run",   "--overwrite", "--save-job", (dir_ / "job.json").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(read_text(dir_ / "job.json", "test"))["picture"]["size"];
    };
    const std::vector<int> equirectangular{1280, 640}, cylindrical{1280, 148};
    EXPECT_EQ(size_of({"--eye", "36.33,-84.25,700", "--panorama", "equirectangular"}),
              equirectangular);
    EXPECT_EQ(size_of({"--eye", "36.33,-84.25,700", "--panorama", "cylindrical"}), cylindrical);
    // The largest map in these has an odd side.
    for (const char* const size : {"64x50", "66x50", "68x52", "70x54"})
        size_of({"--ortho", "--size", size});
    const Result map = relevo({"-q", "film", bundled_dem(), "-o", out(), "--ortho", "--duration",
                               "0.1", "--size", "70x54"});
    ASSERT_EQ(map.status, 0) << map.err;
    const image::Image8 frame = decode_film(out()).frames.front();
    EXPECT_EQ(frame.width % 2 + frame.height % 2, 0);
}

TEST_F(FilmVerb, RefusesAMarginAndAMapThatMoves) {
    expect_failure({"film", bundled_dem(), "-o", out(), "--ortho", "--motion", "orbit"}, 2,
                   "--motion orbit: a map has no camera; remove --ortho");
    const Result margin = film({"-q", "-o", out(), "--margin"});
    EXPECT_EQ(margin.status, 3);
    EXPECT_THAT(margin.err, HasSubstr("--margin: not of films"));
}

TEST_F(FilmVerb, MistakesSayWhatIsWrong) {
    const auto message = [&](const std::vector<std::string>& more, int status) {
        const Result run = film(more);
        EXPECT_EQ(run.status, status) << run.err;
        return run.err;
    };
    EXPECT_THAT(message({"-o", out(), "--motion", "walk"}, 2),
                HasSubstr("expected day, year, orbit or"));
    EXPECT_THAT(message({"-o", out(), "--motion", "flight"}, 2),
                HasSubstr("add --along TRACK.gpx"));
    EXPECT_THAT(message({"-o", out(), "--motion", "day,year"}, 2), HasSubstr("exclude each other"));
    for (const char* const text : {"haze.density", "haze.density=1", "=0,1", "haze.density=a,1"})
        EXPECT_THAT(message({"-o", out(), "--vary", text}, 2),
                    HasSubstr("expected ADDRESS=FROM,TO"));
    EXPECT_THAT(message({"-o", out(), "--vary", "haze.thickness=0,1"}, 3),
                HasSubstr("haze.thickness"));
    EXPECT_THAT(message({"-o", out("a.png")}, 3), HasSubstr("unknown film format"));
    EXPECT_THAT(message({"-o", out("a.gif"), "--quality", "5"}, 3), HasSubstr("has no quality"));
    EXPECT_THAT(message({"-o", out(), "--motion", "orbit", "--date", "2026-10-01"}, 2),
                HasSubstr("this film has one time"));
    EXPECT_THAT(message({"-o", out(), "--duration", "0"}, 2), HasSubstr("--duration"));
    EXPECT_TRUE(files_in(dir_).empty());
}

}  // namespace
}  // namespace relevo::test::test_film
