#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace relevo::test {

/// A row of an index of tiles.
struct IndexRow {
    std::string location;
    std::array<double, 4> extent;  ///< west, south, east, north
    std::string crs = {};          ///< the field src_srs; empty: not set
};

struct IndexLayer {
    std::string crs = "EPSG:32632";  ///< empty: none
    std::string field = "location";
    bool with_outlines = true;
};

/// Writes an index as a layer of polygons. @param driver  GDAL's name. @returns the path
std::string write_index(const std::filesystem::path& path, const std::string& driver,
                        const std::vector<IndexRow>& rows, const IndexLayer& layer = {});

/// The row of a raster that GDAL opens, with its absolute path.
IndexRow row_of(const std::string& raster);

/// Compresses a file. @returns the path of "NAME.gz"
std::string packed(const std::string& path);

/// Says in a GeoPackage how many rows a layer of `write_index` has, true or not.
void claim_rows(const std::string& geopackage, long long rows);

}  // namespace relevo::test
