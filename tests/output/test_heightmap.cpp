#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include <nlohmann/json.hpp>

#include "dem/fixture.h"
#include "dem/load.h"
#include "output/export_text.h"
#include "output/exported_ground.h"
#include "output/heightmap.h"
#include "support/support.h"

namespace relevo::output {
namespace {

ExportedGround bundled(const ExportOptions& options = {}, const dem::LoadOptions& how = {}) {
    const std::string path = (test::source_dir() / "data/dem/jacksboro.tif").string();
    return read_ground(dem::Source::open(path, how), how, options);
}

TEST(Heightmap, IsWithinHalfAStep) {
    const ExportedGround ground = bundled();
    const HeightScale scale = height_scale(236, 1076);
    const image::Image16 map = heightmap(ground.field.height_m, scale);
    double worst = 0;
    bool lowest = false, highest = false;
    for (int row = 0; row < map.height; ++row)
        for (int column = 0; column < map.width; ++column) {
            const std::uint16_t value = map.at(column, row, 0);
            lowest = lowest || value == 0;
            highest = highest || value == kMostValue;
            worst = std::max(worst, std::abs(scale.offset_m + scale.step_m * value -
                                             ground.field.height_m.at(column, row)));
        }
    EXPECT_LE(worst, scale.step_m / 2 * (1 + 1e-6));
    EXPECT_TRUE(lowest && highest);
}

TEST(Heightmap, OfAPlainAndOfVoidsIsZero) {
    Array2d<float> height_m(4, 3, 812);
    height_m.at(2, 1) = std::numeric_limits<float>::quiet_NaN();
    const HeightScale scale = height_scale(812, 812);
    EXPECT_EQ(scale.step_m, 1);
    for (const std::uint16_t value : heightmap(height_m, scale).values)
        EXPECT_EQ(value, 0);
}

TEST(Heightmap, RawHasTheLowByteFirst) {
    const auto path = test::scratch_dir() / "a.r16";
    image::Image16 map(2, 1, 1);
    map.values = {0x0102, 0xfffe};
    OutputFile file(path, true, "test");
    write_raw(file, map);
    file.finish();
    std::ifstream read(path, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(read), {}), "\x02\x01\xfe\xff");
}

TEST(ReadGround, FewerPostsAreMeans) {
    test::Raster raster;
    raster.columns = 40;
    raster.rows = 20;
    raster.value = [](int column, int row, int) {
        return column / 4 * 10.0 + row / 2 + column % 2;
    };
    const std::string path = test::write_raster(test::folder() / "steps.tif", raster);
    const ExportedGround ground =
        read_ground(dem::Source::open(path), {}, {.exaggeration = 2, .size = glm::ivec2(10, 10)});
    for (int row = 0; row < 10; ++row)
        for (int column = 0; column < 10; ++column)
            EXPECT_FLOAT_EQ(ground.field.height_m.at(column, row),
                            2 * (column * 10.F + static_cast<float>(row) + 0.5F));
    // In the middle of their 4 x 2 posts of 30 m.
    EXPECT_EQ(ground.field.grid.affine()(0, 0), glm::dvec2(500060, 5200000 - 30));
    EXPECT_EQ(ground.dem_posts, glm::ivec2(40, 20));
}

TEST(ReadGround, MorePostsAreBetweenTheFirstAndTheLast) {
    const ExportedGround all = bundled(), more = bundled({.size = glm::ivec2(1025, 1025)});
    EXPECT_EQ(more.field.grid.columns(), 1025);
    for (const auto& [column, row] : {std::pair(0, 0), std::pair(1024, 0), std::pair(1024, 1024)})
        EXPECT_EQ(more.field.height_m.at(column, row),
                  all.field.height_m.at(column * 402 / 1024, row * 343 / 1024));
    const glm::dvec2 last = all.field.grid.affine()(402, 343);
    EXPECT_NEAR(more.field.grid.affine()(1024, 1024).x, last.x, 1e-9);
    EXPECT_NEAR(more.field.grid.affine()(1024, 1024).y, last.y, 1e-9);
    EXPECT_NEAR(more.field.height_m.at(100, 200),
                all.field.height_at(100 * 402 / 1024.0, 200 * 343 / 1024.0), 1e-3);
}

TEST(ReadGround, RefusesWhatMemoryDoesNotHold) {
    dem::LoadOptions how;
    how.memory = MemoryBudget::of_mib(1);
    const std::string error = test::error_of([&] { bundled({.remedy = "--size 65x65"}, how); });
    EXPECT_TRUE(
        error.ends_with("jacksboro.tif: 403 x 344 heights take 2 MiB, expected at most 1; "
                        "pass --size 65x65, --crop W,S,E,N or --memory 2"))
        << error;
    EXPECT_EQ(bundled({.size = glm::ivec2(65, 65)}, how).field.grid.rows(), 65);
}

/// A cone of known slope on a grid of 20 x 30 m.
dem::Heightfield cone() {
    const dem::Grid grid(101, 81, {500000, 20, 0, 5200000, 0, -30},
                         geo::Crs::parse("EPSG:32632", "test"));
    dem::Heightfield field{Array2d<float>(101, 81), grid, {}, 1};
    for (int row = 0; row < 81; ++row)
        for (int column = 0; column < 101; ++column)
            field.height_m.at(column, row) =
                static_cast<float>(1000 - 0.5 * std::hypot(20 * (column - 50), 30 * (row - 40)));
    return field;
}

TEST(NormalMap, HasTheSlopeOfACone) {
    const image::Image16 map = normal_map(cone(), Green::Up);
    double worst_deg = 0;
    for (int row = 0; row < 81; ++row)
        for (int column = 0; column < 101; ++column) {
            const double east = 20 * (column - 50), north = -30 * (row - 40);
            const double far = std::hypot(east, north);
            if (far < 300) continue;  // differences of posts round the top off
            const glm::dvec3 expected =
                glm::normalize(glm::dvec3(0.5 * east / far, 0.5 * north / far, 1));
            glm::dvec3 found;
            for (int i = 0; i < 3; ++i)
                found[i] = 2.0 * map.at(column, row, i) / kMostValue - 1;
            worst_deg = std::max(
                worst_deg, std::acos(std::min(1.0, glm::dot(found, expected))) * 180 / 3.14159265);
        }
    EXPECT_LT(worst_deg, 1.1);  // one-sided at the edges; UTM's scale
}

TEST(NormalMap, GreenPointsDownForDirectX) {
    const dem::Heightfield field = cone();
    const image::Image8 up = to_8_bits(normal_map(field, Green::Up));
    const image::Image8 down = to_8_bits(normal_map(field, Green::Down));
    // North of the summit the ground looks north.
    EXPECT_GT(up.at(50, 5, 1), 170);
    EXPECT_LT(down.at(50, 5, 1), 85);
    EXPECT_NEAR(up.at(50, 5, 1) + down.at(50, 5, 1), 255, 1);
    // East of it, east.
    EXPECT_GT(up.at(95, 40, 0), 170);
    EXPECT_EQ(up.at(95, 40, 0), down.at(95, 40, 0));
}

TEST(NormalMap, VoidsPointUpAndTheirNeighboursHaveOneSide) {
    dem::Heightfield field = cone();
    for (int row = 0; row < 81; ++row)
        for (int column = 0; column < 101; ++column)
            field.height_m.at(column, row) = static_cast<float>(column * 20);  // 45 degrees
    field.height_m.at(30, 30) = std::numeric_limits<float>::quiet_NaN();
    const image::Image8 map = to_8_bits(normal_map(field, Green::Up));
    EXPECT_NEAR(map.at(30, 30, 0), 128, 1);
    EXPECT_EQ(map.at(30, 30, 2), 255);
    for (const int column : {0, 29, 31, 60, 100})
        EXPECT_NEAR(map.at(column, 30, 0), 127.5 * (1 - std::sqrt(0.5)), 1) << column;
}

TEST(MapJson, SaysWhereAndWhat) {
    const ExportedGround ground = bundled({.size = glm::ivec2(257, 257)});
    const HeightScale scale = height_scale(200, 1200);
    const nlohmann::json json =
        nlohmann::json::parse(map_json(ground, "Relevo test", &scale, nullptr));
    EXPECT_EQ(json["size"], (nlohmann::json{257, 257}));
    EXPECT_EQ(json["dem_size"], (nlohmann::json{403, 344}));
    EXPECT_EQ(json["crs"], "EPSG:4326");
    EXPECT_EQ(json["height_m"]["offset"], 200);
    EXPECT_NEAR(json["height_m"]["step"].get<double>() * kMostValue, 1000, 1e-9);
    EXPECT_FALSE(json.contains("normal"));
    EXPECT_FALSE(json["assumptions"].empty());
    const geo::Geodetic corner = ground.field.grid.place(256, 0);
    EXPECT_NEAR(json["corners"]["upper_right"]["lat_deg"].get<double>(),
                corner.lat_rad * 180 / 3.141592653589793, 1e-9);
    const double metres = json["first_to_last_m"][0];
    EXPECT_NEAR(metres, 256 * json["spacing_m"][0].get<double>(), 1e-6);
    EXPECT_NEAR(metres, 30089, 150);
}

}  // namespace
}  // namespace relevo::output
