#include "dem/north_up.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace relevo::dem {
namespace {

Affine swapped(const Affine& a) {
    return {a.x0, a.x_row, a.x_column, a.y0, a.y_row, a.y_column};
}

/// @param last  index of the last column
Affine with_columns_flipped(const Affine& a, int last) {
    return {a.x0 + a.x_column * last, -a.x_column, a.x_row,
            a.y0 + a.y_column * last, -a.y_column, a.y_row};
}

/// @param last  index of the last row
Affine with_rows_flipped(const Affine& a, int last) {
    return {a.x0 + a.x_row * last, a.x_column, -a.x_row,
            a.y0 + a.y_row * last, a.y_column, -a.y_row};
}

}  // namespace

NorthUp north_up_of(const Affine& post_to_crs) {
    const auto share_of_x = [](double x, double y) { return std::abs(x) / std::hypot(x, y); };
    NorthUp turn;
    turn.swap = share_of_x(post_to_crs.x_row, post_to_crs.y_row) >
                share_of_x(post_to_crs.x_column, post_to_crs.y_column);
    Affine a = turn.swap ? swapped(post_to_crs) : post_to_crs;
    turn.flip_columns = a.x_column < 0;
    if (turn.flip_columns) a = with_columns_flipped(a, 0);
    // Columns eastwards, rows southwards: the determinant is negative, on oblique grids too.
    turn.flip_rows = a.x_column * a.y_row - a.x_row * a.y_column > 0;
    return turn;
}

Heightfield turned(Heightfield field, const NorthUp& turn) {
    Affine affine = field.grid.affine();
    if (turn.swap) {
        Array2d<float> columns(field.height_m.height(), field.height_m.width());
        for (int row = 0; row < columns.height(); ++row)
            for (int column = 0; column < columns.width(); ++column)
                columns.at(column, row) = field.height_m.at(row, column);
        field.height_m = std::move(columns);
        affine = swapped(affine);
    }
    const int columns = field.height_m.width(), rows = field.height_m.height();
    if (turn.flip_columns) {
        for (int row = 0; row < rows; ++row)
            std::ranges::reverse(field.height_m.row(row));
        affine = with_columns_flipped(affine, columns - 1);
    }
    if (turn.flip_rows) {
        for (int row = 0; row < rows / 2; ++row)
            std::ranges::swap_ranges(field.height_m.row(row), field.height_m.row(rows - 1 - row));
        affine = with_rows_flipped(affine, rows - 1);
    }
    field.grid = Grid(columns, rows, affine, field.grid.crs());
    return field;
}

}  // namespace relevo::dem
