#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dem/grid.h"

namespace relevo::dem {

/// A rectangle in a CRS, as GDAL takes one: its sides are lines of equal x and of equal y.
struct Clip {
    double west = 0, south = 0, east = 0, north = 0;
    std::optional<geo::Crs> crs;  ///< none: the DEM's own
    std::string text;             ///< as it was given
};

/// Reads `--clip W,S,E,N`. @throws Error (Usage) for what are not four numbers in that order
Clip parse_clip(std::string_view text, std::string_view who);

/// The smallest window of a grid that has all posts in a rectangle; posts are in the middle of
/// their cells. On a turned grid, or by another CRS, there are others in it too.
/// Longitudes are those of any turn.
/// @throws Error (BadInput) where there is not one, or where the rectangle is at both ends of the
///         grid's rows, which are one meridian
Window window_of(const Grid& grid, const Clip& clip, std::string_view who);

/// The window of `--crop W,S,E,N` in degrees. @throws Error (Usage, BadInput) also for fewer than
/// 2 x 2 posts
Window crop_of(const Grid& grid, const std::string& text);

}  // namespace relevo::dem
