#include "chart/free_room.h"

#include <algorithm>
#include <cmath>

namespace relevo::chart {
namespace {

/// Side of a cell: about a label's width.
constexpr double kCell = 64;
constexpr double kMostCells = 256;

std::size_t cells_along(double length) {
    return static_cast<std::size_t>(std::clamp(std::ceil(length / kCell), 1.0, kMostCells));
}

/// The cell of a coordinate, of those along a side.
std::size_t cell_at(double from_edge, double length, std::size_t count) {
    const double cell = std::floor(from_edge / length * static_cast<double>(count));
    return cell > 0 ? std::min(static_cast<std::size_t>(std::min(cell, kMostCells)), count - 1) : 0;
}

}  // namespace

FreeRoom::FreeRoom(const Rect& within)
    : within_(within),
      columns_(cells_along(within.width)),
      rows_(cells_along(within.height)),
      cells_(columns_ * rows_) {}

FreeRoom::Cells FreeRoom::cells_of(const Rect& box) const {
    const double x = box.x - within_.x, y = box.y - within_.y;
    return {cell_at(x, within_.width, columns_), cell_at(x + box.width, within_.width, columns_),
            cell_at(y, within_.height, rows_), cell_at(y + box.height, within_.height, rows_)};
}

bool FreeRoom::is_free(const Rect& box) const {
    if (box.x < within_.x || box.y < within_.y || box.x + box.width > within_.x + within_.width ||
        box.y + box.height > within_.y + within_.height)
        return false;
    const Cells cells = cells_of(box);
    for (std::size_t row = cells.top; row <= cells.bottom; ++row)
        for (std::size_t column = cells.left; column <= cells.right; ++column)
            if (std::ranges::any_of(cells_[row * columns_ + column],
                                    [&](const Rect& other) { return overlap(box, other); }))
                return false;
    return true;
}

void FreeRoom::take(const Rect& box) {
    const Cells cells = cells_of(box);
    for (std::size_t row = cells.top; row <= cells.bottom; ++row)
        for (std::size_t column = cells.left; column <= cells.right; ++column)
            cells_[row * columns_ + column].push_back(box);
}

}  // namespace relevo::chart
