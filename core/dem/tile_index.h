#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dem/grid.h"
#include "dem/heightfield.h"

/// Files that name the tiles of a large raster and say where each lies, so that nobody has to open
/// them: a layer of polygons with a field `location` (gdaltindex; GeoPackage, FlatGeobuf,
/// Shapefile, GeoJSON; also as .gz), or a STAC Item, ItemCollection or FeatureCollection of Items.
namespace relevo::dem {

/// More tiles than these are refused.
inline constexpr std::size_t kMostTiles = 1'000'000;

/// An index of tiles in more coordinate reference systems than these is refused: PROJ takes 10 ms
/// and 200 kB for each. UTM has 120 zones.
inline constexpr std::size_t kMostCrs = 256;

/// A rectangle in the coordinates of a CRS: the outer edges of a raster's cells.
struct Extent {
    double west = 0, south = 0, east = 0, north = 0;

    friend bool operator==(const Extent&, const Extent&) = default;
};

/// The posts of a tile, where its index states them.
struct TilePosts {
    int columns = 0, rows = 0;
    Affine affine;
};

struct IndexedTile {
    std::string name;      ///< of its file, without folder and ending; no two of an index are equal
    std::string location;  ///< as GDAL opens it; absolute, or relative to the current folder
    Extent extent;         ///< in the tile's CRS
    int crs = -1;          ///< which of TileIndex::crs is the tile's; -1: the index does not say
    std::optional<TilePosts> posts;  ///< STAC: `proj:shape` and `proj:transform`
    bool posts_are_near = false;  ///< `posts` are `proj:shape` within the outline: half a post off
};

struct TileIndex {
    std::string path;                ///< as given
    std::string format;              ///< GDAL's short name of the driver, or "STAC"
    std::vector<geo::Crs> crs;       ///< those of its tiles
    std::vector<IndexedTile> tiles;  ///< in its order: where tiles overlap, the later is on top
    std::size_t repeated = 0;        ///< rows that name a tile again; they are not in `tiles`
    NamedTiles contradicting;        ///< their posts are not within their outlines, which are taken
};

/// Whether a name has the ending of an index: ".gpkg", ".fgb", ".shp", ".geojson", ".json".
bool is_index_name(const std::string& path);

/// Whether a file is an index. Opens only files whose ending is that of one.
bool is_tile_index(const std::string& path);

/// Why a file that looks like an index is none: polygons without a field `location`. Empty for
/// others.
std::string why_no_index(const std::string& path);

/// Reads an index. Opens no tile. Names of tiles relative to the index are resolved; addresses
/// become names of GDAL ("https://..." "/vsicurl/https://..."). Whether tiles may be remote is for
/// who opens them (refuse_remote_tiles()).
///
/// The CRS of a tile is that of its field `src_srs` (STAC: `proj:code`, `proj:epsg`, `proj:wkt2`),
/// else the index's. Outlines in another CRS are transformed, vertex by vertex. 100 000 tiles take
/// 0.5 s and 300 bytes each beyond their names (tests/dem/bench_tile_index).
/// @param crs  instead of every CRS that the index names, as `--crs` takes it; empty: the index's
/// @param tiles_crs  of tiles to which the index gives no CRS of their own; null: the index's
/// @throws Error (BadInput) `PATH: what` for what is no index, cut short, empty, of more than
///     kMostTiles or kMostCrs, or has a tile without a name or without a place on the Earth
TileIndex read_tile_index(const std::string& path, const std::string& crs = {},
                          const geo::Crs* tiles_crs = nullptr);

/// The tiles of an index as GDAL opens them, in its order. Reads no place, so that an index which
/// needs another CRS (`--crs`) names its files without it.
/// @throws Error (BadInput) as read_tile_index(), except for places
std::vector<std::string> tile_locations(const std::string& path);

/// The outer edges of cells. NaN where a number is none.
Extent extent_of(const TilePosts& posts);

/// Refuses an index on this machine whose tiles are on the net, which is asked only by a name on
/// the command line. @throws Error (BadInput)
void refuse_remote_tiles(const TileIndex& index);

}  // namespace relevo::dem
