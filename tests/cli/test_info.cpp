#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/program.h"
#include "dem/fixture.h"
#include "support/support.h"

namespace relevo::test::test_info {
namespace {

std::filesystem::path dir() {
    static const std::filesystem::path folder = scratch_dir("cli_info");
    return folder;
}

TEST(Info, DoesWithoutTheSunIfTheClockIsBeyondTheYearsThatAreComputed) {
    const std::vector<std::string> late{std::string("LD_PRELOAD=") + RELEVO_TEST_SHIM,
                                        "RELEVO_SHIM=clock"};
    const Result text = relevo({"info", bundled_dem()}, late);
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("\nposts "), std::string::npos) << text.out;
    EXPECT_EQ(text.out.find("\nsun "), std::string::npos) << text.out;
    EXPECT_TRUE(text.err.starts_with(
        "relevo: warning: sun and climate are computed for the years 1900 to 2100, but this "
        "computer's clock says 21"))
        << text.err;
    const Result json = relevo({"info", bundled_dem(), "--json"}, late);
    EXPECT_EQ(json.status, 0) << json.err;
    EXPECT_FALSE(nlohmann::json::parse(json.out).contains("sun"));
    const Result timed = relevo({"info", bundled_dem(), "--time", "2026-06-21T16:00Z"}, late);
    EXPECT_NE(timed.out.find("\nsun "), std::string::npos) << timed.out;
    EXPECT_EQ(timed.err.find("clock"), std::string::npos) << timed.err;
}

TEST(InfoVerb, SaysEverythingInLines) {
    const Result run = relevo({"-v", "info", bundled_dem(), "--time", "2026-06-21T16:00Z"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out,
              "file       " + bundled_dem() +
                  "\nformat     GTiff, Int16\nposts      403 x 344\ncrs        EPSG:4326 (WGS "
                  "84)\ncenter     36.30292 N 84.24583 W (UTM 16N 747302 E 4021068 N, MGRS "
                  "16SGF4730221067)\nextent     30.1 km east, 31.7 km north\nspacing    74.85 m x "
                  "92.47 m\nheights    236.0 to 1076.0 m\nvoids      0 %\nunit       m "
                  "(band)\nabove      unknown\nassumed    heights are taken as ellipsoidal: the "
                  "file names no vertical datum\nwater      0 % sea, 0.798 % lakes (2), as drawn "
                  "in pictures\nsun        azimuth 114.27, elevation 65.12 (65.13 with refraction) "
                  "at 2026-06-21T16:00:00Z\nclimate    January 1.4, July 22.8 degC at 656 m, 1250 "
                  "mm of rain a year\nground     trees up to 2650 m, permanent ice from 3480 m, "
                  "snow from 2950 m on 2026-06-21\nland cover generated from shares of 0.05 "
                  "degrees, not mapped; MODIS MCD12C1 (NASA LP DAAC), NASA Blue Marble\n"
                  "net        pieces of 64 posts: drawn positions "
                  "are within 0.00024 m, 3.2e-06 of the post spacing\n");
}

TEST(InfoVerb, OnlyItsOwnLinesAreOnStandardError) {
    const auto written = [](const char* driver, const char* name) {
        Raster raster;
        raster.driver = driver;
        raster.columns = raster.rows = 80;
        if (raster.driver == "netCDF") raster.options = {"FORMAT=NC4"};
        return write_raster(dir() / name, raster);
    };
    const std::string picture = (dir() / "quiet.png").string();
    for (const std::string& path :
         {written("netCDF", "a.nc"), written("BAG", "a.bag"), written("HFA", "a.img"),
          std::string(source_dir() / "tests/data/cases/grib/gfs.t06z.pgrb2.10p0.f010.grib2")}) {
        for (int i = 0; i < 3; ++i) {  // on whichever thread
            const Result info = relevo({"-q", "info", path}),
                         capture = relevo({"-q", "capture", path, "-o", picture, "--size", "64x48",
                                           "--overwrite"});
            for (const std::string& text : {info.err, capture.err})
                for (const std::string& line : split(text, '\n'))
                    EXPECT_TRUE(line.empty() || line.starts_with("relevo: warning: ") ||
                                line.starts_with("relevo: error: "))
                        << path << ": " << line;
        }
        const std::string more = relevo({"info", path}).err;
        EXPECT_LE(std::ranges::count(more, '\n'), 3) << more;
    }
}

TEST(InfoVerb, JsonHasTheSunAndTheNet) {
    const Result run = relevo({"info", bundled_dem(), "--json", "--time", "2026-06-21T16:00Z"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["files"], nlohmann::json{bundled_dem()});
    EXPECT_EQ(json["utm"], "16N 747302 E 4021068 N");
    EXPECT_EQ(json["mgrs"], "16SGF4730221067");
    EXPECT_EQ(json["sun"]["utc"], "2026-06-21T16:00:00Z");
    const Result sun = relevo(
        {"sun", "position", "--json", "--at", "36.30292,-84.24583", "--time", "2026-06-21T16:00Z"});
    const nlohmann::json position = nlohmann::json::parse(sun.out);
    for (const char* key : {"azimuth_deg", "elevation_deg"})
        EXPECT_NEAR(json["sun"][key].get<double>(), position[key].get<double>(), 1e-4) << key;
    EXPECT_GT(json["sun"]["apparent_elevation_deg"], json["sun"]["elevation_deg"]);
    const nlohmann::json& climate = json["climate"];
    EXPECT_EQ(climate["height_m"], 656);
    EXPECT_NEAR(climate["january_c"].get<double>(), 0.5, 3);  // Knoxville: 3.5 and 25.6 at 270 m
    EXPECT_NEAR(climate["july_c"].get<double>(), 23, 3);
    EXPECT_NEAR(climate["year_mm"].get<double>(), 1300, 200);
    EXPECT_EQ(climate["date"], "2026-06-21");
    EXPECT_EQ(climate["ground_cover"], "forest");
    EXPECT_GT(climate["tree_line_m"], 2200);
    EXPECT_GT(climate["snow_line_m"], climate["tree_line_m"]);
    EXPECT_GT(climate["ice_line_m"], climate["tree_line_m"]);
    EXPECT_EQ(json["position_net"]["piece_posts"], 64);
    EXPECT_LT(json["position_net"]["error_m"].get<double>(), 0.75);
    EXPECT_EQ(json["spikes"]["count"], 0);
    EXPECT_EQ(json["spikes"]["limit_m"], 449.088);
    EXPECT_TRUE(json["spikes"]["worst"].is_null());
}

TEST(InfoVerb, SaysGuessesOnStandardError) {
    Raster raster;
    raster.type = "Int16";
    raster.columns = raster.rows = 20;
    raster.value = [](int column, int row, int) { return column == 3 ? -9999.0 : 500 + row; };
    const std::string path = write_raster(dir() / "undeclared.tif", raster);
    const std::string said =
        "-9999 is taken as a void (not declared, far from all heights); --nodata none keeps it";
    const Result run = relevo({"info", path, "--json"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err, "relevo: " + path + ": " + said + "\n");
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["nodata"], -9999);
    EXPECT_EQ(json["nodata_share"], 0.05);
    EXPECT_EQ(json["assumptions"].back(), said);
    EXPECT_EQ(relevo({"-q", "info", path}).err, "");

    const Result all = relevo({"info", path, "--json", "--nodata", "none"});
    EXPECT_EQ(all.err, "");
    EXPECT_EQ(nlohmann::json::parse(all.out)["elevation_m"]["min"], -9999);
    const Result other = relevo({"info", path, "--json", "--nodata", "-9999"});
    EXPECT_EQ(other.err, "");
    EXPECT_EQ(nlohmann::json::parse(other.out)["elevation_m"]["min"], 500);
}

TEST(InfoVerb, ReportsSpikesAndOutliers) {
    Raster raster;
    raster.columns = raster.rows = 20;
    raster.value = [](int column, int row, int) {
        return column == 3 && row == 4 ? 9500.0 : 500.0 + row;
    };
    const std::string path = write_raster(dir() / "spike.tif", raster);
    const Result run = relevo({"-q", "info", path, "--nodata", "none"});
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(
        run.out.find(
            "outliers   1 heights impossible on Earth\nspikes     1 post more than 180 m "
            "above or below all its neighbours, the worst by 8995 m at 46.95231 N 9.00138 E\n"),
        std::string::npos)
        << run.out;
}

TEST(InfoVerb, JoinsFiles) {
    Raster east;
    east.geotransform = {{500180, 30, 0, 5200000, 0, -30}};
    const std::string a = write_raster(dir() / "a.tif", {});
    const std::string b = write_raster(dir() / "b.tif", east);
    const Result run = relevo({"info", a, b, "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["size"], (nlohmann::json{12, 4}));
    EXPECT_EQ(json["files"], (nlohmann::json{a, b}));
    EXPECT_EQ(json["path"], a + " and 1 more");
}

/// `relevo`, in so much address space and processor time and no more.
Result limited(std::vector<std::string> arguments, int gib, int processor_s) {
    arguments.insert(arguments.begin(),
                     {fmt::format("--as={}", std::int64_t{gib} << 30),
                      fmt::format("--cpu={}", processor_s), (build_dir() / "bin/relevo").string()});
    return run("/usr/bin/prlimit", arguments);
}

TEST(InfoVerb, IsOfAllPostsWhateverMemoryHolds) {
    Raster raster;
    raster.columns = 1200;
    raster.rows = 640;
    raster.value = [](int column, int row, int) {
        return column == 1199 && row == 639 ? 4321.0 : 500.0 + (column * 7 + row * 3) % 100;
    };
    const std::string path = write_raster(dir() / "beyond.tif", raster);
    const std::vector<std::string> info{"-q", "info", path, "--time", "2026-06-21T16:00Z"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), info.begin(), info.end());
        return relevo(more);
    };
    const Result all = with({});
    EXPECT_NE(all.out.find("posts      1200 x 640\n"), std::string::npos) << all.out;
    EXPECT_NE(all.out.find("heights    500.0 to 4321.0 m\n"), std::string::npos) << all.out;
    EXPECT_NE(all.out.find("spikes     1 post"), std::string::npos) << all.out;
    EXPECT_EQ(with({"--memory", "1"}).out, all.out);
    EXPECT_EQ(with({"--memory", "1", "--json"}).out, with({"--json"}).out);
}

TEST(InfoVerb, TakesAFolderOfTiles) {
    const std::filesystem::path tiles = dir() / "tiles";
    std::filesystem::create_directories(tiles);
    Raster east;
    east.geotransform = {{500180, 30, 0, 5200000, 0, -30}};
    write_raster(tiles / "b.tif", {});
    write_raster(tiles / "a.tif", east);
    const Result run = relevo({"info", tiles.string() + "/", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(nlohmann::json::parse(run.out)["files"],
              (nlohmann::json{(tiles / "a.tif").string(), (tiles / "b.tif").string()}));
}

TEST(InfoVerb, FilesThatClaimMuchCostLittle) {
    // 2^31 columns in 0.6 kB of text, full of one tile and of nothing.
    const auto claim = [](const char* name, int rows, const std::string& band) {
        const std::filesystem::path path = dir() / name;
        std::ofstream(path)
            << "<VRTDataset rasterXSize=\"2147483647\" rasterYSize=\"" << rows
            << "\"><SRS>EPSG:4326</SRS><GeoTransform>0,0.00000001,0,1,0,-0.00000001</GeoTransform>"
               "<VRTRasterBand dataType=\"Float32\" band=\"1\">"
            << band << "</VRTRasterBand></VRTDataset>";
        return path.string();
    };
    const std::string tile = write_raster(dir() / "tile.tif", {});
    const std::string source =
        "<SimpleSource><SourceFilename>" + tile +
        "</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"6\" "
        "ySize=\"4\"/><DstRect xOff=\"0\" yOff=\"0\" xSize=\"2147483647\" ySize=\"3\"/>"
        "</SimpleSource>";
    const Result full = limited({"-q", "info", claim("full.vrt", 3, source)}, 3, 60);
    EXPECT_EQ(full.status, 3) << full.err;
    EXPECT_NE(full.err.find(": claims 2147483647 x 3 posts, too many for "), std::string::npos)
        << full.err;
    const std::string nothing = claim("nothing.vrt", 3, "");
    const Result empty = limited({"-q", "info", nothing}, 3, 60);
    EXPECT_EQ(empty.status, 0) << empty.err;
    EXPECT_NE(empty.out.find("posts      2147483647 x 3\n"), std::string::npos) << empty.out;
    const Result drawn = limited(
        {"-q", "capture", nothing, "-o", (dir() / "nothing.png").string(), "--device", "software"},
        3, 60);
    EXPECT_EQ(drawn.status, 3);
    EXPECT_EQ(drawn.err, "relevo: error: " + nothing +
                             ": 2147483647 x 3 posts, expected at most 4194304 a side; crop it "
                             "with gdal_translate\n");
}

// 2^31 x 2 posts of a DEM of 200 kB: what memory and time none has to read is refused by name.
TEST(InfoVerb, EndlessRowsAreRefusedSoon) {
    const std::string path = (dir() / "endless.vrt").string();
    std::ofstream(path)
        << "<VRTDataset rasterXSize=\"2147483647\" rasterYSize=\"2\"><SRS>EPSG:4326</SRS>"
           "<GeoTransform>0,0.00000001,0,1,0,-0.00000001</GeoTransform>"
           "<VRTRasterBand dataType=\"Int16\" band=\"1\"><SimpleSource><SourceFilename>"
        << bundled_dem()
        << "</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" "
           "xSize=\"400\" ySize=\"300\"/><DstRect xOff=\"0\" yOff=\"0\" "
           "xSize=\"2147483647\" ySize=\"2\"/></SimpleSource></VRTRasterBand></VRTDataset>";
    const std::string output = (dir() / "endless.tif").string();
    for (const std::vector<std::string>& verb :
         {std::vector<std::string>{"info", path},
          {"capture", path, "-o", (dir() / "endless.png").string(), "--device", "software"},
          {"sun", "horizon", path, "--at", "1,3"},
          {"sun", "hours", path, "--date", "2026-03-20", "--tz", "UTC", "-o", output}}) {
        std::vector<std::string> arguments{"-q"};
        arguments.insert(arguments.end(), verb.begin(), verb.end());
        const Result run = limited(arguments, 3, 20);
        EXPECT_EQ(run.status, 3) << verb.front() << ": " << run.err;
        EXPECT_NE(run.err.find(path + ": 2147483647 x 2 posts, expected at most 4194304 a side"),
                  std::string::npos)
            << verb.front() << ": " << run.err;
    }
}

TEST(InfoVerb, SparseFilesAreReadWhereTheyStoreSomething) {
    Raster raster;
    raster.type = "Int16";
    raster.crs = "EPSG:4326";
    raster.columns = raster.rows = 200'000;
    raster.geotransform = {{0, 0.0001, 0, 20, 0, -0.0001}};
    raster.nodata = -9999;
    raster.options = {"TILED=YES", "SPARSE_OK=YES", "BLOCKXSIZE=1024", "BLOCKYSIZE=1024",
                      "COMPRESS=DEFLATE"};
    const std::string path =
        write_sparse_raster(dir() / "sparse.tif", raster, {{123'456, 77'777, 321}});
    const Result info = limited({"-q", "info", path}, 3, 60);
    EXPECT_EQ(info.status, 0) << info.err;
    EXPECT_NE(info.out.find("posts      200000 x 200000\n"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("heights    321.0 to 321.0 m\n"), std::string::npos) << info.out;
}

TEST(DemOptions, MemoryHoldsOfDemsOfAnySize) {
    // 75 GiB of heights, of which the file stores some 25 MiB.
    Raster raster;
    raster.type = "Int16";
    raster.crs = "EPSG:4326";
    raster.columns = raster.rows = 200'000;
    raster.geotransform = {{0, 0.0001, 0, 20, 0, -0.0001}};
    std::vector<std::array<double, 3>> posts;
    for (int i = 0; i < 400; ++i)
        posts.push_back({100'000.0 + i * 21, 100'000.0 + i * 17, 300.0 + i});
    raster.options = {"TILED=YES", "SPARSE_OK=YES", "COMPRESS=DEFLATE"};
    const std::string file = write_sparse_raster(dir() / "vast.tif", raster, posts);
    const std::string csv = (dir() / "horizon.csv").string(), png = (dir() / "sparse.png").string();
    struct Case {
        std::vector<std::string> arguments;
        int most_mib;
    };
    for (const Case& c :
         {Case{{"info", file}, 800}, Case{{"info", file, "--memory", "64"}, 600},
          Case{{"sun", "horizon", file, "--at", "10,10", "-o", csv, "--overwrite"}, 900},
          Case{
              {"sun", "horizon", file, "--at", "10,10", "-o", csv, "--overwrite", "--memory", "64"},
              500},
          Case{{"capture", file, "-o", png, "--overwrite", "--device", "software", "--size",
                "320x240"},
               2600},
          Case{{"capture", file, "-o", png, "--overwrite", "--device", "software", "--size",
                "320x240", "--memory", "64"},
               1300}}) {
        std::vector<std::string> arguments{"-q"};
        arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
        const Measured found = measured(arguments);
        const std::string what = fmt::format("{}", fmt::join(c.arguments, " "));
        fmt::print("[ memory ] {} MiB, {:.1f} s: {}\n", found.peak_mib, found.processor_s, what);
        EXPECT_EQ(found.run.status, 0) << what << "\n" << found.run.err;
        EXPECT_LT(found.peak_mib, c.most_mib) << what;
        EXPECT_LT(found.processor_s, 60) << what;
    }
}

TEST(DemOptions, ClaimsAreDrawnOrRefusedSoon) {
    // Nothing at all in so many posts, and cells as wide as the program takes them.
    const std::filesystem::path vrt = dir() / "everything.vrt";
    std::ofstream(vrt)
        << "<VRTDataset rasterXSize=\"2147483647\" rasterYSize=\"2147483647\"><SRS>EPSG:4326</SRS>"
           "<GeoTransform>0,0.00000001,0,1,0,-0.00000001</GeoTransform>"
           "<VRTRasterBand dataType=\"Float32\" band=\"1\"/></VRTDataset>";
    Raster raster;
    raster.type = "Int16";
    raster.crs = "EPSG:4326";
    raster.columns = 300'000'000;
    raster.rows = 2;
    raster.geotransform = {{0, 1e-7, 0, 1, 0, -1e-7}};
    raster.options = {"TILED=YES", "SPARSE_OK=YES", "BLOCKXSIZE=65536", "BLOCKYSIZE=16"};
    const std::string narrow =
        write_sparse_raster(dir() / "narrow.tif", raster, {{150'000'000, 1, 77}});
    const std::string png = (dir() / "claim.png").string(), csv = (dir() / "claim.csv").string();
    struct Case {
        std::vector<std::string> arguments;
        int status;
        std::string message;
    };
    const auto refused = [](const std::string& path, const char* posts) {
        return fmt::format(
            "{}: {} posts, expected at most 4194304 a side; crop it with gdal_translate", path,
            posts);
    };
    const std::string many = refused(vrt.string(), "2147483647 x 2147483647");
    const std::string wide = refused(narrow, "300000000 x 2");
    for (const Case& c :
         {Case{{"info", vrt.string()}, 0, ""}, Case{{"info", narrow}, 0, ""},
          Case{{"capture", vrt.string(), "-o", png, "--device", "software"}, 3, many},
          Case{{"capture", narrow, "-o", png, "--device", "software"}, 3, wide},
          Case{{"sun", "horizon", vrt.string(), "--at", "-9.9,10", "-o", csv}, 3, many},
          Case{{"sun", "horizon", narrow, "--at", "0.9999999,15", "-o", csv}, 3, wide}}) {
        std::vector<std::string> arguments{"-q"};
        arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
        const Measured found = measured(arguments);
        const std::string what = fmt::format("{}", fmt::join(c.arguments, " "));
        fmt::print("[ memory ] {} MiB, {:.1f} s: {}\n", found.peak_mib, found.processor_s, what);
        EXPECT_EQ(found.run.status, c.status) << what << "\n" << found.run.err;
        EXPECT_EQ(found.run.err, c.message.empty() ? "" : "relevo: error: " + c.message + "\n");
        EXPECT_LT(found.peak_mib, 1600) << what;
        EXPECT_LT(found.processor_s, 60) << what;
    }
}

TEST(DemOptions, MemoryIsInMiB) {
    // Two rows cannot be averaged: they are kept whole or not at all. 43,690 x 2 posts of 12
    // bytes are 1 MiB, 1.049 MB.
    Raster raster;
    raster.crs = "EPSG:4326";
    raster.rows = 2;
    raster.geotransform = {{7, 1e-5, 0, 46, 0, -1e-5}};
    const auto of_columns = [&](int columns) {
        raster.columns = columns;
        return relevo({"-q", "info", write_raster(dir() / "mib.tif", raster), "--memory", "1",
                       "--time", "sunrise", "--date", "2026-06-21", "--tz", "UTC"});
    };
    const Result fits = of_columns(43'690);
    EXPECT_EQ(fits.status, 0) << fits.err;
    const Result more = of_columns(43'691);
    EXPECT_EQ(more.status, 3);
    EXPECT_NE(more.err.find("too narrow to be averaged; pass --memory 2 or more"),
              std::string::npos)
        << more.err;
}

TEST(DemOptions, TakeTheirValues) {
    Raster picture;
    picture.driver = "PNG";
    picture.type = "Byte";
    picture.crs = "";
    picture.geotransform.reset();
    picture.bands = 3;
    picture.columns = picture.rows = 16;
    picture.value = [](int column, int row, int band) {
        return ((300 + column + row + 10000) * 10) >> (8 * (3 - band)) & 255;
    };
    const std::string path = write_raster(dir() / "coded.png", picture);
    const Result run = relevo(
        {"info", path, "--json", "--encoding", "terrain-rgb", "--bounds", "-10,46,-9.9,46.1"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["elevation_m"]["max"], 330);
    EXPECT_EQ(json["center"]["lat_deg"], 46.05);
    EXPECT_EQ(json["center"]["lon_deg"], -9.95);
    EXPECT_EQ(json["unit_source"], "encoding");
}

TEST(DemOptions, WrongOnesHaveTheirMessages) {
    const struct {
        std::vector<std::string> options;
        int status;
        std::string message;
    } cases[] = {
        {{"--nodata", "abc"}, 2, "--nodata: expected a number or none but got \"abc\""},
        {{"--bounds", "1,2,3"}, 2, "--bounds: 1,2,3: expected WEST,SOUTH,EAST,NORTH in degrees"},
        {{"--unit", "furlong"},
         2,
         "--unit: furlong: a unit of height, expected m, ft, us-ft, cm, mm, dm or km"},
        {{"--crs", "EPSG:999999"},
         3,
         bundled_dem() +
             ": EPSG:999999: not a coordinate reference system that PROJ knows, crs not found; "
             "write EPSG:n, WKT or a PROJ string"},
        {{"--band", "7"},
         3,
         bundled_dem() + ": band, expected 1 to 1 but got 7; --band counts from 1"},
        {{"--encoding", "terrarium"},
         3,
         bundled_dem() +
             ": --encoding terrarium, expected red, green and blue bands of 8 bits but got one "
             "band of Int16"},
    };
    for (const auto& c : cases)
        for (const char* verb : {"info", "capture"}) {
            std::vector<std::string> arguments{verb, bundled_dem()};
            arguments.insert(arguments.end(), c.options.begin(), c.options.end());
            const std::string out = (dir() / "out.png").string();
            if (verb == std::string("capture"))
                arguments.insert(arguments.end(), {"-o", out, "--size", "64x64"});
            const Result run = relevo(arguments);
            EXPECT_EQ(run.status, c.status) << run.err;
            EXPECT_EQ(run.err, "relevo: error: " + c.message + "\n");
            EXPECT_EQ(run.out, "");
            EXPECT_FALSE(std::filesystem::exists(out));
        }
}

TEST(DemOptions, PicturesAreNoDems) {
    Raster picture;
    picture.type = "Byte";
    picture.bands = 3;
    picture.columns = picture.rows = 64;
    picture.pictures = true;
    picture.value = [](int column, int row, int band) {
        return (column * 97 + row * 61 + band * 131 + column * row * 7) % 256;
    };
    const std::string path = write_raster(dir() / "photo.tif", picture);
    const Result run = relevo({"capture", path, "-o", (dir() / "out.png").string()});
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.err,
              "relevo: error: " + path +
                  ": a picture (red, green and blue bands of 8 bits), expected heights; if its "
                  "colours encode heights pass --encoding terrain-rgb or terrarium, if one band "
                  "holds them --band N\n");
}

TEST(DoctorVerb, NamesTheDeviceAndWhy) {
    const Result run = relevo({"doctor", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    const nlohmann::json& device = json["device"];
    const int index = device["index"];
    EXPECT_FALSE(device["renderer"].get<std::string>().empty());
    EXPECT_TRUE(device["why"].get<std::string>().starts_with("the first that "));
    EXPECT_EQ(json["devices"][static_cast<std::size_t>(index)]["renderer"], device["renderer"]);
    for (const nlohmann::json& other : json["devices"]) {
        // Auto takes the first that can draw.
        if (other["index"].get<int>() < index) {
            EXPECT_FALSE(other["can_draw"]);
        }
        EXPECT_NE(other["renderer"].is_null(), other["reason"].is_null());
    }
    EXPECT_GE(device["limits"]["texture_size_px"], 4096);
    EXPECT_EQ(json["pictures"], "png, jpg, webp, avif, tif, exr");
    EXPECT_NE(json["films"].get<std::string>().find("mp4 libx264"), std::string::npos);
    EXPECT_EQ(json["share_found"], true);
    EXPECT_TRUE(json["broken_plugins"].empty()) << json["broken_plugins"];
    EXPECT_FALSE(json["plugins"].empty());
    EXPECT_EQ(json["plugin_folder"], json["share_dir"].get<std::string>() + "/plugins");

    const Result text = relevo({"doctor"});
    EXPECT_EQ(text.status, 0);
    EXPECT_NE(text.out.find("draws with " + device["renderer"].get<std::string>() + ", " +
                            device["version"].get<std::string>()),
              std::string::npos)
        << text.out;
}

TEST(DoctorVerb, PrintsTheGraphOfAFrame) {
    const Result run = relevo({"doctor", "--graph"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("digraph \"frame\" {\n")) << run.out;
    EXPECT_NE(run.out.find("\n}\ndigraph \"frame from outside\" {\n"), std::string::npos);
    EXPECT_NE(run.out.find("  \"pass geometry\" -> \"depth\";\n"), std::string::npos);
    const Result both = relevo({"doctor", "--graph", "--json"});
    EXPECT_EQ(both.status, 2);
    EXPECT_EQ(both.err, "relevo: error: --json excludes --graph; see relevo doctor --help\n");
}

TEST(DoctorVerb, AsksForTheDeviceThatIsWanted) {
    const Result run = relevo({"doctor", "--json", "--device", "software"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(nlohmann::json::parse(run.out)["device"]["software"], true);
    EXPECT_EQ(nlohmann::json::parse(run.out)["device"]["why"], "--device software asks for it");
}

TEST(DoctorVerb, WithoutADeviceSaysWhatToDoAndExitsWithFour) {
    const Result run =
        relevo({"doctor", "--json"}, {"__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere/none.json"});
    EXPECT_EQ(run.status, 4);
    EXPECT_EQ(run.err,
              "relevo: error: gl: no GL device: EGL offers none; install Mesa's software renderer "
              "(libegl1, libegl-mesa0, libgl1-mesa-dri)\n");
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_TRUE(json["device"].is_null());
    EXPECT_TRUE(json["devices"].empty());
    const std::string advice = json["advice"].dump();
    EXPECT_NE(advice.find("__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere/none.json is set"),
              std::string::npos);
    EXPECT_NE(advice.find("install Mesa's software renderer"), std::string::npos);
    const Result wanted = relevo({"doctor", "--device", "voodoo"});
    EXPECT_EQ(wanted.status, 4);
    EXPECT_TRUE(wanted.out.find("draws with nothing\n") != std::string::npos) << wanted.out;
}

TEST(DoctorVerb, SaysWhereItsDataAreNot) {
    const Result run = relevo({"doctor"}, {"RELEVO_SHARE=/nowhere"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("data       /nowhere (not there; RELEVO_SHARE names another)\n"),
              std::string::npos)
        << run.out;
}

}  // namespace
}  // namespace relevo::test::test_info
