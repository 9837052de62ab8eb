#pragma once

#include <functional>
#include <string>

#include "dem/heightfield.h"
#include "dem/load.h"
#include "support/support.h"

namespace relevo::test {

/// Heights at the posts of a grid, without a file.
/// @param height_m  of a column and row; NaN for a hole
inline dem::Heightfield field_of(int columns, int rows, const dem::Affine& affine,
                                 const std::string& crs,
                                 const std::function<double(int, int)>& height_m) {
    Array2d<float> heights(columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            heights.at(column, row) = static_cast<float>(height_m(column, row));
    dem::Description about;
    about.path = "made for a test";
    about.statistics = dem::statistics(heights);
    return {std::move(heights), dem::Grid(columns, rows, affine, geo::Crs::parse(crs, "test")),
            about};
}

/// A DEM that ships with the project.
inline dem::Heightfield bundled(const std::string& name) {
    return dem::load((source_dir() / "data" / "dem" / name).string());
}

}  // namespace relevo::test
