#pragma once

#include "dem/vector_point.h"

// GeoJSON (RFC 7946). Inside of the layer only.

namespace relevo::dem {

struct GeoJson {
    std::vector<VectorPoint> points;  ///< of Point and MultiPoint, in the file's order
    std::vector<VectorLine> lines;    ///< a feature each, of LineString and MultiLineString
};

/// Reads a GeoJSON file, in some ten times its size of memory. Other geometries are skipped, and so
/// are heights. A member `crs`, which the format had until 2016, is honoured where it names one
/// that PROJ knows; its coordinates are x before y whatever the authority says.
/// @throws Error (BadInput) with the line, for what is no GeoJSON, a `crs` that cannot be read, and
///     a position that is not two or three numbers, or four with a measure
GeoJson read_geojson(const FileErrors& errors);

}  // namespace relevo::dem
