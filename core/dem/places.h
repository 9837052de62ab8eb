#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "geo/geodetic.h"

/// Places that a file of somebody else's names: CSV, GPX or GeoJSON, told apart by how they begin.
///
/// CSV: the first line names the columns, whatever their order and their capitals: `lat` and `lon`
/// (also `latitude`, `longitude`, `lng`, `long`, `lat_deg`, `lon_deg`), or `x` and `y` (also
/// `easting`, `northing`) in a CRS that is given; `name` (also `id`, `title`), `height` as the H of
/// LAT,LON,H, `time`, `rank`, `tilt`, `azimuth`. Columns are parted by commas, semicolons or tabs;
/// lines that begin with # are skipped. Heights in GPX and GeoJSON are not read: the DEM has the
/// ground's. A number is one with a decimal point: what cannot be read as written is an
/// error, never skipped.
namespace relevo::dem {

/// More places than these are refused: a GPS of one fix a second has them in eleven days.
inline constexpr std::size_t kMostPlaces = 1'000'000;

struct NamedPlace {
    std::string name;      ///< empty where the file has none
    geo::PlaceText at;     ///< a height only from a CSV's column
    std::string time;      ///< as sun::parse_time() reads it; empty where the file has none
    std::size_t line = 0;  ///< of the file, from 1
    std::string rank{};    ///< as written, from a CSV's column
    std::string tilt{}, azimuth{};  ///< of a plane at the place, as written
};

struct NamedLine {
    std::string name;                ///< empty where the file has none
    std::vector<NamedPlace> places;  ///< two or more; gaps of a track are bridged
};

/// Rows of a CSV, waypoints of a GPX (where it has none the points of its tracks, else of its
/// routes), points of a GeoJSON, in their order.
/// @param who  what errors begin with, "--points"
/// @param crs  of x and y in a CSV, as geo::Crs::parse() reads it; empty: none. For other files an
///     error
/// @throws Error (BadInput) for what is no such file, has no points, more than kMostPlaces, or a
///     coordinate that is none: `who: path: line 17: what`
std::vector<NamedPlace> read_points(const std::string& path, std::string_view who,
                                    const std::string& crs = {});

/// The rows of a CSV; a track of a GPX, or a route where it has no tracks; a line of a GeoJSON.
/// @param number  which of several lines, from 1; 0: the only one there is
/// @throws Error (BadInput) as read_points(), and where there is not that line
NamedLine read_line(const std::string& path, std::string_view who, const std::string& crs = {},
                    int number = 0);

struct NamedTime {
    std::string name;  ///< empty where the file has none
    std::string time;  ///< as `--time` takes it
    std::size_t line;  ///< of the file, from 1
};

/// The rows of a CSV with a column `time` and perhaps `name`, as above.
/// @param most  more are refused
/// @throws Error (BadInput) for what is no such file, has no times, or too many
std::vector<NamedTime> read_times(const std::string& path, std::string_view who, std::size_t most);

}  // namespace relevo::dem
