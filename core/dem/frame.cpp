#include "dem/frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace relevo::dem {

std::optional<Frame> find_frame(const Array2d<float>& height_m) {
    constexpr double kStep_m = 20;
    const int right = height_m.width() - 1, bottom = height_m.height() - 1;
    Frame frame;
    frame.height_m = height_m.at(0, 0);
    const auto is_frame = [&](int column, int row) {
        return height_m.at(column, row) == frame.height_m;
    };
    if (!is_frame(0, 0) || !is_frame(right, 0) || !is_frame(0, bottom) || !is_frame(right, bottom))
        return std::nullopt;
    int edge = 0;
    for (int column = 0; column <= right; ++column)
        edge += is_frame(column, 0) + is_frame(column, bottom);
    for (int row = 0; row <= bottom; ++row)
        edge += is_frame(0, row) + is_frame(right, row);
    if (edge < 0.95 * 2 * (right + bottom + 2)) return std::nullopt;
    std::vector<float> steps_m;
    const auto step = [&](float a, float b) {
        if ((a == frame.height_m) != (b == frame.height_m) && !std::isnan(a) && !std::isnan(b))
            steps_m.push_back(std::abs(a - b));
    };
    for (int row = 0; row < bottom; ++row)
        for (int column = 0; column < right; ++column) {
            step(height_m.at(column, row), height_m.at(column + 1, row));
            step(height_m.at(column, row), height_m.at(column, row + 1));
        }
    if (steps_m.empty()) return std::nullopt;
    const auto middle = steps_m.begin() + static_cast<std::ptrdiff_t>(steps_m.size() / 2);
    std::nth_element(steps_m.begin(), middle, steps_m.end());
    frame.step_m = static_cast<double>(*middle);
    return frame.step_m > kStep_m ? std::optional(frame) : std::nullopt;
}

}  // namespace relevo::dem
