#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "base/array2d.h"

namespace relevo::climate {

/// Four cells around a point, of which (0, 0) is the middle of the first; beyond the rim as at the
/// rim.
struct Around {
    int left, right, up, down;
    float u, v;  // from left to right, and down

    Around(int width, int height, double column, double row) {
        const double x = std::clamp(column, 0.0, width - 1.0);
        const double y = std::clamp(row, 0.0, height - 1.0);
        left = static_cast<int>(x);
        up = static_cast<int>(y);
        right = std::min(left + 1, width - 1);
        down = std::min(up + 1, height - 1);
        u = static_cast<float>(x - left);
        v = static_cast<float>(y - up);
    }
};

inline float bilinear(const Array2d<float>& cells, double column, double row) {
    const Around at(cells.width(), cells.height(), column, row);
    return (1 - at.v) * ((1 - at.u) * cells.at(at.left, at.up) + at.u * cells.at(at.right, at.up)) +
           at.v * ((1 - at.u) * cells.at(at.left, at.down) + at.u * cells.at(at.right, at.down));
}

/// The same of several values a cell.
template <std::size_t Count>
std::array<float, Count> bilinear(const Array2d<std::array<float, Count>>& cells, double column,
                                  double row) {
    const Around at(cells.width(), cells.height(), column, row);
    const auto &a = cells.at(at.left, at.up), &b = cells.at(at.right, at.up);
    const auto &c = cells.at(at.left, at.down), &d = cells.at(at.right, at.down);
    const float right_down = at.u * at.v, left_down = at.v - right_down;
    const float right_up = at.u - right_down, left_up = 1 - at.u - left_down;
    std::array<float, Count> values;
    for (std::size_t i = 0; i < Count; ++i)
        values[i] = left_up * a[i] + right_up * b[i] + left_down * c[i] + right_down * d[i];
    return values;
}

/// A Gaussian mean; beyond the rim as at the rim.
/// @param sigma  in cells
void smooth(Array2d<float>& cells, double sigma);

/// Gives cells that have none the mean of their neighbours that have one, from these outwards.
/// @param has  whether a cell has values
void fill_outwards(std::span<Array2d<float>> layers, const std::function<bool(int, int)>& has);

}  // namespace relevo::climate
