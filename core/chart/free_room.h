#pragma once

#include <cstddef>
#include <vector>

#include "chart/drawing.h"

namespace relevo::chart {

/// The rectangles of a drawing that are taken, for labels that must not overlap. Lookups take a
/// time that does not grow with their number, if they are spread out.
class FreeRoom {
  public:
    /// @param within  where something may stand
    explicit FreeRoom(const Rect& within);

    const Rect& within() const { return within_; }

    /// Whether a rectangle is inside and overlaps none that is taken. Rectangles may touch.
    bool is_free(const Rect& box) const;
    void take(const Rect& box);

  private:
    /// First and last cell of a rectangle, each column and row.
    struct Cells {
        std::size_t left, right, top, bottom;
    };
    Cells cells_of(const Rect& box) const;

    Rect within_;
    std::size_t columns_, rows_;
    std::vector<std::vector<Rect>> cells_;  // row by row: what is taken in each
};

}  // namespace relevo::chart
