#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "mesh/delaunay.h"

namespace relevo::mesh {

/// The lattice points in a triangle and on its edges, row by row. Exact.
class Spans {
  public:
    /// @param corners  whose twice_area() is positive
    explicit Spans(const std::array<LatticePoint, 3>& corners) {
        first_row = std::min({corners[0].row, corners[1].row, corners[2].row});
        last_row = std::max({corners[0].row, corners[1].row, corners[2].row});
        first_ = std::min({corners[0].column, corners[1].column, corners[2].column});
        last_ = std::max({corners[0].column, corners[1].column, corners[2].column});
        for (std::size_t i = 0; i < 3; ++i) {
            const LatticePoint &a = corners[i], &b = corners[(i + 1) % 3];
            // twice_area(a, b, p) = slope * column + rise * row + constant, 0 or more inside.
            edges_[i] = {a.row - b.row, b.column - a.column,
                         std::int64_t{a.column} * b.row - std::int64_t{a.row} * b.column};
        }
    }

    int first_row = 0, last_row = 0;

    /// The columns of a row, both included; none where the first is above the last.
    std::array<int, 2> columns(int row) const {
        std::int64_t first = first_, last = last_;
        for (const Edge& edge : edges_) {
            const std::int64_t rest = edge.rise * row + edge.constant;
            if (edge.slope > 0)
                first = std::max(first, -floor_of(rest, edge.slope));
            else if (edge.slope < 0)
                last = std::min(last, floor_of(rest, -edge.slope));
            else if (rest < 0)
                return {0, -1};
        }
        return {static_cast<int>(first), static_cast<int>(last)};
    }

  private:
    struct Edge {
        std::int64_t slope, rise, constant;
    };
    /// @param divisor  above 0
    static std::int64_t floor_of(std::int64_t value, std::int64_t divisor) {
        return value >= 0 ? value / divisor : -((-value + divisor - 1) / divisor);
    }

    std::array<Edge, 3> edges_{};
    int first_ = 0, last_ = 0;
};

}  // namespace relevo::mesh
