#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "cli/hills.h"
#include "cli/program.h"
#include "cli/raster.h"
#include "dem/fixture.h"
#include "support/support.h"

/// What verbs print of a raster that is made in several parts, beside what stands in the raster;
/// and of days that are no 24 hours.
namespace relevo::test::test_sun_parts {
namespace {

std::string out(const std::string& name) {
    return (folder() / name).string();
}

/// Of the window that is asked for, 560 x 128 posts from column and row 100 on, the first of its
/// two parts, which is 512 wide, has 1200 voids and the last one 5.
std::string hills_with_voids() {
    return write_hills(folder() / "hills.tif", [](int column, int row) {
        return column == 640 && row >= 190 && row < 195;
    });
}
const std::vector<std::string> kWindow{"--clip=503000,5295440,519800,5298000", "--memory", "1"};
constexpr int kColumns = 560, kRows = 128, kVoids = 1205;

Result run_in_parts(std::vector<std::string> arguments, const std::string& name) {
    arguments.insert(arguments.begin(), "sun");
    arguments.insert(arguments.end(), {hills_with_voids(), "-o", out(name)});
    arguments.insert(arguments.end(), kWindow.begin(), kWindow.end());
    const Result result = relevo(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result;
}

/// The number after a word of what was printed.
double number_after(const std::string& text, const std::string& word) {
    const std::size_t at = text.find(word);
    if (at == std::string::npos) ADD_FAILURE() << word << " is not in: " << text;
    return at == std::string::npos ? NAN : std::stod(text.substr(at + word.size()));
}

std::vector<float> values_of(const std::string& name) {
    const Dataset dataset = opened(out(name));
    EXPECT_TRUE(dataset);
    EXPECT_EQ(dataset->GetRasterXSize(), kColumns);
    EXPECT_EQ(dataset->GetRasterYSize(), kRows);
    EXPECT_EQ(std::string(dataset->GetMetadataItem("HOLES")), std::to_string(kVoids));
    std::vector<float> values(std::size_t{kColumns} * kRows);
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, kColumns, kRows, values.data(),
                                                  kColumns, kRows, GDT_Float32, 0, 0),
              CE_None);
    return values;
}

TEST(SunParts, CountsOfLitAndShadedPostsAreThoseOfAllParts) {
    const Result run = run_in_parts({"shadow", "--sun", "100,12"}, "mask.tif");
    int lit = 0, shaded = 0;
    for (const float value : values_of("mask.tif")) {
        lit += value == 1;
        shaded += value == 0;
    }
    EXPECT_GT(shaded, 1000);
    EXPECT_EQ(lit + shaded, kColumns * kRows - kVoids);
    EXPECT_EQ(number_after(run.out, "\nlit     "), lit) << run.out;
    EXPECT_EQ(number_after(run.out, "in the shade"), shaded) << run.out;
    EXPECT_NE(run.err.find(std::to_string(kVoids)), std::string::npos) << run.err;
}

/// The mean, least and most of values that are numbers.
std::array<double, 3> mean_least_most(const std::vector<float>& values) {
    double sum = 0, count = 0, least = INFINITY, most = -INFINITY;
    for (const float value : values)
        if (!std::isnan(value)) {
            sum += double{value};
            ++count;
            least = std::min(least, double{value});
            most = std::max(most, double{value});
        }
    EXPECT_EQ(count, kColumns * kRows - kVoids);
    return {sum / count, least, most};
}

TEST(SunParts, MeanHoursAreThoseOfAllPostsThatHaveSome) {
    const Result run =
        run_in_parts({"hours", "--date", "2026-12-21", "--tz", "UTC", "--step", "30"}, "hours.tif");
    const auto [mean, least, most] = mean_least_most(values_of("hours.tif"));
    EXPECT_NEAR(number_after(run.out, "mean"), mean, 0.0051);
    EXPECT_NEAR(number_after(run.out, "least"), least, 0.0051);
    EXPECT_NEAR(number_after(run.out, "most"), most, 0.0051);
    EXPECT_GT(most - least, 1);
}

TEST(SunParts, MeanSkyViewIsThatOfAllPostsThatHaveOne) {
    const Result run = run_in_parts({"sky-view", "--directions", "8"}, "sky.tif");
    EXPECT_NEAR(number_after(run.out, "mean"), mean_least_most(values_of("sky.tif"))[0], 5.1e-5);
}

/// A plain at the equator, at 105 degrees east: the sun is highest near 05:00 UTC.
std::string plain() {
    Raster raster;
    raster.crs = "EPSG:4326";
    raster.geotransform = {{105, 0.001, 0, 0, 0, -0.001}};
    raster.value = [](int, int, int) { return 5.0; };
    return write_raster(folder() / "plain.tif", raster);
}

TEST(SunParts, ADayOnWhichClocksChangeHas23Or25Hours) {
    // By clocks of New York such a day begins and ends about noon of that plain, where the centre
    // of the sun is up for 12.08 of 24 hours: an hour less or more of the day is one less or more
    // of sun. Clocks change by the IANA time zone database.
    const auto hours_of = [](const char* date, const char* span) {
        const Result run = relevo({"sun", "hours", plain(), "--date", date, "--tz",
                                   "America/New_York", "--overwrite", "-o", out("day.tif")});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_NE(run.out.find(span), std::string::npos) << run.out;
        return number_after(run.out, "mean");
    };
    EXPECT_NEAR(hours_of("2026-03-08", "2026-03-08T00:00:00-05:00 to 2026-03-09T00:00:00-04:00"),
                11.08, 0.03);
    EXPECT_NEAR(hours_of("2026-03-10", "2026-03-10T00:00:00-04:00 to 2026-03-11T00:00:00-04:00"),
                12.08, 0.03);
    EXPECT_NEAR(hours_of("2026-11-01", "2026-11-01T00:00:00-04:00 to 2026-11-02T00:00:00-05:00"),
                13.08, 0.03);
}

TEST(SunParts, AGridAzimuthIsOverTheGroundOnAMapInDegrees) {
    // A tower in a plain at 60 N, where a degree of longitude is half as long as one of latitude.
    Raster raster;
    raster.columns = 201;
    raster.rows = 101;
    raster.crs = "EPSG:4326";
    raster.geotransform = {{8, 0.0005, 0, 60, 0, -0.0005}};
    raster.value = [](int column, int row, int) {
        return std::abs(column - 100) <= 2 && std::abs(row - 50) <= 1 ? 300.0 : 0.0;
    };
    const Result run = relevo({"sun", "shadow", write_raster(folder() / "tower.tif", raster),
                               "--sun", "grid:30,20", "-o", out("tower_mask.tif")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NEAR(number_after(run.out, "azimuth"), 30, 0.2) << run.out;
    // Its shadow is 300 m / tan 20 degrees = 824 m long. In the middle of it: 412 m towards 210
    // degrees, which are 206 m or 7.4 columns of 27.9 m to the west, and 357 m or 6.4 rows of 55.7
    // m to the south.
    const Dataset mask = opened(out("tower_mask.tif"));
    const auto at = [&](int column, int row) {
        float value = -1;
        EXPECT_EQ(mask->GetRasterBand(1)->RasterIO(GF_Read, column, row, 1, 1, &value, 1, 1,
                                                   GDT_Float32, 0, 0),
                  CE_None);
        return value;
    };
    EXPECT_EQ(at(100 - 7, 50 + 6), 0);
    EXPECT_EQ(at(100 - 2, 50 + 6), 1);  // where it would lie on a square grid
    EXPECT_EQ(at(100 - 15, 50 + 6), 1);
}

}  // namespace
}  // namespace relevo::test::test_sun_parts
