#include <filesystem>

#include <fmt/format.h>

#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_sun_arguments {
namespace {

std::string out(const std::string& name) {
    static const std::filesystem::path folder = scratch_dir("sun_arguments");
    return (folder / name).string();
}

Result hours(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"sun",    "hours",      bundled_dem(), "-q",
                                       "--date", "2026-12-21", "--tz",        "UTC"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return relevo(arguments);
}

// A raster's posts are figures: no option of a file's makes others of them.
TEST(SunArguments, NoCreationOptionChangesValuesOrGrid) {
    for (const std::string option : {"COMPRESS=JPEG",
                                     "compress=webp",
                                     "COMPRESS=LERC",
                                     "COMPRESS=LERC_ZSTD",
                                     "COMPRESS=JXL",
                                     "MAX_Z_ERROR=1",
                                     "QUALITY=50",
                                     "JXL_LOSSLESS=NO",
                                     "NBITS=1",
                                     "DISCARD_LSB=8",
                                     "ADD_ALPHA=YES",
                                     "RESAMPLING=AVERAGE",
                                     "WARP_RESAMPLING=CUBIC",
                                     "TILING_SCHEME=GoogleMapsCompatible",
                                     "ZOOM_LEVEL=3",
                                     "ALIGNED_LEVELS=2",
                                     "TARGET_SRS=EPSG:3857",
                                     "EXTENT=0,0,1,1",
                                     "RES=1000",
                                     "OVERVIEW_COMPRESS=JPEG"}) {
        const Result result = hours({"-o", out("co.tif"), "--co", option});
        EXPECT_EQ(result.status, 2) << option << ": " << result.err;
        EXPECT_NE(result.err.find("--co: " + option.substr(0, option.find('='))), std::string::npos)
            << result.err;
        EXPECT_NE(result.err.find("would change the result's values"), std::string::npos)
            << result.err;
        EXPECT_FALSE(std::filesystem::exists(out("co.tif"))) << option;
    }
}

TEST(SunArguments, AStepIsADurationOrMinutesAlone) {
    const auto mean = [](const std::string& step) {
        const Result result = hours({"-o", out("step.tif"), "--overwrite", "--step", step});
        EXPECT_EQ(result.status, 0) << step << ": " << result.err;
        return result.out;
    };
    EXPECT_EQ(mean("10min"), mean("10"));
    EXPECT_EQ(mean("600s"), mean("10"));
    for (const std::string step : {"10 minutes", "2h", "0.5s", "x"}) {
        const Result result = hours({"-o", out("x.tif"), "--step", step});
        EXPECT_EQ(result.status, 2) << step;
        EXPECT_EQ(result.err.substr(0, result.err.find('\n')),
                  "relevo: error: --step: expected 1s to 1h, such as 30s, 3min or minutes alone, "
                  "but got " +
                      step);
    }
}

TEST(SunArguments, BandsAreSeparatedByCommas) {
    for (const std::vector<std::string>& bands :
         {std::vector<std::string>{"--bands", "hours", "first"},
          {"--bands", "hours first"},
          {"--bands", "hours,", "first"}}) {
        std::vector<std::string> arguments{"-o", out("x.tif")};
        arguments.insert(arguments.end(), bands.begin(), bands.end());
        const Result result = hours(arguments);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_NE(result.err.find("separate bands with commas"), std::string::npos) << result.err;
    }
}

}  // namespace
}  // namespace relevo::test::test_sun_arguments
