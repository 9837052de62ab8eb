#include "dem/tile_index.h"

#include <string>

#include "fuzz/fuzz.h"

namespace relevo::fuzz {

// Indexes are told apart by the endings of their names.
const Target kTileIndex("tile_index", [](std::string_view bytes) {
    const bool is_database = bytes.starts_with("SQLite format 3");
    const bool is_flat = bytes.starts_with("fgb\x03");
    const std::string path = file(bytes, is_database ? "index.gpkg"
                                         : is_flat   ? "index.fgb"
                                                     : "index.json");
    attempt([&] { dem::why_no_index(path); });
    attempt([&] { dem::tile_locations(path); });
    dem::refuse_remote_tiles(dem::read_tile_index(path));
});

}  // namespace relevo::fuzz
