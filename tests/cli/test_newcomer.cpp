#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "cli/program.h"
#include "dem/fixture.h"
#include "support/support.h"

/// Mistakes of those who have not read the docs. Each message alone is enough to go on, so each is
/// here as a whole.
namespace relevo::test::test_newcomer {
namespace {

std::filesystem::path dir() {
    static const std::filesystem::path folder = scratch_dir("newcomer");
    return folder;
}

std::string path(const std::string& name) {
    return (dir() / name).string();
}

std::string picture() {
    return path("a.png");
}

/// `relevo capture DEM -o a.png` and more.
std::vector<std::string> capture(std::vector<std::string> more, std::string dem = bundled_dem()) {
    more.insert(more.begin(), {"capture", std::move(dem), "-o", picture()});
    return more;
}

const std::string kSee = "; see relevo capture --help";

TEST(Newcomer, MisspeltWords) {
    expect_failure({"captur", "dem.tif"}, 2, "captur: no such command; did you mean capture?");
    expect_failure({"help"}, 2, "help: no such command; write relevo --help");
    expect_failure(capture({"--vieww", "top"}), 2,
                   "--vieww: no such option; did you mean --view? See relevo capture --help");
    expect_failure({"info", bundled_dem(), "--size", "640x480"}, 2,
                   "--size: not an option of relevo info, but of relevo view, relevo capture, "
                   "relevo run, ...; see relevo info --help");
    expect_failure(capture({"--view", "nort"}), 2,
                   "--view: nort: expected top, whole, north, north-east, ... north-west, or "
                   "az=DEG,el=DEG,zoom=FACTOR, but got \"nort\"; did you mean north?");
    expect_failure(capture({"--preset", "relif"}), 3,
                   "preset: relif: no such preset; did you mean relief?");
    expect_failure(capture({"--enable", "haez"}), 3,
                   "effects: haez: no such plugin; did you mean haze?");
    expect_failure({"-q", "captur", "dem.tif"}, 2,
                   "captur: no such command; did you mean capture?");
    expect_failure(capture({"—size", "640x480"}), 2,
                   "—size: begins with a dash; write --size with hyphens" + kSee);
}

TEST(Newcomer, MissingAndDividedWords) {
    expect_failure({"capture"}, 2, "DEM is missing; write relevo capture DEM --output FILE" + kSee);
    expect_failure({"capture", bundled_dem(), picture()}, 2,
                   "--output is missing; write relevo capture DEM --output FILE" + kSee);
    expect_failure({"capture", bundled_dem(), "-o"}, 2,
                   "--output: expected a value after it" + kSee);
    expect_failure(capture({"--unit", ""}), 2,
                   "--unit: expected a value but got \"\"; is a shell variable unset? See relevo "
                   "capture --help");
    expect_failure(capture({"--view", "az=210", "el=30"}), 3,
                   "el=30: no such file; an option's value is one word, as in --view "
                   "az=210,el=30");
    expect_failure(capture({"--set", "haze.density", "=", "0.2"}), 2,
                   "--set: expected PLUGIN.PARAMETER=VALUE without spaces but got "
                   "\"haze.density\"");
    expect_failure(capture({"--size", "1920"}), 2,
                   "--size: expected WIDTHxHEIGHT such as 1920x1080, each 1 to 65536, but got "
                   "\"1920\"");
    expect_failure({"sun", "position", "--at", "46.55", "8.56", "--time", "2026-06-21T12:00"}, 2,
                   "8.56: belongs to no option; write values of several parts with commas and "
                   "without blanks, or in quotes; see relevo sun position --help");
}

TEST(Newcomer, FilesThatAreNoDem) {
    write_raster(dir() / "alps.tif", {});
    expect_failure(
        capture({}, path("alsp.tif")), 3,
        fmt::format("{}: no such file; did you mean {}?", path("alsp.tif"), path("alps.tif")));
    Raster photo;
    photo.type = "Byte";
    photo.bands = 3;
    photo.pictures = true;
    write_raster(dir() / "photo.tif", photo);
    expect_failure(capture({}, path("photo.tif")), 3,
                   path("photo.tif") +
                       ": a picture (red, green and blue bands of 8 bits), expected heights; if "
                       "its colours encode heights pass --encoding terrain-rgb or terrarium, if "
                       "one band holds them --band N");
    Raster nowhere;
    nowhere.crs = "";
    write_raster(dir() / "nowhere.tif", nowhere);
    expect_failure(
        capture({}, path("nowhere.tif")), 3,
        path("nowhere.tif") +
            ": does not say its coordinate system; add --crs, for example EPSG:32632 (UTM 32 N)");
    std::filesystem::create_directory(path("empty"));
    expect_failure(capture({}, path("empty")), 3,
                   path("empty") +
                       ": a folder without a raster in it, expected a raster or a folder of "
                       "rasters");
    std::ofstream(path("day.json")) << R"({"format": 1, "dem": {"files": []}, "sweep": []})";
    expect_failure(capture({}, path("day.json")), 3,
                   path("day.json") + ": a job of Relevo, not a raster; draw it with relevo run");
    Raster centimetres;
    centimetres.columns = centimetres.rows = 20;
    centimetres.value = [](int column, int, int) { return 31'000.0 + column; };
    write_raster(dir() / "cm.tif", centimetres);
    expect_failure(capture({}, path("cm.tif")), 3,
                   path("cm.tif") +
                       ": 400 of 400 heights are outside -11500 to 9000 m (31000 to 31019 m); add "
                       "--unit dm (3100 to 3102 m) or cm (310 to 310 m) or mm (31 to 31 m), "
                       "or --nodata V if the stored value V marks voids, or --unit m if they are "
                       "right");
}

TEST(Newcomer, OtherFilesInTheWrongPlace) {
    expect_failure({"run", bundled_dem()}, 3,
                   "job: " + bundled_dem() + ": not JSON, expected a file that begins with {");
    std::ofstream(path("huts.csv")) << "lat,lon\n36.3,-84.2\n36.31,-84.2\n";
    expect_failure(
        {"sun", "along", path("huts.csv"), bundled_dem()}, 3,
        "sun along: " + bundled_dem() + ": not a text, expected a CSV, a GPX or a GeoJSON file");
}

TEST(Newcomer, Results) {
    expect_failure({"capture", bundled_dem(), "-o", path("a.bmp")}, 3,
                   "image: " + path("a.bmp") +
                       ": unknown picture format; use png, jpg, webp, avif, tif or exr");
    std::ofstream(path("there.png")) << "precious";
    expect_failure({"capture", bundled_dem(), "-o", path("there.png")}, 3,
                   "image: " + path("there.png") + ": exists; pass --overwrite to replace it");
    expect_failure({"capture", bundled_dem(), "-o", "--overwrite"}, 2,
                   "--output: expected a value but got the option --overwrite" + kSee);
    expect_failure({"capture", bundled_dem(), "-o=a.png"}, 2,
                   "--output: write -o a.png, without the =" + kSee);
}

TEST(Newcomer, Times) {
    expect_failure(
        capture({"--time", "21.06.2026"}), 3,
        "time: 21.06.2026: not a time, expected YYYY-MM-DDThh:mm with Z or an offset, such "
        "as 2026-06-21T18:30+02:00");
    expect_failure(capture({"--time", "2026-06-21"}), 3,
                   "time: 2026-06-21: no time of day, expected one such as T18:30 after it");
    expect_failure(capture({"--time", "2026-02-31T12:00"}), 3,
                   "time: 2026-02-31T12:00: no such date, expected day 1 to 28 of 2026-02 but got "
                   "31");
    expect_failure(capture({"--time", "2026-06-21T18:30", "--tz", "PST"}), 3,
                   "time zone: PST: an abbreviation, which several time zones share; write a name "
                   "such as Europe/Zurich or an offset such as +02:00");
    expect_failure(capture({"--time", "2026-06-21T18:30", "--tz", "UTC+2"}), 3,
                   "time zone: UTC+2: no such time zone; write the offset alone, such as +02:00");
    expect_failure(capture({"--time", "2026-06-21T18:30", "--tz", "Zurich"}), 3,
                   "time zone: Zurich: no such time zone; did you mean Europe/Zurich?");
}

TEST(Newcomer, Places) {
    const auto day_at = [](const char* at) {
        return std::vector<std::string>{"-q",   "sun", "day",    bundled_dem(),
                                        "--at", at,    "--date", "2026-06-21"};
    };
    const std::string within =
        ": outside of the DEM, expected a point within latitudes 36.1600 to 36.4458 and longitudes "
        "-84.4133 to -84.0783";
    expect_failure(day_at("46.5,8.5"), 3, "horizon: 46.5,8.5" + within);
    expect_failure(day_at("-84.2,36.3"), 3,
                   "horizon: -84.2,36.3" + within + "; latitude comes first");
    expect_failure({"-q", "capture", bundled_dem(), "-o", picture(), "--eye", "-84.2,36.3"}, 3,
                   "--eye: 84.20000 S 36.30000 E: outside the DEM; latitude comes first, perhaps "
                   "36.3,-84.2");
    expect_failure({"sun", "position", "--at", "Zurich", "--time", "2026-06-21T12:00Z"}, 2,
                   "--at: Zurich: a place, expected LAT,LON or LAT,LON,H but got 1 part; write "
                   "decimal degrees, latitude first, as in 46.55,8.56");
}

}  // namespace
}  // namespace relevo::test::test_newcomer
