#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dem/csv.h"

// What the readers of GPX and GeoJSON share. Inside of the layer only.

namespace relevo::dem {

/// A vertex of a file: numbers, but not yet known to be a place on Earth.
struct VectorPoint {
    double lat_deg = 0, lon_deg = 0;
    std::string name;      ///< of a single point
    std::string time;      ///< as sun::parse_time() reads it; empty where the file has none
    std::size_t line = 0;  ///< of the file, from 1
};

/// A track, a route, a LineString or a MultiLineString, whose parts are joined.
struct VectorLine {
    std::string name;
    std::vector<VectorPoint> points;
};

}  // namespace relevo::dem
