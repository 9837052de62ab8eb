#pragma once

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "dem/tile_index.h"

// What the readers of tile indexes share. Inside of the layer only.

namespace relevo::dem {

/// Collects the tiles of an index.
class TileCollector {
  public:
    /// @param tiles_crs  as read_tile_index() takes it
    TileCollector(const std::string& path, const geo::Crs* tiles_crs);

    /// Sets what tiles are in that name no CRS.
    void set_crs(const geo::Crs& crs) { own_crs_ = crs; }

    /// @param location  as the index has it
    /// @param outline   its vertices, in `outline_crs`
    /// @param crs       of the tile; empty: not stated
    /// @throws Error (BadInput) naming the tile
    void add(const std::string& location, const std::vector<glm::dvec2>& outline,
             const std::optional<geo::Crs>& outline_crs, const std::string& crs);
    /// The same, of a tile whose posts the index states.
    void add(const std::string& location, const TilePosts& posts, const std::string& crs);

    /// A CRS by its text, parsed once. @throws Error (BadInput)
    const geo::Crs& crs_of(const std::string& text);

    [[noreturn]] void fail(const std::string& what) const;
    /// The number of the row that is being read, from 1, and what it names.
    [[noreturn]] void fail_row(const std::string& location, const std::string& what) const;

    TileIndex take(const std::string& format);

  private:
    void add(const std::string& location, IndexedTile tile, const geo::Crs* crs);
    int number_of(const geo::Crs& crs);
    std::string unique_name(const std::string& location);

    TileIndex index_;
    std::string folder_;
    const geo::Crs* tiles_crs_;
    std::optional<geo::Crs> own_crs_;
    std::map<std::string, geo::Crs> known_;
    std::unordered_set<std::string> names_;
    std::unordered_map<std::string, std::size_t> next_number_;  // of a name that is taken
    std::unordered_set<std::string> locations_;
    std::size_t row_ = 0;
};

/// How a tile is named for GDAL: relative names from `folder`, addresses as "/vsicurl/...".
std::string resolved_location(const std::string& folder, const std::string& location);

/// A STAC Item or a collection of Items. @param text  of the file
/// @throws Error (BadInput)
TileIndex read_stac(const std::string& path, const std::string& text, const std::string& crs,
                    const geo::Crs* tiles_crs);

}  // namespace relevo::dem
