#include "dem/frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace relevo::dem {

void FrameEdge::add(const Array2d<float>& line_m) {
    corners_ = corners_ && *line_m.begin() == height_m_ && *(line_m.end() - 1) == height_m_;
    posts_ += static_cast<double>(line_m.size());
    like_corner_ += static_cast<double>(std::count(line_m.begin(), line_m.end(), height_m_));
}

bool FrameEdge::may_be_frame() const {
    return corners_ && like_corner_ >= 0.95 * posts_;
}

void FrameSteps::add(const Array2d<float>& part_m) {
    const auto step = [&](float a, float b) {
        if ((a == height_m_) != (b == height_m_) && !std::isnan(a) && !std::isnan(b))
            steps_m_.push_back(std::abs(a - b));
    };
    for (int row = 0; row + 1 < part_m.height(); ++row)
        for (int column = 0; column + 1 < part_m.width(); ++column) {
            step(part_m.at(column, row), part_m.at(column + 1, row));
            step(part_m.at(column, row), part_m.at(column, row + 1));
        }
}

std::optional<Frame> FrameSteps::frame() {
    constexpr double kStep_m = 20;
    if (steps_m_.empty()) return std::nullopt;
    const auto middle = steps_m_.begin() + static_cast<std::ptrdiff_t>(steps_m_.size() / 2);
    std::nth_element(steps_m_.begin(), middle, steps_m_.end());
    const Frame frame{height_m_, static_cast<double>(*middle)};
    return frame.step_m > kStep_m ? std::optional(frame) : std::nullopt;
}

std::optional<Frame> find_frame(const Array2d<float>& height_m) {
    const int columns = height_m.width(), rows = height_m.height();
    FrameEdge edge(height_m.at(0, 0));
    for (const int row : {0, rows - 1}) {
        Array2d<float> line(columns, 1);
        std::copy_n(height_m.row(row).data(), columns, line.data());
        edge.add(line);
    }
    for (const int column : {0, columns - 1}) {
        Array2d<float> line(1, rows);
        for (int row = 0; row < rows; ++row)
            line.at(0, row) = height_m.at(column, row);
        edge.add(line);
    }
    if (!edge.may_be_frame()) return std::nullopt;
    FrameSteps steps(edge.height_m());
    steps.add(height_m);
    return steps.frame();
}

}  // namespace relevo::dem
