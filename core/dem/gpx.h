#pragma once

#include <functional>

#include "dem/vector_point.h"

// GPX 1.0 and 1.1 (https://www.topografix.com/GPX/1/1/). Inside of the layer only.

namespace relevo::dem {

enum class GpxKind { Waypoints, Tracks, Routes };

/// Reads a GPX file by Expat, in bounded memory. Latitudes and longitudes are the schema's: decimal
/// degrees with a decimal point, nothing else. Times without a zone are UTC, as the schema says of
/// all times. Heights are not read. A file that declares entities is refused.
/// @param visit  gets each point of the kind, and the number of its track or route, from 1
/// @returns the names of all tracks or routes of the kind; empty where the file has none
/// @throws Error (BadInput) with the line, for what is no GPX, and for a point of the kind without
///     a latitude or longitude that is a number
std::vector<std::string> read_gpx(const FileErrors& errors, GpxKind kind,
                                  const std::function<void(int, VectorPoint&&)>& visit);

}  // namespace relevo::dem
