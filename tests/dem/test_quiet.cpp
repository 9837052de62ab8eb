#include <functional>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/log.h"
#include "dem/fixture.h"
#include "dem/load.h"
#include "support/support.h"

// What GDAL's libraries print by themselves.

namespace relevo::dem::test_quiet {
namespace {

using test::folder;
using test::Raster;
using test::write_raster;
using testing::HasSubstr;

/// What goes to standard error while something is done, but for what we say.
std::string printed(const std::function<void()>& body) {
    log::set_sink([](log::Level, std::string_view) {});
    testing::internal::CaptureStderr();
    body();
    const std::string text = testing::internal::GetCapturedStderr();
    log::set_sink({});
    return text;
}

std::string write_netcdf4(const char* name, int side = 200) {
    Raster raster;
    raster.driver = "netCDF";
    raster.options = {"FORMAT=NC4", "COMPRESS=DEFLATE"};
    raster.columns = raster.rows = side;
    raster.unit = "m";
    return write_raster(folder() / name, raster);
}

TEST(Quiet, Hdf5PrintsNothingOnAnyThread) {
    const std::string path = write_netcdf4("a.nc");
    // HDF5 is switched off thread by thread, by netCDF's library on the first one alone.
    EXPECT_EQ(printed([&] { load(path); }), "");
    for (int i = 0; i < 2; ++i)
        EXPECT_EQ(printed([&] { std::thread([&] { load(path); }).join(); }), "");
}

TEST(Quiet, ADatasetThatIsReadOnAnotherThreadPrintsNothing) {
    // Of a smaller one all posts are sampled when it is opened.
    const std::string path = write_netcdf4("damaged.nc", 1200);
    const Source source = Source::open(path);
    test::cut_short(path, std::filesystem::file_size(path) / 2);
    std::string error;
    EXPECT_EQ(printed([&] {
                  std::thread([&] { error = test::error_of([&] { source.read(); }); }).join();
              }),
              "");
    EXPECT_THAT(error, HasSubstr("its heights cannot be read"));
}

TEST(Quiet, NoFormatPrintsWhetherItsFileIsWholeOrCutShort) {
    const struct {
        const char* driver;
        const char* ending;
        const char* type;
    } formats[] = {{"GTiff", "tif", "Float32"}, {"netCDF", "nc", "Float32"},
                   {"HFA", "img", "Float32"},   {"AAIGrid", "asc", "Float32"},
                   {"BAG", "bag", "Float32"},   {"DTED", "dt0", "Int16"},
                   {"PNG", "png", "UInt16"},    {"GRIB", "grb2", "Float32"}};
    for (const auto& format : formats) {
        Raster raster;
        raster.driver = format.driver;
        raster.type = format.type;
        raster.columns = raster.rows = 121;
        if (raster.driver == "DTED") {
            raster.crs = "EPSG:4326";
            raster.geotransform = {{8 - 1 / 240.0, 1 / 120.0, 0, 47 + 1 / 240.0, 0, -1 / 120.0}};
        }
        const std::string path =
            write_raster(folder() / fmt::format("a.{}", format.ending), raster);
        const auto bytes = std::filesystem::file_size(path);
        for (const std::uintmax_t left : {bytes, bytes * 3 / 4, bytes / 3, std::uintmax_t{100}}) {
            test::cut_short(path, left);
            EXPECT_EQ(
                printed([&] { std::thread([&] { test::error_of([&] { load(path); }); }).join(); }),
                "")
                << format.driver << ", " << left << " of " << bytes << " bytes";
        }
    }
}

}  // namespace
}  // namespace relevo::dem::test_quiet
