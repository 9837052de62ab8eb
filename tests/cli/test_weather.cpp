// Weather on the command line: what a forecast makes, and mistakes that must lose nothing.
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "cli/program.h"
#include "dem/fixture.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_weather {
namespace {

using testing::HasSubstr;
using testing::Not;

using About = std::vector<std::pair<std::string, std::string>>;

constexpr const char* kNoon = "1780315200";  // 2026-06-01 12:00 UTC

/// A raster in degrees around the bundled DEM, of one value.
std::string write_around(const std::string& name, double value, const About& about = {},
                         const std::string& unit = "") {
    return write_raster(folder() / name, {.columns = 12,
                                          .rows = 12,
                                          .geotransform = {{-87.2, 0.5, 0, 39.3, 0, -0.5}},
                                          .crs = "EPSG:4326",
                                          .unit = unit,
                                          .about = about,
                                          .value = [=](int, int, int) { return value; }});
}

class Weather : public testing::Test {
  protected:
    Result capture(std::vector<std::string> more) {
        more.insert(more.begin(), {"capture", bundled_dem(), "-o", picture_, "--overwrite",
                                   "--size", "96x64", "--time", "2026-06-01T12:40Z"});
        return relevo(more);
    }

    /// A mistake is an error of bad input, and leaves the picture as it was.
    void expect_refused(const std::vector<std::string>& more, const std::string& message) {
        std::ofstream(picture_) << "kept";
        const Result run = capture(more);
        EXPECT_EQ(run.status, 3) << run.err;
        EXPECT_THAT(run.err, HasSubstr(message));
        EXPECT_EQ(read_text(picture_, "test"), "kept");
    }

    std::string picture_ = (scratch_dir("weather") / "picture.png").string();
};

TEST_F(Weather, OfAForecastIsSaidAndDrawn) {
    const std::string file =
        write_around("cover.tif", 90,
                     {{"GRIB_ELEMENT", "TCDC"}, {"GRIB_UNIT", "[%]"}, {"GRIB_VALID_TIME", kNoon}});
    const std::vector<std::string> from_within = {"--eye", "36.30,-84.20,1500", "--weather", file};
    const Result clouded = capture(from_within);
    EXPECT_EQ(clouded.status, 0) << clouded.err;
    EXPECT_THAT(clouded.err,
                HasSubstr("weather: cover.tif: total cloud cover, 90 % over the DEM, of 2026-06-01 "
                          "12:00 UTC; bases count from "));
    const std::string with_clouds = read_text(picture_, "test");
    EXPECT_THAT(clouded.err, Not(HasSubstr("from outside")));
    EXPECT_THAT(with_clouds, HasSubstr("cover.tif"));  // the scene in the picture names it
    const image::Image8 pixels = image::read(picture_);
    EXPECT_EQ(capture(from_within).status, 0);
    EXPECT_EQ(read_text(picture_, "test"), with_clouds);
    std::vector<std::string> clear = from_within;
    clear.insert(clear.end(), {"--disable", "clouds"});
    EXPECT_EQ(capture(clear).status, 0);
    const image::Image8 without = image::read(picture_);
    int differ = 0;
    for (int y = 0; y < pixels.height; ++y)
        for (int x = 0; x < pixels.width; ++x)
            differ += std::abs(pixels.at(x, y, 0) - without.at(x, y, 0)) > 8;
    EXPECT_GT(differ, pixels.width * pixels.height / 4);
}

TEST_F(Weather, OfWhichNothingIsDrawnIsSaid) {
    const std::string report = "LSZB 011150Z 24009KT 9999 BKN040 17/13 Q1014";
    const std::string outside =
        "; clouds and fog are not drawn from outside the DEM, --eye stands in it";
    EXPECT_THAT(capture({"--weather", report, "--view", "whole"}).err, HasSubstr(outside));
    EXPECT_THAT(capture({"--weather", report, "--ortho"}).err, HasSubstr(outside));
    EXPECT_THAT(capture({"--weather", "LSZB 011150Z 24009KT CAVOK 17/13 Q1014"}).err,
                Not(HasSubstr("from outside")));
}

TEST_F(Weather, MistakesAreSaidAndLoseNothing) {
    expect_refused({"--weather", "LSZB 011150Z 24009KT 9999 BKNX40 17/13 Q1014"}, "\"BKNX40\"");
    expect_refused({"--weather", write_around("timeless.tif", 40, {{"GRIB_ELEMENT", "TCDC"}})},
                   "timeless.tif: its cloud cover has no time");
    expect_refused(
        {"--weather", write_around("early.tif", 40,
                                   {{"GRIB_ELEMENT", "TCDC"}, {"GRIB_VALID_TIME", "1780300000"}})},
        "the picture's is 2026-06-01 12:40 UTC; --time sets another");
    expect_refused(
        {"--enable", "clouds", "--set", "clouds.base_1_m=3000", "--set", "clouds.top_1_m=2000"},
        "clouds.top_1_m");
    for (const char* const depth : {"1e9", "nan", "-1"})
        expect_refused({"--enable", "clouds", "--set", fmt::format("clouds.depth_1={}", depth)},
                       "clouds.depth_1");
}

TEST_F(Weather, RastersThatAreNoCloudsAreRefused) {
    const auto set = [&](const std::string& parameter, const std::string& file) {
        return std::vector<std::string>{"--enable", "clouds", "--set",
                                        fmt::format("clouds.{}={}", parameter, file)};
    };
    const std::string per_cent = write_around("per_cent.tif", 43);
    expect_refused(set("cover_1_file", per_cent),
                   fmt::format("clouds.cover_1_file: {}: has the value 43, expected 0 to 1; per "
                               "cent need the unit %, as by gdal_edit.py -units % FILE",
                               per_cent));
    expect_refused(set("cover_1_file", write_around("wild.tif", 400, {}, "%")),
                   "has the value 400, expected 0 to 100");
    expect_refused(set("depth_1_file", write_around("deep.tif", 1e9)),
                   "has the value 1e+09, expected 0 to 1000");
    expect_refused(set("depth_1_file", (folder() / "missing.tif").string()), "no such file");
    EXPECT_EQ(capture(set("cover_1_file", write_around("unit.tif", 43, {}, "%"))).status, 0);
}

}  // namespace
}  // namespace relevo::test::test_weather
