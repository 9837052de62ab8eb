#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include "dem/fixture.h"

namespace relevo::test {

/// Writes hills in metres, of which no two parts are alike, with more posts than 1 MiB has room
/// for. Posts from column 110 and row 112 on, 30 x 40 of them, are voids.
/// @param is_void  whether another post is one
/// @returns the path
inline std::string write_hills(const std::filesystem::path& path,
                               const std::function<bool(int column, int row)>& is_void) {
    Raster raster;
    raster.columns = 701;
    raster.rows = 401;
    raster.geotransform = {{500000, 30, 0, 5300000, 0, -20}};
    raster.nodata = -9999;
    raster.value = [&](int column, int row, int) {
        const bool in_gap = column >= 110 && column < 140 && row >= 112 && row < 152;
        if (in_gap || is_void(column, row)) return -9999.0;
        return 700 + 300 * std::sin(column / 23.0) * std::cos(row / 31.0) + column * 1.5;
    };
    return write_raster(path, raster);
}

}  // namespace relevo::test
