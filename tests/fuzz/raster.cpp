#include <algorithm>
#include <string>

#include "dem/source.h"
#include "fuzz/fuzz.h"

namespace relevo::fuzz {

// Opens a raster of any of GDAL's formats with 16 MiB, and reads a window of it.
const Target kRaster("raster", [](std::string_view bytes) {
    const std::string path = file(bytes, "dem");
    const dem::Source source = dem::Source::open(path, {.memory = MemoryBudget::of_mib(16)});
    const int columns = std::min(source.grid().columns(), 100);
    const int rows = std::min(source.grid().rows(), 100);
    source.read({0, 0, columns, rows}, columns, rows);
    source.read({0, 0, source.grid().columns(), source.grid().rows()}, std::min(columns, 8),
                std::min(rows, 8));
});

}  // namespace relevo::fuzz
