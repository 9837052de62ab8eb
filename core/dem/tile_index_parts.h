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

/// The vertices of the polygons that a tile's outline has.
using Outline = std::vector<std::vector<glm::dvec2>>;

/// Collects the tiles of an index.
class TileCollector {
  public:
    enum class Wanted { Tiles, Locations };

    /// @param tiles_crs  as read_tile_index() takes it
    /// @param wanted     Locations: no CRS is parsed, and no place computed
    TileCollector(const std::string& path, const geo::Crs* tiles_crs,
                  Wanted wanted = Wanted::Tiles);

    /// Has locations be URIs (RFC 3986), in which "%20" is a blank.
    void set_uris() { uris_ = true; }
    /// Sets what tiles are in that name no CRS.
    void set_crs(const geo::Crs& crs) { own_crs_ = crs; }

    /// @param location  as the index has it
    /// @param outline   in `outline_crs`; its parts may lie on both sides of the antimeridian
    /// @param crs       of the tile; empty: not stated
    /// @throws Error (BadInput) naming the tile
    void add(const std::string& location, const Outline& outline,
             const std::optional<geo::Crs>& outline_crs, const std::string& crs);
    /// The same, of a tile whose posts the index states.
    /// @param outlines  in WGS 84. Where the posts fill none of them, the first counts, and the
    ///     tile is noted in TileIndex::contradicting
    void add(const std::string& location, const TilePosts& posts, const std::string& crs,
             const std::vector<Outline>& outlines);

    /// A CRS by its text, parsed once; WGS 84 where only locations are wanted.
    /// @throws Error (BadInput)
    const geo::Crs& crs_of(const std::string& text);

    [[noreturn]] void fail(const std::string& what) const;
    /// The number of the row that is being read, from 1, and what it names.
    [[noreturn]] void fail_row(const std::string& location, const std::string& what) const;

    TileIndex take(const std::string& format);

  private:
    void begin_row(const std::string& location);
    Extent extent_in(const geo::Crs& own, const std::vector<glm::dvec2>& vertices,
                     const geo::Crs& crs, const std::string& location) const;
    void settle_crs(const std::string& location, IndexedTile& tile, const geo::Crs* crs);
    void keep(const std::string& location, IndexedTile tile);
    int number_of(const geo::Crs& crs);
    std::string unique_name(const std::string& location);

    TileIndex index_;
    std::string folder_;
    const geo::Crs* tiles_crs_;
    Wanted wanted_;
    bool uris_ = false;
    geo::Crs wgs84_;
    std::optional<geo::Crs> own_crs_;
    std::map<std::string, geo::Crs> known_;
    std::unordered_map<std::string, int> number_of_crs_;  // by its text
    std::unordered_set<std::string> names_;
    std::unordered_map<std::string, std::size_t> next_number_;  // of a name that is taken
    std::unordered_set<std::string> locations_;
    std::size_t row_ = 0;
};

/// How a tile is named for GDAL: relative names from `folder`, addresses as "/vsicurl/...".
std::string resolved_location(const std::string& folder, const std::string& location);

/// The same of a URI. Names of files are decoded; those that go into a URL or are GDAL's stay.
std::string resolved_uri(const std::string& folder, const std::string& uri);

/// A STAC Item or a collection of Items. @param text  of the file
/// @param crs  as read_tile_index() takes it
/// @throws Error (BadInput)
TileIndex read_stac(const std::string& text, const std::string& crs, TileCollector& tiles);

}  // namespace relevo::dem
