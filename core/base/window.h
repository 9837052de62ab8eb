#pragma once

#include <algorithm>

namespace relevo {

/// A rectangle of the posts of a grid: columns [column, column + columns), rows [row, row + rows).
struct Window {
    int column = 0;
    int row = 0;
    int columns = 0;
    int rows = 0;

    int end_column() const { return column + columns; }
    int end_row() const { return row + rows; }
    bool is_empty() const { return columns <= 0 || rows <= 0; }

    friend bool operator==(const Window&, const Window&) = default;
};

/// The posts that two windows have in common; an empty window where there are none.
inline Window common(const Window& a, const Window& b) {
    const int column = std::max(a.column, b.column), row = std::max(a.row, b.row);
    return {column, row, std::max(0, std::min(a.end_column(), b.end_column()) - column),
            std::max(0, std::min(a.end_row(), b.end_row()) - row)};
}

}  // namespace relevo
