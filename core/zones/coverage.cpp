#include "zones/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace relevo::zones {
namespace {

/// Sums of a row of cells: running along it they are the shares that lie behind edges.
class Row {
  public:
    Row(double* sums, const Window& window) : sums_(sums), window_(window) {}

    /// Adds what is behind a piece of an edge within the row. @param x  from the window's left
    void add(double x0, double x1, double height) {
        const double width = window_.columns;
        if (x0 > x1) std::swap(x0, x1);
        if (x0 >= width) return;
        if (x1 <= 0) {
            sums_[0] += height;
            return;
        }
        const double per_x = x1 > x0 ? height / (x1 - x0) : 0;
        if (x0 < 0) {
            sums_[0] += -x0 * per_x;
            height += x0 * per_x;
            x0 = 0;
        }
        if (x1 > width) {
            height -= (x1 - width) * per_x;
            x1 = width;
        }
        const int first = std::min(static_cast<int>(x0), window_.columns - 1);
        const int last = std::min(static_cast<int>(std::ceil(x1)) - 1, window_.columns - 1);
        if (last <= first) return add_to(first, 0.5 * (x0 + x1), height);
        add_to(first, 0.5 * (x0 + first + 1), (first + 1 - x0) * per_x);
        for (int column = first + 1; column < last; ++column)
            add_to(column, column + 0.5, per_x);
        add_to(last, 0.5 * (last + x1), (x1 - last) * per_x);
    }

  private:
    void add_to(int column, double middle, double height) {
        const double behind = middle - column;
        sums_[column] += height * (1 - behind);
        if (column + 1 < window_.columns) sums_[column + 1] += height * behind;
    }

    double* sums_;
    const Window& window_;
};

void add(const Edge& edge, const Window& window, std::vector<double>& sums) {
    const double left = window.column, top = window.row;
    const double low_y = std::max(edge.low.y - top, 0.0);
    const double high_y = std::min(edge.high.y - top, static_cast<double>(window.rows));
    const double x_per_y = (edge.high.x - edge.low.x) / (edge.high.y - edge.low.y);
    const auto x_at = [&](double y) {
        return edge.low.x + (y + top - edge.low.y) * x_per_y - left;
    };
    for (int row = static_cast<int>(low_y); row < window.rows && row < high_y; ++row) {
        const double y0 = std::max<double>(row, low_y), y1 = std::min<double>(row + 1, high_y);
        if (y1 <= y0) continue;
        Row(&sums[static_cast<std::size_t>(row) * static_cast<std::size_t>(window.columns)], window)
            .add(x_at(y0), x_at(y1), edge.enters ? y1 - y0 : y0 - y1);
    }
}

}  // namespace

Window cells_of(std::span<const Edge> edges, const Window& all) {
    glm::dvec2 low(1e300), high(-1e300);
    for (const Edge& edge : edges) {
        low = {std::min({low.x, edge.low.x, edge.high.x}), std::min(low.y, edge.low.y)};
        high = {std::max({high.x, edge.low.x, edge.high.x}), std::max(high.y, edge.high.y)};
    }
    const auto within = [](double at, int first, int end) {
        return static_cast<int>(
            std::clamp(at, static_cast<double>(first), static_cast<double>(end)));
    };
    const int column = within(std::floor(low.x), all.column, all.end_column());
    const int row = within(std::floor(low.y), all.row, all.end_row());
    return {column, row, within(std::ceil(high.x), column, all.end_column()) - column,
            within(std::ceil(high.y), row, all.end_row()) - row};
}

std::vector<double> coverage(std::span<const Edge> edges, const Window& window) {
    const auto columns = static_cast<std::size_t>(window.columns);
    std::vector<double> shares(columns * static_cast<std::size_t>(window.rows));
    for (const Edge& edge : edges)
        if (edge.high.y > window.row && edge.low.y < window.end_row()) add(edge, window, shares);
    for (std::size_t row = 0; row < static_cast<std::size_t>(window.rows); ++row) {
        double sum = 0;
        for (std::size_t column = 0; column < columns; ++column) {
            double& share = shares[row * columns + column];
            sum += share;
            share = std::clamp(sum, 0.0, 1.0);
        }
    }
    return shares;
}

}  // namespace relevo::zones
