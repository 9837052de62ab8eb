#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "dem/grid.h"

namespace relevo::dem {

/// More vertices than these are refused.
inline constexpr std::size_t kMostLineVertices = 2'000'000;
/// With those that lines need where they bend on the grid.
inline constexpr std::size_t kMostPlacedVertices = 2 * kMostLineVertices;

/// A line of a vector file over a DEM.
struct PlacedLine {
    std::vector<glm::dvec2> posts;  ///< columns and rows of the DEM; two or more, all finite
    std::vector<double> along_m;    ///< geodesic distance from its start at each of them [m]
    double value = 0;               ///< the attribute; NaN where the feature has none
    int number = 0;  ///< of the feature in the file, from 0: several lines of one share it
};

/// Lines, and outlines of polygons, of a vector file: Shapefile, GeoPackage, GeoJSON, KML, GPX
/// (tracks and routes), FlatGeobuf or MapInfo, in any CRS that the file names.
///
/// A line is straight between two vertices in the coordinates of the file, and gets vertices
/// between them where it bends on the DEM's grid by more than 0.005 posts. Between two longitudes
/// more than 180 degrees apart it goes the shorter way. On a DEM around the whole Earth lines that
/// cross its edge are there twice. Lines end where a vertex has no place on the DEM's CRS.
/// @param who        what errors begin with: "tracks.file"
/// @param attribute  name of a field with numbers; empty: none
/// @throws Error (BadInput) `who: path: what` for a file that is missing, is no vector file of
/// these
///     kinds, has no lines, no CRS, no such attribute, coordinates that are no numbers, or more
///     than kMostLineVertices
std::vector<PlacedLine> read_lines(const std::string& path, std::string_view who,
                                   const std::string& attribute, const Grid& dem);

}  // namespace relevo::dem
