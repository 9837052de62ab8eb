#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/array2d.h"
#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "support/support.h"

/// A site of fine posts in a wider and coarser DEM: `--surroundings`.
namespace relevo::test::test_surroundings {
namespace {

using nlohmann::json;

constexpr double kMiddle_x = 500000, kMiddle_y = 5200000;
constexpr int kSite = 121, kWide = 1201;  // posts a side
constexpr double kFine_m = 5, kCoarse_m = 30;

std::filesystem::path folder() {
    static const std::filesystem::path made = scratch_dir("surroundings");
    return made;
}
std::string out(const std::string& name) {
    return (folder() / name).string();
}

/// A valley between two ridges that run east, 900 m off the middle and 400 m high, on a
/// slope that rises to the east.
double height_m(double x_m, double y_m) {
    const double ridge = std::exp(-std::pow((std::abs(y_m) - 900) / 300, 2));
    const double slope_m = 0.5 * std::clamp(x_m, -1000.0, 1000.0);
    return 900 + slope_m + (400 + 80 * std::sin(x_m / 500)) * ridge +
           20 * std::sin(x_m / 310) * std::cos(y_m / 270);
}

using At = std::function<double(double x_m, double y_m)>;

/// Heights around the middle, from post to post.
std::string dem(const std::string& name, double step_m, int side, const At& at = height_m,
                const std::string& crs = "EPSG:32632") {
    Raster raster;
    raster.columns = raster.rows = side;
    raster.crs = crs;
    const double half_m = step_m * side / 2;
    raster.geotransform = {{kMiddle_x - half_m, step_m, 0, kMiddle_y + half_m, 0, -step_m}};
    raster.nodata = -9999;
    raster.value = [=](int column, int row, int) {
        return at(step_m * (column + 0.5) - half_m, half_m - step_m * (row + 0.5));
    };
    return write_raster(folder() / name, raster);
}

std::string site() {
    return dem("site.tif", kFine_m, kSite);
}
std::string coarse() {
    return dem("coarse.tif", kCoarse_m, kWide * 5 / 30);
}
std::string wide() {
    return dem("wide.tif", kFine_m, kWide);
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

json answer(std::vector<std::string> arguments, std::string* said = nullptr) {
    arguments.insert(arguments.end(), {"--json"});
    const Result run = relevo(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    if (said) *said = run.err;
    return run.status == 0 ? of_one_day(json::parse(run.out)) : json();
}

const std::vector<std::string> kDay{"--at", "46.9515,8.9995", "--date", "2026-03-05"};

json day(std::vector<std::string> dems, std::string* said = nullptr) {
    dems.insert(dems.begin(), {"sun", "day"});
    dems.insert(dems.end(), kDay.begin(), kDay.end());
    return answer(dems, said);
}

double lit_h(const json& day) {
    return day["direct_sun_h"].get<double>();
}

Array2d<float> raster(std::vector<std::string> arguments, const std::string& name,
                      std::string* said = nullptr) {
    arguments.insert(arguments.begin(), "sun");
    arguments.insert(arguments.end(), {"-o", out(name), "--overwrite"});
    const Result run = relevo(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    if (said) *said = run.err;
    const Dataset file = opened(out(name));
    Array2d<float> values(file->GetRasterXSize(), file->GetRasterYSize());
    EXPECT_EQ(file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, values.width(), values.height(),
                                               values.data(), values.width(), values.height(),
                                               GDT_Float32, 0, 0),
              CE_None);
    return values;
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Surroundings, TheSunOfAPlaceIsThatOfOneFineDem) {
    std::string said;
    const json nested = day({site(), "--surroundings", coarse()}, &said);
    EXPECT_TRUE(has(said, "coarse.tif: heights lowered by 0.0")) << said;
    const double found_s = 3600 * lit_h(nested), expected_s = 3600 * lit_h(day({wide()})),
                 alone_s = 3600 * lit_h(day({site()}));
    fmt::print(
        "[ accuracy ] direct sun in a range: {:.0f} s, {:.0f} of one fine DEM; the site "
        "alone {:.0f}\n",
        found_s, expected_s, alone_s);
    EXPECT_NEAR(found_s, expected_s, 60);  // posts of 30 m cut ridges off by 0.5 m
    EXPECT_GT(alone_s, expected_s + 3600);
    EXPECT_TRUE(has(nested["horizon_definition"], "coarse.tif around the DEM")) << nested.dump(1);
}

TEST(Surroundings, RastersAreThoseOfOneFineDem) {
    const std::vector<std::string> clip{"--clip", "499697.5,5199697.5,500302.5,5200302.5"};
    for (const std::vector<std::string>& verb :
         {std::vector<std::string>{"hours", "--date", "2026-12-21"},
          {"hours", "--from", "2026-12-01", "--to", "2026-12-31"},
          {"sky-view"},
          {"horizons", "--directions", "4"},
          {"shadow", "--time", "2026-12-21T11:00"}}) {
        SCOPED_TRACE(verb.front());
        const auto of = [&](const std::string& dem, std::vector<std::string> more) {
            more.insert(more.begin(), verb.begin(), verb.end());
            more.insert(more.begin() + 1, dem);
            return raster(more, "raster.tif");
        };
        const Array2d<float> expected = of(wide(), clip), alone = of(site(), {}),
                             nested = of(site(), {"--surroundings", coarse()});
        ASSERT_EQ(expected.width(), nested.width());
        double off = 0, off_alone = 0;
        for (std::size_t i = 0; i < nested.size(); ++i) {
            off += std::abs(nested.data()[i] - expected.data()[i]) / double(nested.size());
            off_alone += std::abs(alone.data()[i] - expected.data()[i]) / double(nested.size());
        }
        fmt::print("[ accuracy ] {:9} in a range: {:.4f} off at the mean, alone {:.3f}\n",
                   verb.front(), off, off_alone);
        EXPECT_LT(off, 0.004 * off_alone);
        const Dataset file = opened(out("raster.tif"));
        EXPECT_TRUE(has(file->GetMetadataItem("DEFINITION"), "of the DEM and its surroundings"));
        EXPECT_TRUE(has(file->GetMetadataItem("SURROUNDINGS"), "coarse.tif around the DEM"));
    }
}

TEST(Surroundings, AreRaisedToTheSitesHeights) {
    const auto higher = [](double x_m, double y_m) { return height_m(x_m, y_m) + 48.25; };
    const std::string shifted = dem("shifted.tif", kCoarse_m, kWide * 5 / 30, higher);
    std::string said;
    const json found = day({site(), "--surroundings", shifted}, &said);
    EXPECT_TRUE(has(said, "warning: surroundings: ") && has(said, "lowered by 48.2")) << said;
    EXPECT_NEAR(3600 * lit_h(found), 3600 * lit_h(day({site(), "--surroundings", coarse()})), 2);
    // Of one datum they are as they are said to be, and the difference is a warning.
    const std::string one = "EPSG:32632+5773";
    const std::string fine = dem("egm.tif", kFine_m, kSite, height_m, one),
                      around = dem("egm_around.tif", kCoarse_m, kWide * 5 / 30, higher, one);
    const double higher_s = 3600 * lit_h(day({fine, "--surroundings", around}, &said));
    EXPECT_TRUE(has(said, "warning: surroundings: ") &&
                has(said,
                    "heights as they are, both above EGM96 height (EPSG:5773); the median "
                    "difference is -48.2"))
        << said;
    EXPECT_LT(higher_s, 3600 * lit_h(found) - 60);
}

TEST(Surroundings, AnswerTheVoidsOfTheSite) {
    const auto with_voids = [](double x_m, double y_m) {
        return x_m < -200 || std::hypot(x_m - 100, y_m) < 40 ? -9999 : height_m(x_m, y_m);
    };
    const std::string holed = dem("holed.tif", kFine_m, kSite, with_voids);
    std::string said;
    const Array2d<float> nested =
        raster({"sky-view", holed, "--surroundings", coarse()}, "holed_sky.tif", &said);
    EXPECT_TRUE(has(said, " voids of the DEM take its heights")) << said;
    const Array2d<float> expected =
        raster({"sky-view", site(), "--surroundings", coarse()}, "whole_sky.tif");
    double worst = 0;
    for (std::size_t i = 0; i < nested.size(); ++i) {
        ASSERT_FALSE(std::isnan(nested.data()[i])) << i;
        worst = std::max(worst, std::abs(double{nested.data()[i]} - double{expected.data()[i]}));
    }
    EXPECT_LT(worst, 0.02);
}

TEST(Surroundings, SayWhatLittleMemoryChanges) {
    const std::vector<std::string> hours{"hours",  site(),   "--surroundings",
                                         coarse(), "--date", "2026-12-21"};
    std::vector<std::string> little = hours;
    std::string said;
    little.insert(little.end(), {"--memory", "1"});
    const Array2d<float> all = raster(hours, "all.tif"), some = raster(little, "some.tif", &said);
    EXPECT_TRUE(has(said, "warning: surroundings: memory has room for a rim of ")) << said;
    double off = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        off += std::abs(all.data()[i] - some.data()[i]) / double(all.size());
    EXPECT_LT(off, 0.02);
}

TEST(Surroundings, MayEndRightBesideTheSite) {
    // 21 x 21 posts of 30 m: the rim goes on beyond them.
    const std::string small = dem("small.tif", kCoarse_m, 21);
    const Array2d<float> nested = raster({"sky-view", site(), "--surroundings", small}, "sky.tif"),
                         alone = raster({"sky-view", site()}, "sky.tif");
    for (std::size_t i = 0; i < nested.size(); ++i)
        ASSERT_LE(nested.data()[i], alone.data()[i] + 0.01) << i;
}

TEST(Surroundings, ASummitOutsideOfTheSiteIsSeen) {
    // The ridge in the south, of which both have the same height.
    const std::vector<std::string> over{"--at",           "46.9515,8.9995", "--over",
                                        "46.9438,8.9995", "--date",         "2026-03-05"};
    const auto when = [&](std::vector<std::string> dems) {
        dems.insert(dems.begin(), {"sun", "when"});
        dems.insert(dems.end(), over.begin(), over.end());
        return answer(dems);
    };
    const json nested = when({site(), "--surroundings", coarse()}), expected = when({wide()});
    EXPECT_NEAR(nested["target"]["height_m"].get<double>(),
                expected["target"]["height_m"].get<double>(), 20);  // of the nearest posts
}

TEST(Surroundings, BadOnesAreRefused) {
    const std::string beside = dem("small.tif", kCoarse_m, 11);
    const auto refused = [&](std::vector<std::string> arguments, int status) {
        arguments.insert(arguments.begin(), "sun");
        const Result run = relevo(arguments);
        EXPECT_EQ(run.status, status) << run.err;
        return run.err;
    };
    EXPECT_TRUE(has(refused({"horizon", site(), "--surroundings", beside, "--at", "46.95,9"}, 3),
                    "small.tif: end within the DEM, at "));
    EXPECT_TRUE(
        has(refused({"horizon", site(), "--surroundings", out("none.tif"), "--at", "46.95,9"}, 3),
            "none.tif: "));
    EXPECT_TRUE(has(
        refused({"day", "--surroundings", coarse(), "--at", "46.95,9", "--date", "2026-12-21"}, 2),
        "--surroundings"));
    EXPECT_TRUE(has(refused({"sky-view", site(), "--surroundings", coarse(), "--tiles", "64",
                             "--halo", "1", "-o", out("tiles")},
                            2),
                    "--halo: not with --surroundings"));
    const std::string before = bytes_of(coarse());
    refused(
        {"sky-view", site(), "--surroundings", coarse(), "-o", out("coarse.tif"), "--overwrite"},
        3);
    EXPECT_EQ(bytes_of(out("coarse.tif")), before);
}

}  // namespace
}  // namespace relevo::test::test_surroundings
