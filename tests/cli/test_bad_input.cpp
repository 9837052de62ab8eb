#include <filesystem>
#include <fstream>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "cli/program.h"
#include "dem/fixture.h"
#include "support/support.h"

namespace relevo::test::test_bad_input {
namespace {

std::filesystem::path dir() {
    static const std::filesystem::path folder = scratch_dir("cli_bad_input");
    return folder;
}

std::string out_png() {
    return (dir() / "out.png").string();
}

/// As expect_failure, and no picture is there.
void expect_no_picture(const std::vector<std::string>& arguments, int status,
                       const std::string& message) {
    expect_failure(arguments, status, message);
    EXPECT_FALSE(std::filesystem::exists(out_png()));
}

std::string written(const char* name, const Raster& raster) {
    return write_raster(dir() / name, raster);
}

TEST(BadDem, EachHasItsMessage) {
    std::ofstream(dir() / "notes.txt") << "Heights of the Alps, to be measured.\n";
    Raster no_crs;
    no_crs.crs = "";
    Raster empty;
    empty.value = [](int, int, int) { return std::numeric_limits<double>::quiet_NaN(); };
    Raster one_post, one_row;
    one_post.columns = one_post.rows = one_row.rows = 1;
    Raster large;
    large.columns = large.rows = 200;
    const std::string cut = written("cut.tif", large);
    std::filesystem::resize_file(cut, 60000);
    struct Case {
        std::string path, message;
    };
    for (const Case& c :
         {Case{"/nowhere/alps.tif", "no such file; there is no folder /nowhere"},
          Case{(dir() / "notes.txt").string(), "not a raster in any format that GDAL reads"},
          Case{written("no_crs.tif", no_crs),
               "does not say its coordinate system; add --crs, for example EPSG:32632 (UTM 32 N)"},
          Case{written("empty.tif", empty), "no valid height: all 24 posts are voids"},
          Case{written("one_post.tif", one_post),
               "size, expected at least 2 x 2 posts but got 1 x 1"},
          Case{written("one_row.tif", one_row),
               "size, expected at least 2 x 2 posts but got 6 x 1"}}) {
        expect_no_picture({"capture", c.path, "-o", out_png()}, 3, c.path + ": " + c.message);
        expect_no_picture({"info", c.path}, 3, c.path + ": " + c.message);
    }
    const Result run = relevo({"capture", cut, "-o", out_png()});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(run.err.ends_with("the file is damaged or incomplete\n")) << run.err;
    EXPECT_FALSE(std::filesystem::exists(out_png()));
}

TEST(BadTime, EachHasItsMessage) {
    const auto capture_at = [](const std::vector<std::string>& time) {
        std::vector<std::string> arguments{"capture", bundled_dem(), "-o", out_png()};
        arguments.insert(arguments.end(), time.begin(), time.end());
        return arguments;
    };
    // Words are read before the DEM, also where it has to say which zone they are in.
    const std::vector<std::string> no_dem{"capture", "/nowhere/alps.tif", "-o", out_png()};
    const auto without_dem = [&](const std::vector<std::string>& time) {
        std::vector<std::string> arguments = no_dem;
        arguments.insert(arguments.end(), time.begin(), time.end());
        return arguments;
    };
    expect_no_picture(without_dem({"--time", "2026-06-21T25:30"}), 3,
                      "time: 2026-06-21T25:30: no such hour, expected hour 0 to 23 but "
                      "got 25");
    expect_no_picture(without_dem({"--time", "sunrise"}), 3,
                      "time: sunrise: no date; write 2026-06-21 sunrise or pass "
                      "--date");
    expect_no_picture(without_dem({"--time", "2026-06-21T18:30", "--date", "2026-06-21"}), 2,
                      "--date: needs an event in --time, such as sunrise@46.55,8.56; write a time "
                      "of day as 2026-06-21T18:30");
    expect_no_picture(capture_at({"--time", "2026-06-21T18:30", "--tz", "Europe/Zurick"}), 3,
                      "time zone: Europe/Zurick: no such time zone; did you mean Europe/Zurich?");
    // Without --time they would be left out of account, and the picture be of another day.
    expect_no_picture(capture_at({"--date", "2026-12-21"}), 2,
                      "--date: needs an event in --time, such as sunrise@46.55,8.56; write a time "
                      "of day as --time 2026-12-21T18:30");
    expect_no_picture(capture_at({"--tz", "Europe/Zurich"}), 2,
                      "--tz: needs --time, such as --time 2026-06-21T18:30");
}

TEST(BadValue, LineBreaksInItStandAsTheirNames) {
    const std::vector<std::string> capture{"capture", bundled_dem(), "-o", out_png()};
    const auto with = [&](const char* option, const char* value) {
        std::vector<std::string> arguments = capture;
        arguments.insert(arguments.end(), {option, value});
        return arguments;
    };
    expect_no_picture(with("--view", "az=1\nrelevo: done"), 2,
                      "--view: az=1\\nrelevo: done: expected top, whole, north, north-east, ... "
                      "north-west, or az=DEG,el=DEG,zoom=FACTOR, but got \"az=1\\nrelevo: done\"");
    expect_no_picture(with("--time", "1\n2"), 3,
                      "time: 1\\n2: not a time, expected YYYY-MM-DDThh:mm with Z or an "
                      "offset, such as 2026-06-21T18:30+02:00");
    const Result device = relevo(with("--device", "a\nb"));
    EXPECT_EQ(device.status, 4);
    EXPECT_NE(device.err.find(" found is \"a\\nb\" and can draw"), std::string::npos) << device.err;
}

TEST(BadValue, AHeadingIsANumber) {
    for (const char* heading : {"nan", "inf", "-inf", "0x10", "1e309", "north"})
        expect_no_picture({"capture", bundled_dem(), "-o", out_png(), "--eye", "36.3,-84.2",
                           "--heading", heading},
                          2,
                          std::string("--heading: expected a number but got ") + heading +
                              "; see relevo capture --help");
}

TEST(BadPlace, Latitude91) {
    expect_no_picture(
        {"sun", "position", "--at", "91,10", "--time", "2026-06-21T18:30Z"}, 2,
        "--at: 91,10: latitude, expected -90 to 90 degrees but got 91; latitude comes first, "
        "perhaps 10,91");
}

TEST(BadPlace, AnEyeWithoutGroundUnderIt) {
    const Result run = relevo({"-q", "capture", bundled_dem(), "-o", out_png(), "--eye", "10.5,7"});
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.err,
              "relevo: error: --eye: 10.50000 N 7.00000 E: outside the DEM or in a void, so there "
              "is no ground height; give one above the DEM's zero, as in 10.5,7,500\n");
    EXPECT_FALSE(std::filesystem::exists(out_png()));
}

TEST(BadEffect, EachHasItsMessage) {
    const std::vector<std::string> capture{"capture", bundled_dem(), "-o", out_png()};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), capture.begin(), capture.end());
        return more;
    };
    const Result unknown = relevo(with({"--enable", "xyzzy"}));
    EXPECT_EQ(unknown.status, 3);
    EXPECT_TRUE(
        unknown.err.starts_with("relevo: error: effects: xyzzy: no such plugin; there are "))
        << unknown.err;
    expect_no_picture(with({"--set", "terrain.norm=vertex"}), 3,
                      "parameter: terrain.norm: no such parameter; did you mean terrain.normal?");
    expect_no_picture(with({"--set", "terrain.normal=7"}), 3,
                      "parameter: terrain.normal: expected one of fragment, vertex but got \"7\"");
    expect_no_picture(
        with({"--set", "terrain.normal"}), 2,
        "--set: expected PLUGIN.PARAMETER=VALUE without spaces but got \"terrain.normal\"");
}

