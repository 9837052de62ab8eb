#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "base/array2d.h"

namespace relevo::climate {

/// Between the middles of cells, of which (0, 0) is the first; beyond the rim as at the rim.
inline float bilinear(const Array2d<float>& cells, double column, double row) {
    const double x = std::clamp(column, 0.0, cells.width() - 1.0);
    const double y = std::clamp(row, 0.0, cells.height() - 1.0);
    const int i = std::max(0, std::min(static_cast<int>(x), cells.width() - 2));
    const int j = std::max(0, std::min(static_cast<int>(y), cells.height() - 2));
    const int right = std::min(i + 1, cells.width() - 1),
              down = std::min(j + 1, cells.height() - 1);
    const auto u = static_cast<float>(x - i), v = static_cast<float>(y - j);
    return (1 - v) * ((1 - u) * cells.at(i, j) + u * cells.at(right, j)) +
           v * ((1 - u) * cells.at(i, down) + u * cells.at(right, down));
}

/// A Gaussian mean; beyond the rim as at the rim.
/// @param sigma  in cells
void smooth(Array2d<float>& cells, double sigma);

/// The lowest or highest value of the squares around all cells, rounded as `smooth` would.
/// @param reach  cells from the middle of a square to its sides
Array2d<float> lowest_around(const Array2d<float>& cells, int reach);
Array2d<float> highest_around(const Array2d<float>& cells, int reach);

/// Gives cells that have none the mean of their neighbours that have one, from these outwards.
/// @param has  whether a cell has values
void fill_outwards(std::span<Array2d<float>> layers, const std::function<bool(int, int)>& has);

}  // namespace relevo::climate
