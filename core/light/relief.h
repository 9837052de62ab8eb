#pragma once

#include "base/array2d.h"
#include "dem/heightfield.h"

namespace relevo::light {

/// A heightfield with the highest post of every block of it, so that a line of sight skips what
/// cannot matter and still finds exactly what it would find by looking at every post.
class Relief {
  public:
    /// @param field  is referred to, not copied
    explicit Relief(const dem::Heightfield& field);

    const dem::Heightfield& field() const { return *field_; }
    const Array2d<float>& height_m() const { return field_->height_m; }
    float lowest_m() const { return lowest_m_; }    ///< of the whole field
    float highest_m() const { return highest_m_; }  ///< likewise

    /// The highest that the ground can be within a box of cells: the highest post at their corners;
    /// where one of these is a hole, highest_m(), for a hole may hide that.
    /// @param first_column, last_column, first_row, last_row  of cells (between posts), inclusive
    float bound_m(int first_column, int last_column, int first_row, int last_row) const;

  private:
    const dem::Heightfield* field_;
    float lowest_m_, highest_m_;
    Array2d<float> block_highest_m_;
};

}  // namespace relevo::light