TEST(BadOutput, EachHasItsMessage) {
    const std::string nowhere = (dir() / "none" / "a.png").string();
    expect_no_picture({"capture", bundled_dem(), "-o", nowhere}, 3,
                      "image: " + nowhere + ": the folder " + (dir() / "none").string() +
                          " does not exist; create it first");
    const std::string there = (dir() / "there.png").string();
    std::ofstream(there) << "precious";
    expect_no_picture({"capture", bundled_dem(), "-o", there}, 3,
                      "image: " + there + ": exists; pass --overwrite to replace it");
    std::string kept;
    std::ifstream(there) >> kept;
    EXPECT_EQ(kept, "precious");
    expect_no_picture(
        {"capture", bundled_dem(), "-o", out_png(), "--size", "0x10"}, 2,
        "--size: expected WIDTHxHEIGHT such as 1920x1080, each 1 to 65536, but got \"0x10\"");
}

TEST(BadDevice, NoneIsExitFour) {
    const Result run = relevo({"capture", bundled_dem(), "-o", out_png(), "--device", "voodoo"});
    EXPECT_EQ(run.status, 4);
    const std::string first = run.err.substr(0, run.err.find('\n'));
    EXPECT_TRUE(first.starts_with("relevo: error: gl: no GL device: none of the ")) << first;
    EXPECT_TRUE(first.ends_with(" found is \"voodoo\" and can draw with OpenGL 4.5 core")) << first;
    EXPECT_FALSE(std::filesystem::exists(out_png()));
}

