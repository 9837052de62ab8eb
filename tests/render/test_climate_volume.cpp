// What a shader gets of the climate: that of the place, wherever on the Earth the DEM lies.

#include <cmath>

#include <fmt/format.h>

#include "climate/cover_table.h"
#include "drawn.h"
#include "light/fields.h"

namespace relevo::render::test_climate_volume {
namespace {

using test::Drawn;
using test::TestEffect;

constexpr int kSide = 65;
constexpr double kHeight_m = 1500;  // that the shader asks for

struct Case {
    const char* name;
    dem::Affine affine;
    const char* crs;
};

/// Their middles are places of the table's net.
const Case kTyrol{"Tyrol", {11, 1.0 / 64, 0, 48, 0, -1.0 / 64}, "EPSG:4326"};
const Case kFiji{"Fiji, across 180 degrees", {179, 1.0 / 32, 0, -16, 0, -1.0 / 32}, "EPSG:4326"};
const Case kArctic{"North Pole", {-320000, 10000, 0, 320000, 0, -10000}, "EPSG:3413"};
const Case kAntarctic{"South Pole", {-320000, 10000, 0, 320000, 0, -10000}, "EPSG:3031"};

dem::Heightfield plain(const Case& c) {
    return test::field_of(kSide, kSide, c.affine, c.crs,
                          [](int column, int row) { return 100.0 + (column + row) % 2; });
}

/// What the shader makes of two expressions, at a share of the picture's sides, seen from above.
std::vector<glm::dvec2> read(const Case& c, const std::string& values, const char* utc,
                             const std::vector<glm::dvec2>& shares) {
    const TestEffect probe{
        "probe",
        "//@ include lib/climate.glsl\n"
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    vec2 place = climate_place(s.up);\n"
        "    radiance = vec3(" +
            values + ", 1.0) / frame.exposure;\n}\n"};
    Drawn drawn(plain(c), {test::kBrightSky, probe}, 65, 65);
    drawn.frame().unix_s = static_cast<double>(sun::parse_time(utc).utc.unix_us()) * 1e-6;
    // Light by which to see it.
    const double lon_deg = drawn.dem().grid.center().lon_rad * 180 / kPi;
    drawn.shine(
        fmt::format("2026-03-21T{:02}:00Z", (36 - static_cast<int>(std::lround(lon_deg / 15))) % 24)
            .c_str());
    const glm::dvec2 side_m = drawn.dem().grid.sides_m();
    drawn.stand(0.5, 0.5, 0.9 * std::max(side_m.x, side_m.y), 0, -90);
    const image::ImageF image = drawn.radiance();
    std::vector<glm::dvec2> found;
    for (const glm::dvec2& share : shares) {
        const int x = static_cast<int>(share.x * 64), y = static_cast<int>(share.y * 64);
        EXPECT_FALSE(test::is_sky(image, x, y)) << c.name;
        found.push_back(Drawn::values(image, x, y));
    }
    return found;
}

TEST(ClimateVolume, ShaderGetsTheColumnOfThePlace) {
    const climate::ClimateMap map = climate::ClimateMap::shipped();
    for (const Case& c : {kTyrol, kFiji, kArctic, kAntarctic}) {
        const geo::Geodetic middle = plain(c).grid.center();
        const climate::CoverColumn column(map.at(middle));
        const auto values = [&](const std::string& text) {
            return read(c, text, "2026-04-11T12:00Z", {{0.5, 0.5}})[0];
        };
        const std::string ground = fmt::format("climate_ground(place, {:.1f})", kHeight_m);
        const std::string snow = fmt::format("climate_snow(place, {:.1f})", kHeight_m);
        const double day = climate::day_of_year(4, 11);
        // Halves have 11 bits, twice; heights are 40 m apart.
        const glm::dvec2 lasting = values(ground + ".dryness / 8.0, " + ground + ".growth / 8.0");
        EXPECT_NEAR(8 * lasting.x, column.dryness(kHeight_m), 0.03) << c.name;
        EXPECT_NEAR(8 * lasting.y, column.growth(kHeight_m), 0.03) << c.name;
        const glm::dvec2 dated = values(ground + ".green, " + ground + ".temperature / 64.0");
        EXPECT_NEAR(dated.x, column.green(kHeight_m, day), 0.03) << c.name;
        EXPECT_NEAR(64 * dated.y, column.mean_c(kHeight_m), 0.3) << c.name;
        const glm::dvec2 white = values(snow + ".x / 16.0, " + snow + ".y");
        EXPECT_NEAR(16 * white.x, column.ice_balance_mm(kHeight_m) / 1000, 1.6) << c.name;
        // A mean over 100 m of height.
        EXPECT_NEAR(white.y, column.snow_share(kHeight_m, day), 0.35) << c.name;
    }
}

TEST(ClimateVolume, PlacesRunEastAndNorth) {
    for (const Case& c : {kTyrol, kFiji}) {
        const std::vector<glm::dvec2> found =
            read(c, "place + 1e-6 * climate_snow(place, 1500.0)", "2026-04-11T12:00Z",
                 {{0.3, 0.5}, {0.7, 0.5}, {0.5, 0.3}, {0.5, 0.7}});
        EXPECT_NEAR(0.5 * (found[0].x + found[1].x), 0.5, 0.02) << c.name;
        EXPECT_GT(found[1].x, found[0].x + 0.1) << c.name;
        EXPECT_NEAR(0.5 * (found[2].y + found[3].y), 0.5, 0.02) << c.name;
        EXPECT_GT(found[2].y, found[3].y + 0.1) << c.name;  // rows of pictures run down
    }
}

TEST(ClimateVolume, SnowIsOfTheFramesDate) {
    const auto share = [](const char* utc) {
        return read(kTyrol, "climate_snow(place, 1500.0).y, 1.0", utc, {{0.5, 0.5}})[0].x;
    };
    EXPECT_GT(share("2026-02-10T12:00Z"), 0.9);
    EXPECT_LT(share("2026-08-10T12:00Z"), 0.05);
}

TEST(ClimateVolume, BoxesHoldTheWholeGridOnce) {
    const auto box = [](const Case& c) {
        const dem::Grid grid = plain(c).grid;
        return box_of(grid, grid.center());
    };
    const climate::Box fiji = box(kFiji);
    EXPECT_NEAR(fiji.east_deg - fiji.west_deg, 2, 1e-6);
    EXPECT_NEAR(fiji.south_deg, -18, 1e-6);
    const climate::Box arctic = box(kArctic);
    EXPECT_NEAR(arctic.east_deg - arctic.west_deg, 360, 1e-6);
    EXPECT_EQ(arctic.north_deg, 90);
    EXPECT_LT(arctic.south_deg, 87);
    const climate::Box world =
        box({"world", {-180, 360.0 / 64, 0, 90, 0, -180.0 / 64}, "EPSG:4326"});
    EXPECT_NEAR(world.east_deg - world.west_deg, 360, 1e-6);
    EXPECT_EQ(world.south_deg, -90);
    EXPECT_EQ(world.north_deg, 90);
}

}  // namespace
}  // namespace relevo::render::test_climate_volume
