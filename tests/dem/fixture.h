#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace relevo::test {

/// A folder for the rasters of the case that runs, empty when the case asks first.
const std::filesystem::path& folder();

/// A file of `tests/data/cases`.
std::string small_case(const std::string& name);

/// A raster to be written with GDAL, for tests that must run anywhere.
struct Raster {
    std::string driver = "GTiff";
    std::string type = "Float32";  ///< GDAL's name
    int columns = 6;
    int rows = 4;
    int bands = 1;
    /// GDAL's six numbers, of cell corners; none: no georeference.
    std::optional<std::array<double, 6>> geotransform = {{500000, 30, 0, 5200000, 0, -30}};
    std::string crs = "EPSG:32632";  ///< empty: none
    std::optional<double> nodata = {};
    std::string unit = {};
    std::optional<double> scale = {};
    std::optional<double> offset = {};
    std::vector<std::pair<std::string, std::string>> about = {};  ///< metadata of each band
    std::vector<std::string> options = {};  ///< of the driver, "COMPRESS=DEFLATE"
    /// What is stored at a column and row of a band, from 1.
    std::function<double(int column, int row, int band)> value = [](int column, int row, int) {
        return 100.0 + column + 10 * row;
    };
    /// GeoTIFF only: the tie point, which is the geotransform's first, is a post and no corner.
    bool pixel_is_point = false;
    bool pictures = false;  ///< the bands are red, green, blue
    /// Where false, the cell is a hole of a mask that belongs to the whole file.
    std::function<bool(int column, int row)> mask = {};
};

/// Writes a raster. @returns the path
std::string write_raster(const std::filesystem::path& path, const Raster& raster);

/// Writes a raster of which only some posts are stored, each {column, row, value}; the rest costs
/// no room where the driver can do that.
std::string write_sparse_raster(const std::filesystem::path& path, const Raster& raster,
                                const std::vector<std::array<double, 3>>& posts);

/// Adds overviews, averages of so many posts each way, to a raster.
void add_overviews(const std::string& path, std::vector<int> factors);

/// The same in a file beside it, which is not written to: "a.tif.ovr".
void add_outer_overviews(const std::string& path, std::vector<int> factors);

/// Keeps the first `bytes` of a file.
void cut_short(const std::string& path, std::uintmax_t bytes);

}  // namespace relevo::test
