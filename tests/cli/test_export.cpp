#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "support/support.h"

/// `relevo export`, from file to file.
namespace relevo::test::test_export {
namespace {

namespace fs = std::filesystem;

std::string out(const std::string& name) {
    return (folder() / name).string();
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

template <typename T>
std::vector<T> values_of(const std::string& path, int band = 1) {
    const Dataset dataset = opened(path);
    if (!dataset) return {};
    const int columns = dataset->GetRasterXSize(), rows = dataset->GetRasterYSize();
    std::vector<T> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const GDALDataType type = std::is_same_v<T, float> ? GDT_Float32 : GDT_UInt16;
    EXPECT_EQ(dataset->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, columns, rows, values.data(),
                                                     columns, rows, type, 0, 0),
              CE_None);
    return values;
}

TEST(ExportVerb, HeightmapsAreTheHeightsWithinHalfAStep) {
    const Result png = relevo({"export", "heightmap", bundled_dem(), "-o", out("a.png")});
    ASSERT_EQ(png.status, 0) << png.err;
    ASSERT_EQ(relevo({"export", "heightmap", bundled_dem(), "-o", out("a.r16")}).status, 0);
    EXPECT_EQ(png.out,
              "posts       403 x 344, 74.85 x 92.47 m apart\n"
              "heights     236 to 1076 m, 0 to 65535 in steps of 0.01282 m\n");
    const nlohmann::json scale = nlohmann::json::parse(bytes_of(out("a.png.json")));
    EXPECT_EQ(scale, nlohmann::json::parse(bytes_of(out("a.r16.json"))));
    EXPECT_EQ(opened(out("a.png"))->GetRasterBand(1)->GetRasterDataType(), GDT_UInt16);
    const auto values = values_of<std::uint16_t>(out("a.png"));
    const auto heights = values_of<float>(bundled_dem());
    const double offset = scale["height_m"]["offset"], step = scale["height_m"]["step"];
    ASSERT_EQ(values.size(), heights.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_NEAR(offset + step * values[i], heights[i], step / 2 * 1.0001) << i;
    const std::string raw = bytes_of(out("a.r16"));
    ASSERT_EQ(raw.size(), 2 * values.size());
    EXPECT_EQ(std::memcmp(raw.data(), values.data(), raw.size()), 0);
}

TEST(ExportVerb, HeightmapsHaveTheSizeOfGameEngines) {
    const Result run = relevo({"export", "heightmap", bundled_dem(), "-o", out("a.raw"), "--size",
                               "257x129", "--range", "0,2000", "--exaggerate", "1.5"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(bytes_of(out("a.raw")).size(), 2U * 257 * 129);
    const nlohmann::json scale = nlohmann::json::parse(bytes_of(out("a.raw.json")));
    EXPECT_EQ(scale["height_m"]["offset"], 0);
    EXPECT_NEAR(scale["height_m"]["range"].get<double>(), 2000, 1e-9);
    EXPECT_EQ(scale["exaggeration"], 1.5);
}

TEST(ExportVerb, NormalMapsHaveEightOrSixteenBits) {
    ASSERT_EQ(relevo({"export", "normals", bundled_dem(), "-o", out("a.png")}).status, 0);
    ASSERT_EQ(relevo({"export", "normals", bundled_dem(), "-o", out("b.png"), "--bits", "16",
                      "--green", "down"})
                  .status,
              0);
    EXPECT_EQ(opened(out("a.png"))->GetRasterBand(1)->GetRasterDataType(), GDT_Byte);
    EXPECT_EQ(opened(out("b.png"))->GetRasterBand(1)->GetRasterDataType(), GDT_UInt16);
    for (int band = 1; band <= 3; ++band) {
        const auto a = values_of<std::uint16_t>(out("a.png"), band);
        const auto b = values_of<std::uint16_t>(out("b.png"), band);
        for (std::size_t i = 0; i < a.size(); ++i)
            ASSERT_NEAR(a[i], band == 2 ? 255 - b[i] / 257.0 : b[i] / 257.0, 0.51) << i;
    }
}

TEST(ExportVerb, MeshesSayTheirErrorAndTheirPlace) {
    const Result run =
        relevo({"export", "mesh", bundled_dem(), "-o", out("a.glb"), "--error", "20"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("for 138632 posts\nerror       worst "), std::string::npos) << run.out;
    const std::string bytes = bytes_of(out("a.glb"));
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, bytes.data() + 12, 4);
    const nlohmann::json json = nlohmann::json::parse(bytes.substr(20, json_bytes));
    const nlohmann::json extras = json["asset"]["extras"];
    EXPECT_NEAR(extras["origin"]["lat_deg"].get<double>(), 36.30292, 1e-5);
    EXPECT_NEAR(extras["origin"]["lon_deg"].get<double>(), -84.24583, 1e-5);
    EXPECT_EQ(extras["crs"], "EPSG:4326");
    EXPECT_LE(extras["error_m"]["worst"].get<double>(), 20);
    EXPECT_EQ(extras["error_m"]["allowed"], 20);
    EXPECT_TRUE(json["asset"]["generator"].get<std::string>().starts_with("Relevo "));
    EXPECT_EQ(json["accessors"].size(), 4U);  // positions, normals, texture, indices
}

/// Volume of a binary STL [mm^3].
double stl_volume_mm3(const std::string& bytes) {
    double sum = 0;
    for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
        float v[12];
        std::memcpy(v, bytes.data() + at, sizeof v);
        sum += v[3] * (double(v[7]) * v[11] - double(v[8]) * v[10]) +
               v[4] * (double(v[8]) * v[9] - double(v[6]) * v[11]) +
               v[5] * (double(v[6]) * v[10] - double(v[7]) * v[9]);
    }
    return sum / 6;
}

TEST(ExportVerb, SolidsForPrintingHaveAScale) {
    const Result run = relevo({"export", "mesh", bundled_dem(), "-o", out("a.stl"), "--error", "20",
                               "--base", "0", "--scale", "1:250000"});
    ASSERT_EQ(run.status, 0) << run.err;
    // The ground is 30.089 x 31.717 km and 1076 m high: at this scale 120 x 127 x 4.3 mm.
    EXPECT_NE(run.out.find("model       1:250000, 120.4 x 126.9 x 4.3 mm"), std::string::npos)
        << run.out;
    double sum_m = 0;
    for (const float height_m : values_of<float>(bundled_dem()))
        sum_m += height_m;
    const double expected = 120.356 * 126.870 * sum_m / (403 * 344) / 250;
    EXPECT_NEAR(stl_volume_mm3(bytes_of(out("a.stl"))) / expected, 1, 0.005);
}

TEST(ExportVerb, ResultsAppearTogetherOrNotAtAll) {
    std::ofstream(out("a.png.json")) << "mine";
    expect_failure(
        {"export", "heightmap", bundled_dem(), "-o", out("a.png")}, 3,
        fmt::format("-o: {}: exists; pass --overwrite to replace it", out("a.png.json")));
    EXPECT_FALSE(fs::exists(out("a.png")));
    EXPECT_EQ(bytes_of(out("a.png.json")), "mine");
    Raster raster;
    raster.driver = "PNG";
    raster.type = "UInt16";
    raster.geotransform = std::nullopt;
    raster.crs = "";
    const std::string dem = write_raster(folder() / "dem.png", raster);
    const std::string before = bytes_of(dem);
    const Result run = relevo({"export", "normals", dem, "--crs", "EPSG:4326", "--bounds",
                               "10,46,10.1,46.1", "-o", dem, "--overwrite"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("which would be overwritten; give the result another name"),
              std::string::npos)
        << run.err;
    EXPECT_EQ(bytes_of(dem), before);
}

TEST(ExportVerb, PagesHaveTheirDemAndSayWhatIsWrong) {
    const std::string dem = bundled_dem(), html = out("a.html");
    const Result run = relevo({"export", "web", dem, "-o", html, "--megabytes", "0.5"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("posts       403 x 344\n"), std::string::npos) << run.out;
    EXPECT_LE(bytes_of(html).size(), 500000U);
    EXPECT_EQ(bytes_of(html).rfind("<!doctype html>", 0), 0U);
    const auto fails = [&](std::vector<std::string> more, int status, const std::string& message) {
        more.insert(more.begin(), {"export", "web", dem, "-o", out("b.html")});
        expect_failure(more, status, message);
        EXPECT_FALSE(std::filesystem::exists(out("b.html")));
    };
    fails({"--ortho"}, 2, "--ortho: a web page has a plain camera; remove it");
    fails({"--panorama", "cylindrical"}, 2, "--panorama: a web page has a plain camera; remove it");
    fails({"--megabytes", "0.2"}, 2,
          "--megabytes: expected 0.3 to 100 but got 0.2; see relevo export web --help");
    const Result small = relevo({"export", "web", dem, "-o", out("b.html"), "--crop",
                                 "-84.28,36.25,-84.2,36.33", "--megabytes", "0.3"});
    EXPECT_EQ(small.status, 3);
    EXPECT_EQ(
        small.err,
        "relevo: time zone America/New_York of the place; --tz sets another\n"
        "relevo: error: export web: --megabytes: leaves no room for heights; expected more\n");
    EXPECT_FALSE(std::filesystem::exists(out("b.html")));
    fails({"--view", "az=0,el=-80"}, 1,
          "export web: the first view shows only sky; turn the camera");
    expect_failure({"export", "web", dem, "-o", html}, 3,
                   "-o: " + html + ": exists; pass --overwrite to replace it");
    expect_failure(
        {"export", "web", dem, "-o", dem, "--overwrite"}, 2,
        "-o: " + dem + ": no format that this command writes, expected a name that ends in html");
}

TEST(ExportVerb, SaysWhatIsWrong) {
    const std::string dem = bundled_dem(), glb = out("a.glb"), stl = out("a.stl");
    const std::string see = "; see relevo export mesh --help";
    for (const char* error : {"0", "-1", "nan", "1e9"})
        expect_failure({"export", "mesh", dem, "-o", glb, "--error", error}, 2,
                       fmt::format("--error: expected 0.001 to 10000 but got {}{}", error, see));
    expect_failure({"export", "mesh", dem, "-o", "a.obj"}, 2,
                   "-o: a.obj: no format that this command writes, expected a name that ends in "
                   "glb, stl");
    expect_failure({"export", "mesh", dem, "-o", glb, "--width-mm", "100"}, 2,
                   "--scale and --width-mm need a .stl; .glb is in metres of the ground");
    expect_failure({"export", "mesh", dem, "-o", stl, "--scale", "1:0"}, 2,
                   "--scale: expected 1:N such as 1:25000 but got 1:0");
    expect_failure({"export", "mesh", dem, "-o", stl, "--base", "500"}, 3,
                   "--base: 500: expected a height below the lowest post, 236 m");
    expect_failure({"export", "mesh", dem, "-o", glb, "--holes", "mark"}, 2,
                   "--holes: mark paints pictures, expected fill or cut");
    expect_failure({"export", "heightmap", dem, "-o", out("a.png"), "--range", "5,1"}, 2,
                   "--range: expected LOW,HIGH in metres, such as 0,4000, but got 5,1");
    expect_failure({"export", "heightmap", dem, "-o", out("a.png"), "--range", "300,900"}, 3,
                   "--range: 300,900: expected to contain all heights, 236 to 1076 m");
    expect_failure({"export", "heightmap", dem, "-o", out("a.png"), "--size", "65536x65536"}, 3,
                   fmt::format("{}: 65536 x 65536 heights take 49152 MiB, expected at most 3072; "
                               "pass --size 4097x4097, --crop W,S,E,N or --memory 49152",
                               dem));
    EXPECT_FALSE(fs::exists(glb) || fs::exists(stl) || fs::exists(out("a.png")));
}

TEST(ExportVerb, VoidsAreFilledAsPicturesAreOrCut) {
    Raster raster;
    raster.columns = raster.rows = 60;
    raster.nodata = -1;
    raster.value = [](int column, int row, int) {
        return std::hypot(column - 30, row - 30) < 6 ? -1.0 : 100.0 + column;
    };
    const std::string dem = write_raster(folder() / "dem.tif", raster);
    const Result filled = relevo({"export", "mesh", dem, "-o", out("a.stl"), "--base", "0"});
    const Result cut =
        relevo({"export", "mesh", dem, "-o", out("b.stl"), "--base", "0", "--holes", "cut"});
    ASSERT_EQ(filled.status, 0) << filled.err;
    ASSERT_EQ(cut.status, 0) << cut.err;
    EXPECT_NE(filled.out.find(" for 3600 posts"), std::string::npos) << filled.out;
    EXPECT_EQ(cut.out.find(" for 3600 posts"), std::string::npos) << cut.out;
    // Of 59 x 59 cells those around the void are left out.
    const double ratio =
        stl_volume_mm3(bytes_of(out("b.stl"))) / stl_volume_mm3(bytes_of(out("a.stl")));
    EXPECT_NEAR(ratio, 1 - 3.1416 * 6.5 * 6.5 / (59 * 59), 0.01);
}

// Coordinates of 32 bits are a step of 0.06 m apart at 800 km.
TEST(ExportVerb, CoordinatesOfHighGroundAreAsExactAsTheErrorNeeds) {
    Raster raster;
    raster.columns = raster.rows = 8;
    raster.value = [](int column, int row, int) { return 8000.0 + column * 0.7 + row * 0.3; };
    const std::string dem = write_raster(folder() / "high.tif", raster);
    const Result made = relevo({"export", "mesh", dem, "-o", out("high.glb"), "--flat", "--error",
                                "0.01", "--exaggerate", "100"});
    EXPECT_EQ(made.status, 3) << made.out;
    EXPECT_NE(made.err.find("smaller than what 32-bit coordinates hold"), std::string::npos)
        << made.err;
    for (const char* size : {"1x9", "9x1"})
        expect_failure({"export", "normals", dem, "-o", out("n.png"), "--size", size}, 2,
                       fmt::format("--size: {}: expected at least 2 columns and rows", size));
}

}  // namespace
}  // namespace relevo::test::test_export
