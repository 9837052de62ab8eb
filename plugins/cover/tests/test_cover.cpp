#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "climate/cover.h"
#include "effect/effect.h"
#include "light/fields.h"
#include "render/drawn.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_cover {
namespace {

using test::Drawn;
using test::TestEffect;

// ---- what shape does

/// Sunniness of slopes of 30 degrees towards north, east, south and west.
std::vector<float> sunniness_at(double lat_deg) {
    test::GpuSnippet gpu("cover");
    const double lat_rad = lat_deg * kPi / 180;
    gpu.frame().polar_axis = glm::vec4(0, std::cos(lat_rad), std::sin(lat_rad), 0);
    const auto results = gpu.run(
        "Surface s;\n"
        "s.up = vec3(0.0, 0.0, 1.0);\n"
        "float azimuth = radians(90.0 * float(x));\n"
        "s.ground_normal = vec3(0.5 * sin(azimuth), 0.5 * cos(azimuth), sqrt(0.75));\n"
        "result = vec4(cover_sunniness(s));",
        4, 1);
    std::vector<float> sunny;
    for (const glm::vec4& result : results)
        sunny.push_back(result.x);
    return sunny;
}

TEST(Cover, SunnySlopesFaceTheEquator) {
    for (const double lat_deg : {47.0, 65.0, 30.0}) {
        const std::vector<float> north = sunniness_at(lat_deg), south = sunniness_at(-lat_deg);
        EXPECT_NEAR(north[0], -0.5, 0.01);
        EXPECT_NEAR(north[2], 0.5, 0.01);
        EXPECT_NEAR(south[0], 0.5, 0.01);
        EXPECT_NEAR(south[2], -0.5, 0.01);
        EXPECT_NEAR(north[1], 0, 0.01);
        EXPECT_NEAR(south[3], 0, 0.01);
    }
    for (const float sunny : sunniness_at(0))
        EXPECT_NEAR(sunny, 0, 0.01);
}

TEST(Cover, StepsOfPostsFarApartCountForMore) {
    test::GpuSnippet gpu("cover");
    gpu.frame().normal_texels_per_m = 1.0f / 10;
    const auto steepness = [&](double pixel_m) {
        return gpu
            .run(fmt::format("Surface s;\n"
                             "s.up = vec3(0.0, 0.0, 1.0);\n"
                             "s.ground_normal = vec3(0.5, 0.0, sqrt(0.75));\n"
                             "result = vec4(cover_steepness(s, {:.3f}));",
                             pixel_m),
                 1, 1)[0]
            .x;
    };
    EXPECT_NEAR(steepness(1), std::tan(kPi / 6), 1e-3);
    EXPECT_NEAR(steepness(80), std::tan(kPi / 6) * 1.375, 1e-3);
}

// ---- crowns

constexpr const char* kSeenFromTheSouth =
    "Surface s;\n"
    "s.up = vec3(0.0, 0.0, 1.0);\n"
    "s.ground_normal = vec3(0.0, 0.0, 1.0);\n"
    "s.position_m = vec3(0.0, 300.0, -300.0);\n"
    "s.distance_m = length(s.position_m);\n"
    "s.anchored_m = vec2(1.37 * float(x), 1.91 * float(y));\n";

TEST(Cover, ARayToTheEyeLeavesTheGroundByItsSlope) {
    test::GpuSnippet gpu("cover");
    gpu.frame().polar_axis = glm::vec4(0, std::cos(0.8), std::sin(0.8), 0);
    const glm::vec4 found =
        gpu.run(std::string(kSeenFromTheSouth) +
                    "result.xy = cover_slant(s);\n"
                    "s.ground_normal = vec3(0.0, -0.5, sqrt(0.75));\n"  // rises to the north
                    "result.zw = cover_slant(s);\n",
                1, 1)[0];
    EXPECT_NEAR(found.x, 0, 1e-4);
    EXPECT_NEAR(found.y, -1, 1e-4);
    EXPECT_NEAR(found.w, -1 / (1 + std::sqrt(1.0 / 3)), 1e-4);
}

TEST(Cover, TheCrownThatIsSeenIsTheFirstOnTheRay) {
    // Against the same ray in 200 steps.
    test::GpuSnippet gpu("cover");
    gpu.frame().polar_axis = glm::vec4(0, std::cos(0.8), std::sin(0.8), 0);
    const auto results = gpu.run(
        std::string(kSeenFromTheSouth) +
            "cover_Crown seen = cover_crown_seen(s, 7.5, vec2(0.0), 0.0), first = seen, below;\n"
            "for (int i = 0; i < 200; ++i) {\n"
            "    float height = 0.8 - 1.6 * float(i) / 199.0;\n"
            "    vec2 within;\n"
            "    ivec2 cell = ground_cell(s.anchored_m + height * 7.5 * cover_slant(s),\n"
            "                             cover_turn / 7.5, within);\n"
            "    first = cover_crown_at(cell, within, 0.0);\n"
            "    if (first.height >= height) break;\n"
            "}\n"
            "vec2 within;\n"
            "ivec2 cell = ground_cell(s.anchored_m, cover_turn / 7.5, within);\n"
            "below = cover_crown_at(cell, within, 0.0);\n"
            "result = vec4(seen.random, first.random, below.random, seen.height - first.height);",
        64, 64);
    int same = 0, same_below = 0;
    for (const glm::vec4& one : results) {
        same += one.x == one.y ? 1 : 0;
        same_below += one.z == one.y ? 1 : 0;
    }
    const double count = static_cast<double>(results.size());
    fmt::print(
        "[ accuracy ] crowns seen from 45 degrees: {:.1f} % the first on the ray, {:.1f} % "
        "without a ray\n",
        100 * same / count, 100 * same_below / count);
    EXPECT_GT(same, 0.85 * count);
    EXPECT_LT(same_below, 0.75 * count);
}

/// cover_shares() along x, with a shape of no noise.
std::vector<glm::vec4> shares(const std::string& inputs, int count) {
    test::GpuSnippet gpu("cover");
    return gpu.run(
        "float t = float(x) / " + std::to_string(count - 1) +
            ".0;\n"
            "float steep = 0.0, rain = 2.5, growth = 2.0, trees = 0.0, known = 0.0;\n"
            "vec2 white = vec2(-5.0, 0.0);\n" +
            inputs +
            "cover_Shape shape;\n"
            "shape.steep = steep;\n"
            "shape.sunny = 0.0;\n"
            "shape.small = shape.broad = vec4(0.0);\n"
            "shape.ragged = 0.0;\n"
            "LandClasses land = LandClasses(trees, 0.0, 0.0, 0.0, 0.0, vec3(0.0), 0.0, known);\n"
            "cover_Shares found = cover_shares(ClimateGround(rain, growth, 1.0, 1.0), land, white, "
            "rain, growth, shape);\n"
            "result = vec4(found.rock, found.forest, found.ice, found.snow);",
        count, 1);
}

/// Whether values run one way without a step above a size.
void expect_soft(const std::vector<glm::vec4>& values, int channel, double first, double last) {
    EXPECT_NEAR(values.front()[channel], first, 0.01);
    EXPECT_NEAR(values.back()[channel], last, 0.01);
    for (std::size_t i = 1; i < values.size(); ++i)
        EXPECT_LT(std::abs(values[i][channel] - values[i - 1][channel]), 0.1);
}

TEST(Cover, LimitsAreSoft) {
    expect_soft(shares("growth = 2.0 - 2.0 * t;\n", 101), 1, 1, 0);  // the tree line
    expect_soft(shares("rain = 0.5 + 2.0 * t;\n", 101), 1, 0, 1);    // from steppe to forest
    expect_soft(shares("growth = 1.0 - 2.0 * t;\n", 101), 0, 0, 1);  // to bare rock
    expect_soft(shares("steep = 2.0 * t;\n", 101), 0, 0, 1);         // to cliffs
    expect_soft(shares("white.y = t;\n", 101), 3, 0, 1);
    expect_soft(shares("white.x = -1.0 + 2.0 * t;\n", 101), 2, 0, 1);
}

TEST(Cover, NearGroundIsAllOfOneKindAndAsMuchInTheMean) {
    // Columns: shares of 0 to 1. Rows: quantiles of the noise of patches, which is normal.
    test::GpuSnippet gpu("cover");
    constexpr int kShares = 11, kQuantiles = 101;
    const auto run = [&](const char* near) {
        return gpu.run(
            fmt::format(
                "float q = (float(y) + 0.5) / {}.0, t = sqrt(-2.0 * log(min(q, 1.0 - q)));\n"
                // Abramowitz and Stegun 26.2.22
                "float z = t - (2.30753 + 0.27061 * t) / (1.0 + 0.99229 * t + 0.04481 * t * t);\n"
                "float noise = 0.187 * (q < 0.5 ? -z : z);\n"
                "result = vec4(cover_mosaic(float(x) / {}.0, noise, {}));",
                kQuantiles, kShares - 1, near),
            kShares, kQuantiles);
    };
    const auto near = run("1.0"), far = run("0.0");
    double worst = 0;
    int whole = 0;
    for (int x = 0; x < kShares; ++x) {
        const double share = x / (kShares - 1.0);
        double sum = 0;
        for (int y = 0; y < kQuantiles; ++y) {
            const auto at = static_cast<std::size_t>(y * kShares + x);
            sum += near[at].x / kQuantiles;
            whole += near[at].x < 0.02f || near[at].x > 0.98f ? 1 : 0;
            EXPECT_NEAR(far[at].x, share, 1e-5);
        }
        worst = std::max(worst, std::abs(sum - share));
    }
    const double part = whole / static_cast<double>(kShares * kQuantiles);
    fmt::print("[ accuracy ] shares of near ground: {:.3f} off at most, {:.0f} % all or nothing\n",
               worst, 100 * part);
    EXPECT_LT(worst, 0.03);
    EXPECT_GT(part, 0.8);
}

TEST(Cover, TreesThatAreKnownStandUpToTheirLineAndOffCliffs) {
    const std::string known = "known = 1.0; trees = 0.8; rain = 0.3;\n";
    EXPECT_NEAR(shares(known, 2).front().y, 0.8, 0.01) << "also where the climate has desert";
    EXPECT_NEAR(shares("known = 1.0; rain = 3.0;\n", 2).front().y, 0, 0.01);
    expect_soft(shares(known + "trees = 1.0; growth = 2.0 - 2.0 * t;\n", 101), 1, 1, 0);
    EXPECT_EQ(shares(known + "steep = 3.0;\n", 2).front().y, 0);
}

TEST(Cover, CliffsHoldNeitherTreesNorSnow) {
    const auto found = shares("steep = 3.0 * t; white = vec2(2.0, 1.0);\n", 31);
    EXPECT_NEAR(found.front().w, 1, 0.01);
    EXPECT_NEAR(found.front().z, 1, 0.01);
    EXPECT_LT(found.back().w, 0.2);
    EXPECT_LT(found.back().z, 0.2);
    EXPECT_EQ(found.back().y, 0);
    EXPECT_EQ(found.back().x, 1);
}

// ---- what pictures show

constexpr int kSide = 129;

/// A cone of 17 km around a place.
dem::Heightfield mountain(double lat_deg, double lon_deg, double lowest_m, double highest_m) {
    const double step_deg = 0.0012;
    const double first_lon = lon_deg - 64 * step_deg / std::cos(lat_deg * kPi / 180);
    return test::field_of(kSide, kSide,
                          {first_lon, step_deg / std::cos(lat_deg * kPi / 180), 0,
                           lat_deg + 64 * step_deg, 0, -step_deg},
                          "EPSG:4326", [&](int column, int row) {
                              const double off = std::hypot(column - 64.0, row - 64.0) / 64;
                              return lowest_m + (highest_m - lowest_m) * std::max(0.0, 1 - off);
                          });
}

/// The albedo of the mountain as the plugin paints it, from above.
image::ImageF albedo(double lat_deg, double lon_deg, const char* utc, double lowest_m = 300,
                     double highest_m = 4300,
                     const std::vector<std::pair<std::string, std::string>>& settings = {}) {
    static const effect::Effect cover = effect::load_effect(
        test::source_dir() / "plugins/cover", std::filesystem::path(RELEVO_SHARE_DIR) / "data");
    const TestEffect probe{
        "probe",
        "void probe_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
        "    radiance = s.diffuse;\n}\n"};
    Drawn drawn(mountain(lat_deg, lon_deg, lowest_m, highest_m), {test::kBrightSky, probe}, 96, 96,
                0, {cover}, settings);
    drawn.frame().unix_s = static_cast<double>(sun::parse_time(utc).utc.unix_us()) * 1e-6;
    // Light by which to see it, whatever the date of the snow.
    const int noon = (36 - static_cast<int>(std::lround(lon_deg / 15))) % 24;
    drawn.shine(fmt::format("2026-03-21T{:02}:00Z", noon).c_str());
    drawn.stand(0.5, 0.5, 24000, 0, -90);
    return drawn.radiance();
}

/// Mean colour of a part of the picture, in shares of its sides from the upper left.
glm::dvec3 mean(const image::ImageF& image, glm::dvec2 from = {0.2, 0.2},
                glm::dvec2 to = {0.8, 0.8}) {
    glm::dvec3 sum(0);
    int count = 0;
    for (int y = static_cast<int>(from.y * image.height); y < to.y * image.height; ++y) {
        for (int x = static_cast<int>(from.x * image.width); x < to.x * image.width; ++x) {
            EXPECT_FALSE(test::is_sky(image, x, y));
            sum += glm::dvec3(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
            ++count;
        }
    }
    return sum / double(count);
}

constexpr const char* kJanuary = "2026-01-20T12:00Z";
constexpr const char* kJuly = "2026-07-20T12:00Z";

TEST(CoverPicture, SnowComesAndGoesWithTheDateInBothHemispheres) {
    const double tyrol_winter = mean(albedo(47, 11.3, kJanuary)).g;
    const double tyrol_summer = mean(albedo(47, 11.3, kJuly)).g;
    const double andes_winter = mean(albedo(-33.4, -70.2, kJuly)).g;
    const double andes_summer = mean(albedo(-33.4, -70.2, kJanuary)).g;
    fmt::print("[ measured ] albedo, winter and summer: Tyrol {:.2f} {:.2f}, Andes {:.2f} {:.2f}\n",
               tyrol_winter, tyrol_summer, andes_winter, andes_summer);
    EXPECT_GT(tyrol_winter, 1.5 * tyrol_summer);
    EXPECT_GT(andes_winter, 1.5 * andes_summer);
    // None where it never falls.
    const glm::dvec3 congo = mean(albedo(-2, 21, kJanuary, 200, 900));
    EXPECT_LT(congo.g, 0.1);
    const auto bare =
        albedo(47, 11.3, kJanuary, 300, 4300, {{"cover.snow", "none"}, {"cover.ice", "false"}});
    EXPECT_LT(mean(bare).g, 0.3);
}

TEST(CoverPicture, DesertsAndSteppesAreNotGreen) {
    struct Place {
        const char* name;
        double lat_deg, lon_deg;
    };
    for (const Place& place : {Place{"Libyan desert", 25, 25},
                               {"Atacama", -22.9, -68.5},
                               {"Snake River Plain", 43, -114},
                               {"Karoo", -32, 22},
                               {"Gobi", 43.5, 104},
                               {"Mojave", 35, -115.5}}) {
        const glm::dvec3 colour = mean(albedo(place.lat_deg, place.lon_deg, kJuly, 900, 1300));
        EXPECT_GT(colour.r, 1.02 * colour.g) << place.name;
        EXPECT_GT(colour.g, 1.2 * colour.b) << place.name;
    }
    for (const Place& place : {Place{"Black Forest", 48.2, 8.2},
                               {"Salonga", -2, 21},
                               {"Oregon Coast Range", 44.5, -123.6}}) {
        const glm::dvec3 colour = mean(albedo(place.lat_deg, place.lon_deg, kJuly, 300, 900));
        EXPECT_GT(colour.g, 1.1 * colour.r) << place.name;
        EXPECT_LT(colour.g, 0.12) << place.name;
    }
}

/// The day after `first` on which half of the level ground at 2700 m is free of snow.
std::string thaw(double lat_deg, double lon_deg, int first) {
    const climate::CoverColumn column(
        climate::ClimateMap::shipped().at(geo::geodetic_deg(lat_deg, lon_deg)));
    int days = 0;
    while (days < 300 && column.snow_share(2700, (first + days) % 365) > 0.5)
        ++days;
    const sun::Date date = sun::add_days({2025, 1, 1}, first + days);
    return sun::to_string(date) + "T12:00Z";
}

TEST(CoverPicture, ShadedSlopesKeepSnowLonger) {
    // North is up; the slopes between 2200 and 3200 m.
    const auto north_less_south = [](double lat_deg, double lon_deg, int first) {
        const image::ImageF image = albedo(lat_deg, lon_deg, thaw(lat_deg, lon_deg, first).c_str());
        return mean(image, {0.42, 0.28}, {0.58, 0.38}).g -
               mean(image, {0.42, 0.62}, {0.58, 0.72}).g;
    };
    const double tyrol = north_less_south(47, 11.3, climate::day_of_year(3, 1));
    const double andes = north_less_south(-33.4, -70.2, climate::day_of_year(9, 1));
    fmt::print("[ measured ] albedo of the north's slope less the south's: {:.2f} {:.2f}\n", tyrol,
               andes);
    EXPECT_GT(tyrol, 0.1);
    EXPECT_LT(andes, -0.1);
}

TEST(CoverPicture, AntarcticaIsIceOnEveryDate) {
    for (const char* utc : {kJanuary, kJuly})
        EXPECT_GT(mean(albedo(-80, 120, utc, 2500, 3200)).g, 0.6) << utc;
}

TEST(CoverPicture, ParametersOverrideTheClimate) {
    const auto tyrol = [](const std::vector<std::pair<std::string, std::string>>& settings) {
        return mean(albedo(47, 11.3, kJuly, 500, 1500, settings));
    };
    const glm::dvec3 natural = tyrol({});
    EXPECT_GT(natural.g, natural.r);
    const glm::dvec3 desert = tyrol({{"cover.rain", "given"}, {"cover.dryness", "0.2"}});
    EXPECT_GT(desert.r, 1.1 * desert.g);
    EXPECT_GT(tyrol({{"cover.trees", "none"}}).g, 1.3 * natural.g);
    EXPECT_GT(tyrol({{"cover.trees", "line"}, {"cover.tree_line_m", "-1000"}}).g, 1.3 * natural.g);
    // Open ground: trees would hide most of the snow.
    EXPECT_GT(
        tyrol({{"cover.trees", "none"}, {"cover.snow", "line"}, {"cover.snow_line_m", "0"}}).g,
        4 * natural.g);
    EXPECT_GT(tyrol({{"cover.trees", "none"}, {"cover.snow_shift_m", "-2900"}}).g, 4 * natural.g);
}

}  // namespace
}  // namespace relevo::test_cover
