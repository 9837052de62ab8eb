#include "dem/collar.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include <glm/vec2.hpp>

namespace relevo::dem {

void CollarEdge::add(std::span<const float> posts_m) {
    others_ += std::ssize(posts_m) - std::ranges::count(posts_m, height_m_);
}

void CollarEdge::add(float height_m, std::int64_t posts) {
    if (height_m != height_m_) others_ += posts;
}

bool CollarEdge::may_be_collar() const {
    return corners_ && static_cast<double>(posts_ - others_) >= 0.95 * static_cast<double>(posts_);
}

void CollarSteps::add(const Array2d<float>& height_m, const Window& part) {
    constexpr std::size_t kMaxSteps = 1 << 24;
    const auto step = [&](float a, float b) {
        if ((a == height_m_) == (b == height_m_) || std::isnan(a) || std::isnan(b)) return;
        if (++left_out_ < every_) return;
        left_out_ = 0;
        steps_m_.push_back(std::abs(a - b));
        if (steps_m_.size() < kMaxSteps) return;
        for (std::size_t i = 0; i < kMaxSteps / 2; ++i)
            steps_m_[i] = steps_m_[2 * i];
        steps_m_.resize(kMaxSteps / 2);
        every_ *= 2;
    };
    for (int row = part.row; row + 1 < part.row + part.rows; ++row)
        for (int column = part.column; column + 1 < part.column + part.columns; ++column) {
            step(height_m.at(column, row), height_m.at(column + 1, row));
            step(height_m.at(column, row), height_m.at(column, row + 1));
        }
}

std::optional<Collar> CollarSteps::collar() {
    constexpr double kStep_m = 20;
    if (steps_m_.empty()) return std::nullopt;
    const auto middle = steps_m_.begin() + static_cast<std::ptrdiff_t>(steps_m_.size() / 2);
    std::nth_element(steps_m_.begin(), middle, steps_m_.end());
    const Collar collar{height_m_, static_cast<double>(*middle)};
    return collar.step_m > kStep_m ? std::optional(collar) : std::nullopt;
}

std::optional<Collar> find_collar(const Array2d<float>& height_m) {
    const int columns = height_m.width(), rows = height_m.height();
    CollarEdge edge(height_m.at(0, 0), 2 * (std::int64_t{columns} + rows));
    for (const int row : {0, rows - 1}) {
        edge.add_corner(height_m.at(0, row));
        edge.add_corner(height_m.at(columns - 1, row));
        edge.add(height_m.row(row));
    }
    for (int row = 0; row < rows; ++row) {
        edge.add(height_m.row(row).first(1));
        edge.add(height_m.row(row).last(1));
    }
    if (!edge.may_be_collar()) return std::nullopt;
    CollarSteps steps(edge.height_m());
    steps.add(height_m, {0, 0, columns, rows});
    return steps.collar();
}

Array2d<float> without_collar(Array2d<float> height_m, const Collar& collar) {
    const int columns = height_m.width(), rows = height_m.height();
    std::vector<glm::ivec2> to_visit;
    const auto take = [&](int column, int row) {
        if (column < 0 || row < 0 || column >= columns || row >= rows ||
            height_m.at(column, row) != collar.height_m)
            return;
        height_m.at(column, row) = std::numeric_limits<float>::quiet_NaN();
        to_visit.push_back({column, row});
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; column += row % (rows - 1) == 0 ? 1 : columns - 1)
            take(column, row);
    while (!to_visit.empty()) {
        const glm::ivec2 at = to_visit.back();
        to_visit.pop_back();
        take(at.x - 1, at.y);
        take(at.x + 1, at.y);
        take(at.x, at.y - 1);
        take(at.x, at.y + 1);
    }
    return height_m;
}

}  // namespace relevo::dem
