#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dem/grid.h"

namespace relevo::dem {

/// Where a raster lies: the outer edges of its cells, degrees of longitude and latitude.
struct Bounds {
    double west_deg = 0;
    double south_deg = 0;
    double east_deg = 0;  ///< above west_deg; up to 540, as bounds may cross the antimeridian
    double north_deg = 0;

    friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// Reads `--bounds W,S,E,N`. East of 180 comes after west: 179,-1,-179,1 is 2 degrees wide.
/// @throws Error (Usage) `who: text: what, expected E but got G; remedy`
Bounds parse_bounds(std::string_view text, std::string_view who);

/// The grid of cells, row 0 in the north, whose south-west and north-east corners are those of the
/// bounds in a CRS.
Affine affine_of(const Bounds& bounds, const geo::Crs& crs, int columns, int rows);

/// A tile of the web maps' pyramid: 2^zoom by 2^zoom of them make a square Mercator world
/// (EPSG:3857), x counted from 180 W and y from the north.
struct WebTile {
    int zoom = 0;
    int x = 0;
    int y = 0;

    friend bool operator==(const WebTile&, const WebTile&) = default;
};

/// The tile that a path names by its ending, ".../z/x/y.png", the way web maps store and serve
/// them. A file's own folders count also where the path is relative.
std::optional<WebTile> web_tile(const std::string& path);

/// The cells of a tile, in metres of EPSG:3857.
Affine affine_of(const WebTile& tile, int columns, int rows);

}  // namespace relevo::dem
