#pragma once

#include "base/array2d.h"
#include "dem/grid.h"

namespace relevo::dem {

/// A part of the Earth where land lies below the sea's level.
struct Depression {
    const char* name;
    double south_deg, north_deg, west_deg, east_deg;
    double lowest_m;  ///< of the land; what is lower is under water
    /// The sea is beside it: what is exactly 0 there is sea.
    bool on_coast = false;
};

/// How low land may lie at the posts of a grid and be dry, by the table in dry_land.cpp.
class DryLand {
  public:
    explicit DryLand(const Grid& grid);

    /// Whether any post is in a depression.
    bool any() const { return !boxes_.empty(); }
    /// The depression that a post lies in; null for none.
    const Depression* at(int column, int row) const {
        if (boxes_.empty()) return nullptr;
        return boxes_.at(column / stride_, row / stride_);
    }
    /// Whether a post of a height of 0 or less is known to be land.
    bool is_dry(int column, int row, float height_m) const {
        const Depression* const box = at(column, row);
        return box && height_m >= box->lowest_m && !(box->on_coast && height_m == 0);
    }

  private:
    int stride_ = 1;                    // posts to a cell, each way
    Array2d<const Depression*> boxes_;  // of cells; empty where all are null
};

}  // namespace relevo::dem
