#include <algorithm>
#include <array>
#include <string>

#include "dem/source.h"
#include "fuzz/fuzz.h"

namespace relevo::fuzz {

namespace {

/// Reads a window, means of the whole, and one number as it is stored.
void read(const dem::Source& source) {
    const int columns = std::min(source.grid().columns(), 100);
    const int rows = std::min(source.grid().rows(), 100);
    source.read({0, 0, columns, rows}, columns, rows);
    source.read({0, 0, source.grid().columns(), source.grid().rows()}, std::min(columns, 8),
                std::min(rows, 8));
    source.stored(columns / 2, rows / 2);
}

}  // namespace

// Opens a raster of any of GDAL's formats with 16 MiB, and reads of it: as it is, with what users
// may say of it instead, and with itself as a second file.
const Target kRaster("raster", [](std::string_view bytes) {
    const std::array paths{file(bytes, "dem").string(), file(bytes, "again").string()};
    const MemoryBudget memory = MemoryBudget::of_mib(16);
    attempt([&] { read(dem::Source::open(paths[0], {.memory = memory})); });
    attempt([&] {
        read(dem::Source::open(paths[0], {.crs = "EPSG:32632",
                                          .unit = "ft",
                                          .nodata = 0,
                                          .no_nodata = false,
                                          .memory = memory}));
    });
    read(dem::Source::open(paths, {.no_nodata = true, .memory = memory}));
});

}  // namespace relevo::fuzz
