#include <functional>
#include <thread>

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

std::string write_netcdf4(const char* name) {
    Raster raster;
    raster.driver = "netCDF";
    raster.options = {"FORMAT=NC4", "COMPRESS=DEFLATE"};
    raster.columns = raster.rows = 200;
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
    const std::string path = write_netcdf4("damaged.nc");
    const Source source = Source::open(path);
    test::cut_short(path, std::filesystem::file_size(path) / 2);
    std::string error;
    EXPECT_EQ(printed([&] {
                  std::thread([&] { error = test::error_of([&] { source.read(); }); }).join();
              }),
              "");
    EXPECT_THAT(error, HasSubstr("its heights cannot be read"));
}

}  // namespace
}  // namespace relevo::dem::test_quiet