TEST(BadDevice, AMachineWithoutAnyDriverSaysWhatToInstall) {
    const Result run = relevo({"capture", bundled_dem(), "-o", out_png()},
                              {"__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere/none.json"});
    EXPECT_EQ(run.status, 4);
    EXPECT_EQ(run.err,
              "relevo: error: gl: no GL device: EGL offers none; install Mesa's software renderer "
              "(libegl1, "
              "libegl-mesa0, libgl1-mesa-dri)\n");
}

TEST(BadUsage, EachHasItsMessage) {
    expect_no_picture({"captur"}, 2, "captur: no such command; did you mean capture?");
    expect_no_picture({"sun", "carpt"}, 2, "carpt: no such command; did you mean carpet?");
    expect_no_picture(
        {"sun"}, 2,
        "sun: no command given; there are position, day, horizon, eclipses, carpet, when, "
        "shadow, hours, plane, sky-view, horizons, along; each has --help");
    expect_no_picture({"plugins", "x"}, 2,
                      "x: no such command; there are list, info, new, check, test");
    expect_no_picture(
        {"capture"}, 2,
        "DEM is missing; write relevo capture DEM --output FILE; see relevo capture --help");
    expect_no_picture(
        {"capture", bundled_dem(), "-o", out_png(), "--fov", "500"}, 2,
        "--fov: expected a number in [0.1, 170] but got 500; see relevo capture --help");
    expect_no_picture({"capture", bundled_dem(), "-o", out_png(), "--repeat", "x"}, 2,
                      "--repeat: expected a whole number but got x; see relevo capture --help");
    expect_no_picture({"capture", bundled_dem(), "-o", out_png(), "--encoding", "mapbox"}, 2,
                      "--encoding: expected one of none, terrain-rgb, terrarium but got "
                      "\"mapbox\"; see relevo capture --help");
    for (const char* band : {"0", "-1", "1.5", "4294967297", "1e+99"})
        expect_no_picture(
            {"capture", bundled_dem(), "-o", out_png(), "--band", band}, 2,
            std::string("--band: expected a whole number in [1, 2147483647] but got ") + band +
                "; see relevo capture --help");
    for (const char* zoom : {"1e99", "1e-99", "0", "-1"})
        expect_no_picture(
            {"capture", bundled_dem(), "-o", out_png(), "--view", std::string("zoom=") + zoom}, 2,
            std::string("--view: zoom=") + zoom + ": expected a zoom of 0.001 to 1000000 but got " +
                (zoom[1] == 'e' ? std::string(zoom).replace(1, 1, zoom[2] == '-' ? "e" : "e+")
                                : zoom));
    expect_no_picture({"capture", bundled_dem(), "-o", out_png(), "--foo"}, 2,
                      "--foo: no such option; did you mean --fov? See relevo capture --help");
    expect_no_picture(
        {"capture", bundled_dem(), "-o", out_png(), "--view", "az=10,tilt=3"}, 2,
        "--view: az=10,tilt=3: expected top, whole, north, north-east, ... north-west, or "
        "az=DEG,el=DEG,zoom=FACTOR, but got \"tilt=3\"");
    // A word stands first; north-up is none.
    for (const auto& [view, word, remedy] :
         {std::tuple{"el=40,north", "north", "; a side comes first, as in north,el=40"},
          {"north-up", "north-up", ""},
          {"nort", "nort", "; did you mean north?"}})
        expect_no_picture({"capture", bundled_dem(), "-o", out_png(), "--view", view}, 2,
                          fmt::format("--view: {}: expected top, whole, north, north-east, ... "
                                      "north-west, or az=DEG,el=DEG,zoom=FACTOR, but got \"{}\"{}",
                                      view, word, remedy));
    expect_no_picture({"capture", bundled_dem(), "-o", out_png(), "--heading", "10"}, 2,
                      "--look-at, --heading and --pitch need --eye");
    expect_no_picture(
        {"capture", bundled_dem(), "-o", out_png(), "--eye", "36.3,-84.2", "--view", "az=3"}, 2,
        "--view and --eye exclude each other; use one");
}

}  // namespace
}  // namespace relevo::test::test_bad_input
