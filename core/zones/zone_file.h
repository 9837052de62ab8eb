#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geo/crs.h"
#include "zones/even_odd.h"

namespace relevo::zones {

struct Zone {
    std::string id;
    std::vector<Ring> rings;  ///< in the file's CRS
    std::string fault;        ///< why it is no polygon; empty where it is one
};

struct ZoneFile {
    std::vector<Zone> zones;      ///< in the order of the file
    std::optional<geo::Crs> crs;  ///< none where the file does not say
};

/// Reads the polygons of a file, of its only layer with polygons: GeoPackage, GeoJSON, FlatGeobuf,
/// Shapefile. Curves become chords of 4 degrees.
/// @param id_field  whose text names a zone; empty: the feature's number in the file
/// @throws Error (BadInput) where GDAL does not read it, no layer or several have polygons, or
///     there is no such field (the message lists those there are)
ZoneFile read_zones(const std::string& path, const std::string& id_field);

}  // namespace relevo::zones
